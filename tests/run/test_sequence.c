// SPDX-License-Identifier: MIT
// Which frames are drawn.
#include "run/sequence.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static RunParams make_run(int frames, int columns, int rows)
{
    return (RunParams){
        .frames = frames, .last = -1, .every = 1, .part = {1, 1}, .contact_sheet = {columns, rows}};
}

static int count(const RunParams *run)
{
    int drawn = 0;
    for (int frame = 0; frame < run->frames; ++frame) drawn += sequence_draws_frame(run, frame);
    return drawn;
}

static void as_many_are_drawn_as_are_counted(void **state)
{
    (void)state;
    for (int frames = 1; frames < 40; ++frames)
        for (int tiles = 1; tiles < 45; ++tiles)
            for (int every = 1; every < 4; ++every) {
                RunParams run = make_run(frames, tiles, 1);
                run.every = every;
                run.first = frames / 5;
                assert_int_equal(count(&run), sequence_count_drawn(&run));
                int named = (frames - 1 - run.first) / every + 1;
                if (tiles > 1) assert_int_equal(count(&run), tiles < named ? tiles : named);
            }
}

// Tiles are evenly spaced, as far as whole frames allow; the first frame is included, and the step
// from the last tile to the first equals the others.
static void a_contact_sheet_takes_evenly_spaced_frames(void **state)
{
    (void)state;
    for (int tiles = 2; tiles <= 100; ++tiles) {
        RunParams run = make_run(100, tiles, 1);
        int before = 0;
        assert_true(sequence_draws_frame(&run, 0));
        for (int frame = 1; frame <= run.frames; ++frame) {
            if (frame < run.frames && !sequence_draws_frame(&run, frame)) continue;
            assert_in_range(frame - before, 100 / tiles, (100 + tiles - 1) / tiles);
            before = frame;
        }
    }
    RunParams run = make_run(120, 4, 3);
    for (int frame = 0; frame < 120; ++frame)
        assert_int_equal(sequence_draws_frame(&run, frame), frame % 10 == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(as_many_are_drawn_as_are_counted),
        cmocka_unit_test(a_contact_sheet_takes_evenly_spaced_frames),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
