// SPDX-License-Identifier: MIT
// Scenes, simulations, renderers and devices one after the other leave nothing behind: no memory,
// no file, no thread. TEST_ROUNDS=10000 for as many.
#include "support/library_fixture.h"

#include <dirent.h>
#include <malloc.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmocka.h>

#define error library_error

enum { ROUNDS = 20, DEVICES = 4, WARM = 10 };

static int count_entries(const char *path)
{
    DIR *folder = opendir(path);
    int count = 0;
    while (folder && readdir(folder)) ++count;
    if (folder) closedir(folder);
    return count;
}

// Bytes that are in use: of the heap, and in pieces of their own.
static size_t used(void)
{
    struct mallinfo2 info = mallinfo2();
    return info.uordblks + info.hblkhd;
}

static int rounds_of(int usual)
{
    const char *text = getenv("TEST_ROUNDS");
    return text && atoi(text) > 0 ? atoi(text) : usual;
}

// With a mesh that deforms, since that has the most parts.
static void go_round(TractrixDevice *device, bool deforms)
{
    static const char *const parameters[] = {"followers", "1", "wind", "1,0,0", NULL};
    static uint8_t pixels[FIXTURE_PIXELS][4];
    TractrixScene *scene = library_scene(parameters);
    TractrixSimulation *simulation;
    TractrixPositions positions = {.size = sizeof positions};
    library_set_sheet(scene, deforms);
    WELL(tractrix_simulation_create(&simulation, device, scene, &error));
    if (deforms)
        WELL(tractrix_simulation_advance_mesh(simulation, library_sheet[0], 4, &error));
    else
        WELL(tractrix_simulation_advance(simulation, &(TractrixPose){{0, 0, 0, 1}, {0.01, 0, 0}},
                                         &error));
    WELL(tractrix_simulation_map(simulation, 0, TRACTRIX_FOLLOWERS, &positions, &error));
    library_draw(simulation, NULL, pixels);
    tractrix_simulation_destroy(simulation);
    tractrix_scene_destroy(scene);
}

// The driver's own tables still fill here and there: 5 kB over 200 rounds.
static const size_t NOISE = 16384, NOISE_EACH = 8;

static void assert_no_growth(size_t before, size_t after, int rounds)
{
    if (getenv("TEST_ROUNDS"))
        print_message("%zu bytes before, %zu after %d rounds\n", before, after, rounds);
    if (after > before + NOISE + NOISE_EACH * (size_t)rounds)
        fail_msg("%zu bytes before, %zu after %d rounds: %.1f a round", before, after, rounds,
                 (double)(after - before) / rounds);
}

static void scenes_leave_nothing(void **state)
{
    TractrixDevice *device;
    int rounds = rounds_of(ROUNDS);
    (void)state;
    WELL(tractrix_device_open(&device, NULL, &error));
    for (int i = 0; i < WARM; ++i) go_round(device, i % 2);
    int files = count_entries("/proc/self/fd"), threads = count_entries("/proc/self/task");
    size_t before = used();
    for (int i = 0; i < rounds; ++i) go_round(device, i % 2);
    assert_no_growth(before, used(), rounds);
    assert_int_equal(count_entries("/proc/self/fd"), files);
    assert_int_equal(count_entries("/proc/self/task"), threads);
    tractrix_device_destroy(device);
}

static void devices_leave_nothing(void **state)
{
    TractrixDevice *device;
    int rounds = rounds_of(DEVICES), files = 0, threads = 0;
    size_t before = 0;
    (void)state;
    for (int i = -3; i < rounds; ++i) {
        if (i == 0) {
            files = count_entries("/proc/self/fd"), threads = count_entries("/proc/self/task");
            before = used();
        }
        WELL(tractrix_device_open(&device, NULL, &error));
        go_round(device, false);
        tractrix_device_destroy(device);
    }
    assert_no_growth(before, used(), rounds);
    assert_int_equal(count_entries("/proc/self/fd"), files);
    assert_int_equal(count_entries("/proc/self/task"), threads);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scenes_leave_nothing),
        cmocka_unit_test(devices_leave_nothing),
    };
    return cmocka_run_group_tests_name("library_growth", tests, NULL, NULL);
}
