// SPDX-License-Identifier: MIT
// The rule of sleep (sim/sleep.h) just below and just above each of its thresholds: before each
// check, the test puts the strands' tips where it wants them. Whole scenes are tested in
// test_sleep.c.
#include "sim/sleep.h"
#include "support/hair_fixture.h"

#include "glsl/sim/sleep_params.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// Steps of one second, so that there is a check after each and 2 calm checks make the rule's 2 s.
enum { STRANDS = 8, PAIR = 2, CALM_CHECKS = 2 };
static const double TOLERANCE = 0.01, LEAVE = 1.0 / 4, GROW = 1.0 / 60, REACH_S = 120;

typedef struct Trial {
    HairFixture fixture;
    Sleep sleep;
} Trial;

// Strands of 1 m that hang straight down.
static void create(Trial *trial)
{
    double start[STRANDS * PAIR][3];
    for (int i = 0; i < STRANDS * PAIR; ++i)
        start[i][0] = 0, start[i][1] = -(i % PAIR), start[i][2] = 0;
    fixture_create(&trial->fixture, (const double(*)[3])start, STRANDS, PAIR, "dftl", "", 0, 1);
    trial->fixture.params.sleep = (float)TOLERANCE;
    trial->fixture.step.dt = 1;
    trial->fixture.step.first = false;
    assert_int_equal(sleep_create(&trial->sleep, fixture_gpu(), &trial->fixture.timer,
                                  &trial->fixture.hair, &trial->fixture.solver,
                                  &trial->fixture.params, &(Error){{0}}),
                     RESULT_OK);
}

static void destroy(Trial *trial)
{
    sleep_destroy(&trial->sleep);
    fixture_destroy(&trial->fixture);
}

// One step and its check, with the tips displaced by ways[] tolerances.
static void check(Trial *trial, const double ways[STRANDS])
{
    const HairBatch *batch = &trial->fixture.hair.batches[0];
    for (uint32_t s = 0; s < STRANDS; ++s) {
        const float at[4] = {(float)(ways[s] * TOLERANCE), -1, 0, 1};
        glBindBuffer(GL_SHADER_STORAGE_BUFFER, batch->position.buffer);
        glBufferSubData(GL_SHADER_STORAGE_BUFFER, (GLintptr)(hair_address(batch, s, 1) * sizeof at),
                        sizeof at, at);
    }
    int before = trial->sleep.checks;
    assert_false(sleep_skips(&trial->sleep, &trial->fixture.step));
    sleep_check(&trial->sleep, &trial->fixture.solver);
    assert_int_equal(trial->sleep.checks, before + 1);
}

// Checks until the next check has the number `next`, a power of two, after which strands that are
// not ready get new anchors at their position, 0. None is ready, because all moved far before.
static void begin_at(Trial *trial, int next)
{
    double ways[STRANDS];
    while (trial->sleep.checks <= next) {
        double way = trial->sleep.checks % 2 ? 9 : -9;
        for (int s = 0; s < STRANDS; ++s) ways[s] = trial->sleep.checks < next ? way : 0;
        check(trial, ways);
    }
}

// Checks how many successive checks have found each strand calm, and whether it is ready.
static void require_calm(const Trial *trial, const uint32_t expected[STRANDS])
{
    uint32_t *calm = gpu_buffer_read(&trial->sleep.batches[0].calm);
    assert_non_null(calm);
    for (int s = 0; s < STRANDS; ++s)
        if (calm[s] != expected[s])
            fail_msg("strand %d: %x after check %d, not %x", s, calm[s], trial->sleep.checks - 1,
                     expected[s]);
    free(calm);
}

// A particle that leaves its anchor gets a new one there, and may then move back as far.
static void strands_leave_their_anchors_beyond_a_quarter(void **state)
{
    (void)state;
    static const double out[STRANDS] = {0.99 * LEAVE, 1.01 * LEAVE, -0.99 * LEAVE, -1.01 * LEAVE};
    static const double back[STRANDS] = {0};
    Trial trial;
    create(&trial);
    begin_at(&trial, 8);
    check(&trial, out);
    require_calm(&trial, (const uint32_t[STRANDS]){0, 0, 0, 0, 1, 1, 1, 1});
    check(&trial, back); // calm for strands whose anchors are here; too far for the others
    require_calm(&trial, (const uint32_t[STRANDS]){1, 0, 1, 0, 2 | SLEEP_READY, 2 | SLEEP_READY,
                                                   2 | SLEEP_READY, 2 | SLEEP_READY});
    destroy(&trial);
}

// A distance that exceeds the previous maximum by up to a sixtieth is calm. Small increases add up.
static void growth_beyond_a_sixtieth_is_not_calm(void **state)
{
    (void)state;
    static const double first[STRANDS] = {0.99 * GROW, 1.01 * GROW, -0.99 * GROW, -1.01 * GROW,
                                          0.1,         0.1,         0.1,          0.9 * GROW};
    static const double second[STRANDS] = {
        0, 0, 1.01 * GROW, 2.1 * GROW, 0.1 + 0.99 * GROW, 0.1 + 1.01 * GROW, 0.05, 1.8 * GROW};
    Trial trial;
    create(&trial);
    begin_at(&trial, 8);
    check(&trial, first);
    require_calm(&trial, (const uint32_t[STRANDS]){1, 0, 1, 0, 0, 0, 0, 1});
    check(&trial, second);
    require_calm(&trial, (const uint32_t[STRANDS]){2 | SLEEP_READY, 1, 0, 0, 1, 0, 1, 0});
    destroy(&trial);
}

// Strands must be calm for 2 s plus 120 s for each tolerance of trembling: 14 successive checks if
// they tremble by a tenth of the tolerance, and 15 for slightly more.
static void trembling_strands_wait_for_longer(void **state)
{
    (void)state;
    enum { CHECKS = 14 };
    const double most = (CHECKS - CALM_CHECKS) / REACH_S;
    const double ways[STRANDS] = {0.99 * most, 1.01 * most, 0, 0, 0, 0, 0, 0};
    Trial trial;
    create(&trial);
    begin_at(&trial, 16);
    check(&trial, ways); // the first two have moved farther: not calm
    for (int i = 0; i < CHECKS - 1; ++i) check(&trial, ways);
    uint32_t still = CHECKS | SLEEP_READY;
    require_calm(&trial, (const uint32_t[STRANDS]){CHECKS - 1, CHECKS - 1, still, still, still,
                                                   still, still, still});
    check(&trial, ways);
    still = (CHECKS + 1) | SLEEP_READY;
    require_calm(&trial, (const uint32_t[STRANDS]){CHECKS | SLEEP_READY, CHECKS, still, still,
                                                   still, still, still, still});
    destroy(&trial);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(strands_leave_their_anchors_beyond_a_quarter),
        cmocka_unit_test(growth_beyond_a_sixtieth_is_not_calm),
        cmocka_unit_test(trembling_strands_wait_for_longer),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
