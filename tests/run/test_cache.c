// SPDX-License-Identifier: MIT
// A cache returns every bit of its frames, also after truncation, and reports what it can't return.
#include "run/cache.h"
#include "run/cache_scene.h"
#include "run/frame_source.h"
#include "support/hair_fixture.h"
#include "support/simulation_fixture.h"
#include "support/temporary.h"

#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

enum { FRAMES = 5 };

// A run that writes a cache, and the positions it drew.
typedef struct Recorded {
    char path[300];
    uint64_t hash[FRAMES];
} Recorded;

static void set_path(char **field, const char *path)
{
    free(*field);
    *field = strdup(path);
}

static void start(SimulationFixture *fixture, const char *played)
{
    simulation_fixture_create(fixture, "chain", "");
    fixture->scene.run.frames = FRAMES;
    fixture->scene.run.sim_rate = 25; // frames lie also between steps
    if (!played) {
        simulation_fixture_start(fixture);
        return;
    }
    set_path(&fixture->scene.run.from_cache, played);
    Error error;
    if (simulation_create(&fixture->simulation, fixture_gpu(), &fixture->timer, &fixture->scene,
                          &fixture->strands, NULL, &error) != RESULT_OK)
        fail_msg("%s", error.text);
}

static void record(Recorded *recorded, void **state, const char *name, bool whole)
{
    SimulationFixture fixture;
    CacheWriter writer;
    snprintf(recorded->path, sizeof recorded->path, "%s", temporary_path(state, name));
    start(&fixture, NULL);
    assert_int_equal(
        cache_writer_open(&writer, recorded->path, &fixture.simulation, &fixture.strands, NULL),
        RESULT_OK);
    for (int frame = 0; frame < FRAMES; ++frame) {
        simulation_fixture_go(&fixture, frame);
        recorded->hash[frame] = simulation_fixture_hash(&fixture);
        assert_int_equal(cache_writer_add(&writer, &fixture.simulation, NULL), RESULT_OK);
    }
    if (whole) assert_int_equal(cache_writer_finish(&writer, NULL), RESULT_OK);
    cache_writer_close(&writer);
    simulation_fixture_destroy(&fixture);
}

// Plays a file frame by frame, last frame first, and compares with what was recorded. Returns the
// number of frames, or -1 if the file is refused.
static int play(SimulationFixture *fixture, const Recorded *recorded, const char *path)
{
    CacheReader reader;
    Error error;
    Result result =
        cache_reader_open(&reader, path, &fixture->simulation, &fixture->strands, &error);
    if (result != RESULT_OK) {
        assert_int_equal(result, RESULT_BAD_INPUT);
        assert_int_equal(strncmp(error.text, path, strlen(path)), 0);
        return -1;
    }
    int count = 0;
    for (int frame = FRAMES - 1; frame >= 0; --frame) {
        result = cache_reader_show(&reader, &fixture->simulation, frame, &error);
        if (result == RESULT_OK) {
            assert_true(simulation_fixture_hash(fixture) == recorded->hash[frame]);
            ++count;
            continue;
        }
        char expected[32];
        snprintf(expected, sizeof expected, "frame %d", frame);
        assert_int_equal(result, RESULT_BAD_INPUT);
        assert_int_equal(strncmp(error.text, path, strlen(path)), 0);
        assert_non_null(strstr(error.text, expected));
    }
    cache_reader_close(&reader);
    return count;
}

static void frames_come_back_bit_for_bit_in_any_order(void **state)
{
    Recorded recorded = {0};
    SimulationFixture fixture;
    for (int whole = 0; whole < 2; ++whole) {
        record(&recorded, state, "frames.cache", whole);
        start(&fixture, recorded.path);
        assert_int_equal(play(&fixture, &recorded, recorded.path), FRAMES);
        simulation_fixture_destroy(&fixture);
    }
}

static void write_bytes(const char *path, const uint8_t *data, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(data, 1, size, file), size);
    fclose(file);
}

// A complete cache, its bytes, and a simulation of the same scene to play other files with.
typedef struct Original {
    Recorded recorded;
    SimulationFixture fixture;
    Bytes file;
} Original;

static void original_create(Original *original, void **state)
{
    *original = (Original){0};
    record(&original->recorded, state, "whole.cache", true);
    assert_int_equal(bytes_read_file(&original->file, original->recorded.path, NULL), RESULT_OK);
    start(&original->fixture, original->recorded.path);
}

static void original_destroy(Original *original)
{
    bytes_destroy(&original->file);
    simulation_fixture_destroy(&original->fixture);
}

// Plays the first `size` bytes.
static int original_play(Original *original, void **state, size_t size)
{
    const char *path = temporary_path(state, "other.cache");
    write_bytes(path, original->file.data, size);
    return play(&original->fixture, &original->recorded, path);
}

// Truncated anywhere: the complete frames before the cut are returned correctly, and the others are
// named.
static void every_truncation_keeps_the_whole_frames(void **state)
{
    Original original;
    original_create(&original, state);
    const size_t all = original.file.size;
    int before = -1;
    for (size_t size = 0; size < all; size += size < 64 || size + 64 > all ? 1 : 23) {
        int count = original_play(&original, state, size);
        assert_true(count >= before);
        before = count;
    }
    assert_int_equal(before, FRAMES);
    original_destroy(&original);
}

// One flipped bit anywhere never gives a wrong image: all frames but one are returned, or all (the
// index is not essential), or the file is refused.
static void every_flipped_bit_is_found(void **state)
{
    Original original;
    original_create(&original, state);
    const size_t all = original.file.size;
    int refused = 0, damaged = 0, harmless = 0;
    for (size_t at = 0; at < all; at += at < 64 || at + 300 > all ? 1 : 29) {
        const uint8_t bit = (uint8_t)(1u << at % 8);
        original.file.data[at] ^= bit;
        int count = original_play(&original, state, all);
        original.file.data[at] ^= bit;
        refused += count < 0;
        damaged += count >= 0 && count < FRAMES;
        harmless += count == FRAMES;
    }
    assert_true(refused > 50 && damaged > 50);
    assert_true(harmless > 0 && harmless < 200); // unused header bytes and the index
    original_destroy(&original);
}

static void another_scene_is_refused_by_the_value_that_differs(void **state)
{
    Recorded recorded = {0};
    SimulationFixture fixture;
    CacheReader reader;
    Error error;
    record(&recorded, state, "a.cache", true);
    start(&fixture, recorded.path);
    fixture.scene.sections[0].params.style = 0.25f;
    assert_int_equal(
        cache_reader_open(&reader, recorded.path, &fixture.simulation, &fixture.strands, &error),
        RESULT_BAD_INPUT);
    assert_non_null(strstr(error.text, "sections[0].style 0.5, but this scene has 0.25"));
    fixture.scene.sections[0].params.style = 0.5f;
    fixture.scene.sections[0].params.opacity = 0.9f; // looks do not matter
    fixture.scene.run.frames = 3;
    assert_int_equal(play(&fixture, &recorded, recorded.path), FRAMES);
    float before = fixture.strands.position[7][1];
    fixture.strands.position[7][1] += 1e-6f;
    assert_int_equal(
        cache_reader_open(&reader, recorded.path, &fixture.simulation, &fixture.strands, &error),
        RESULT_BAD_INPUT);
    assert_non_null(strstr(error.text, "hair that differs from curls"));
    // The same before there is a simulation, also if the record of the hair is cut.
    CacheFile file;
    assert_int_equal(cache_file_open(&file, recorded.path, &error), RESULT_OK);
    assert_int_equal(cache_scene_compare_strands(&file.hair, &fixture.scene, &fixture.strands,
                                                 recorded.path, &error),
                     RESULT_BAD_INPUT);
    assert_non_null(strstr(error.text, "hair that differs from curls"));
    fixture.strands.position[7][1] = before;
    assert_int_equal(cache_scene_compare_strands(&file.hair, &fixture.scene, &fixture.strands,
                                                 recorded.path, &error),
                     RESULT_OK);
    file.hair.size = 6;
    assert_int_equal(cache_scene_compare_strands(&file.hair, &fixture.scene, &fixture.strands,
                                                 recorded.path, &error),
                     RESULT_BAD_INPUT);
    cache_file_close(&file);
    simulation_fixture_destroy(&fixture);
}

// Runs a frame source that stops after `count` frames, as after an interrupt, or finishes the
// cache.
static void run_source(const char *path, bool resume, int count, Recorded *recorded)
{
    SimulationFixture fixture;
    FrameSource source;
    Error error;
    start(&fixture, NULL);
    set_path(&fixture.scene.run.cache, path);
    fixture.scene.run.resume = resume;
    if (frame_source_open(&source, &fixture.simulation, &fixture.strands, FRAMES - 1, NULL,
                          &error) != RESULT_OK)
        fail_msg("%s", error.text);
    for (int frame = 0; frame < count; ++frame) {
        if (frame_source_go(&source, frame, true, &error) != RESULT_OK) fail_msg("%s", error.text);
        assert_true(simulation_fixture_hash(&fixture) == recorded->hash[frame]);
    }
    if (count == FRAMES && frame_source_finish(&source, &error) != RESULT_OK)
        fail_msg("%s", error.text);
    frame_source_close(&source);
    simulation_fixture_destroy(&fixture);
}

static void assert_same_files(const char *a, const char *b)
{
    Bytes x, y;
    assert_int_equal(bytes_read_file(&x, a, NULL), RESULT_OK);
    assert_int_equal(bytes_read_file(&y, b, NULL), RESULT_OK);
    assert_int_equal(x.size, y.size);
    assert_memory_equal(x.data, y.data, x.size);
    bytes_destroy(&x);
    bytes_destroy(&y);
}

static void stopped_and_resumed_after_any_frame_is_the_same_file(void **state)
{
    Recorded recorded = {0};
    record(&recorded, state, "whole.cache", true);
    char path[300]; // the results of temporary_path are overwritten by later calls
    snprintf(path, sizeof path, "%s", temporary_path(state, "part.cache"));
    for (int stop = 0; stop < FRAMES; ++stop) {
        run_source(path, false, stop, &recorded);
        assert_true(temporary_has(state, "part.cache.state") == (stop > 0));
        run_source(path, true, FRAMES, &recorded);
        assert_false(temporary_has(state, "part.cache.state"));
        assert_same_files(path, recorded.path);
    }
    // More frames were written after the state was saved, the last one incompletely.
    Bytes file;
    run_source(path, false, 2, &recorded);
    assert_int_equal(bytes_read_file(&file, recorded.path, NULL), RESULT_OK);
    write_bytes(path, file.data, file.size * 9 / 10);
    run_source(path, true, FRAMES, &recorded);
    assert_same_files(path, recorded.path);
    // The state belongs to a frame that the cache no longer has: simulates from the start.
    run_source(path, false, 3, &recorded);
    write_bytes(path, file.data, file.size * 3 / 10);
    run_source(path, true, FRAMES, &recorded);
    assert_same_files(path, recorded.path);
    bytes_destroy(&file);
}

// The offset of the chunk of frame `number`; if `number` is FRAMES, the file's size.
static size_t frame_at(const Bytes *file, int number)
{
    const uint8_t *at = file->data - 1, *end = file->data + file->size;
    for (int i = 0; i <= number && number < FRAMES; ++i) {
        at = memmem(at + 1, (size_t)(end - at) - 1, "FRAM", 4);
        assert_non_null(at);
    }
    return number < FRAMES ? (size_t)(at - file->data) : file->size;
}

// A file without an index whose frames 1 and 2 are swapped is read only up to them.
static void frames_in_another_order_are_not_shown(void **state)
{
    Original original = {0};
    Bytes file;
    record(&original.recorded, state, "open.cache", false);
    start(&original.fixture, original.recorded.path);
    assert_int_equal(bytes_read_file(&file, original.recorded.path, NULL), RESULT_OK);
    assert_int_equal(play(&original.fixture, &original.recorded, original.recorded.path), FRAMES);
    size_t at[4];
    for (int i = 1; i < 4; ++i) at[i] = frame_at(&file, i);
    uint8_t *swapped = malloc(file.size);
    memcpy(swapped, file.data, file.size);
    memcpy(swapped + at[1], file.data + at[2], at[3] - at[2]);
    memcpy(swapped + at[1] + at[3] - at[2], file.data + at[1], at[2] - at[1]);
    const char *path = temporary_path(state, "swapped.cache");
    write_bytes(path, swapped, file.size);
    assert_int_equal(play(&original.fixture, &original.recorded, path), 1);
    free(swapped);
    bytes_destroy(&file);
    simulation_fixture_destroy(&original.fixture);
}

// A flipped bit in a frame costs time but never gives a wrong file, wherever it is, with the state
// behind the damage or without a state.
static void a_damaged_frame_is_simulated_again(void **state)
{
    Recorded recorded = {0};
    record(&recorded, state, "whole.cache", true);
    char path[300];
    snprintf(path, sizeof path, "%s", temporary_path(state, "part.cache"));
    for (int count = 2; count <= FRAMES; ++count) {
        Bytes file;
        run_source(path, false, count, &recorded);
        assert_int_equal(bytes_read_file(&file, path, NULL), RESULT_OK);
        uint8_t *chunk = memmem(file.data, file.size, "FRAM", 4);
        chunk[CHUNK_HEADER_BYTES + 40] ^= 4; // in the first frame's data
        write_bytes(path, file.data, file.size);
        run_source(path, true, FRAMES, &recorded);
        assert_same_files(path, recorded.path);
        bytes_destroy(&file);
    }
}

static void a_file_that_is_no_cache_is_not_written_over(void **state)
{
    SimulationFixture fixture;
    CacheWriter writer;
    Error error;
    Bytes file;
    start(&fixture, NULL);
    const char *path = temporary_path(state, "notes.txt");
    write_bytes(path, (const uint8_t *)"my notes", 8);
    assert_int_equal(
        cache_writer_open(&writer, path, &fixture.simulation, &fixture.strands, &error),
        RESULT_FAILED);
    assert_non_null(strstr(error.text, "is not a cache"));
    assert_int_equal(bytes_read_file(&file, path, NULL), RESULT_OK);
    assert_int_equal(file.size, 8);
    assert_memory_equal(file.data, "my notes", 8);
    bytes_destroy(&file);
    simulation_fixture_destroy(&fixture);
}

static void two_do_not_write_the_same_file(void **state)
{
    SimulationFixture fixture;
    CacheWriter one, other;
    Error error;
    start(&fixture, NULL);
    const char *path = temporary_path(state, "one.cache");
    assert_int_equal(cache_writer_open(&one, path, &fixture.simulation, &fixture.strands, &error),
                     RESULT_OK);
    assert_int_equal(cache_writer_open(&other, path, &fixture.simulation, &fixture.strands, &error),
                     RESULT_FAILED);
    assert_non_null(strstr(error.text, "another process"));
    cache_writer_close(&one);
    simulation_fixture_destroy(&fixture);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, temporary_create, temporary_destroy)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(frames_come_back_bit_for_bit_in_any_order),
        TEST(every_truncation_keeps_the_whole_frames),
        TEST(every_flipped_bit_is_found),
        TEST(another_scene_is_refused_by_the_value_that_differs),
        TEST(stopped_and_resumed_after_any_frame_is_the_same_file),
        TEST(frames_in_another_order_are_not_shown),
        TEST(a_damaged_frame_is_simulated_again),
        TEST(a_file_that_is_no_cache_is_not_written_over),
        TEST(two_do_not_write_the_same_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
