// SPDX-License-Identifier: MIT
// Creating and destroying scenes, simulations, renderers and devices repeatedly leaves no memory,
// file or thread behind. TEST_ROUNDS=10000 makes 10,000 scenes, 10,000 simulations with an image,
// and a hundredth as many devices.
#include "support/library_fixture.h"
#include "support/threads.h"

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

// With a CPU driver: a GPU's driver has tables and threads of its own that grow.
static const TractrixDeviceOptions SOFTWARE = {.size = sizeof SOFTWARE, .software = true};

enum { WINDOWS = 5, SCENES = 500, SIMULATIONS = 20, DEVICES = 5, LEAK = 8 };

static int count_files(void)
{
    DIR *folder = opendir("/proc/self/fd");
    int count = 0;
    while (folder && readdir(folder)) ++count;
    if (folder) closedir(folder);
    return count;
}

// Without the driver's writers of its shader cache. Mesa starts up to three more of them, named
// "...:disk$1" and so on, while many entries wait for a slow disk.
static int count_threads(void)
{
    int writers = threads_named(":disk$"); // counted first: one that starts now is counted too much
    return threads_named("") - writers;
}

// Waits up to five seconds until no more than `most` are counted: the kernel still lists a thread
// for a moment after it has been joined, and a writer of the shader cache may have a file open,
// also when `most` was counted.
static void settles_at(int (*count)(void), int most)
{
    for (int i = 0; i < 500 && count() > most; ++i) usleep(10000);
    assert_in_range(count(), 0, most);
}

// Bytes in use, in the heap and in separately mapped blocks.
static size_t used(void)
{
    struct mallinfo2 info = mallinfo2();
    return info.uordblks + info.hblkhd;
}

// --- Objects to be created and destroyed.

static void use_scene(TractrixDevice *device, int round)
{
    static const char *const parameters[] = {"colliders", "ground:0", "color", "red", NULL};
    TractrixScene *scene = library_scene(parameters);
    (void)device, (void)round;
    library_set_sheet(scene, false);
    tractrix_scene_destroy(scene);
    WELL(tractrix_scene_read(&scene, "assets/demo.json", &error));
    tractrix_scene_destroy(scene);
    library_refused(tractrix_scene_parse(&scene, "{\"sections\": 1}", NULL, &error),
                    TRACTRIX_BAD_INPUT, "sections");
}

// Several solvers take turns, and every second simulation has a deforming mesh, which uses most
// parts of the library.
static void use_simulation(TractrixDevice *device, int round)
{
    static const char *const algos[] = {"split",  "emulation", "hybrid", "chain",
                                        "spring", "tressfx",   "rope",   "dftl"};
    bool deforms = round % 2;
    size_t kinds = getenv("TEST_ROUNDS") ? sizeof algos / sizeof *algos : 2;
    const char *algo = algos[(size_t)round / 2 % kinds];
    const char *const parameters[] = {"algo",  algo,     "followers", "1", "wind",
                                      "1,0,0", "raster", "blocks",    NULL};
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

static void use_device(TractrixDevice *unused, int round)
{
    TractrixDevice *device;
    (void)unused;
    WELL(tractrix_device_open(&device, &SOFTWARE, &error));
    use_simulation(device, 2 * round);
    tractrix_device_destroy(device);
}

// --- Leftovers.

static int by_size(const void *a, const void *b)
{
    int64_t x = *(const int64_t *)a, y = *(const int64_t *)b;
    return x < y ? -1 : x > y;
}

// Measures `rounds` rounds, or TEST_ROUNDS / share if that is more, after `rounds` rounds that fill
// caches. The driver's own tables occasionally grow and shrink by several kB, so memory is measured
// in several windows of rounds and the median counts: a leak appears in all windows, such a table
// in one or two.
static void measure(void (*use)(TractrixDevice *device, int round), TractrixDevice *device,
                    int rounds, int share)
{
    const char *wanted = getenv("TEST_ROUNDS");
    int asked = wanted ? atoi(wanted) / share : 0, count = asked > rounds ? asked : rounds,
        window = count / WINDOWS;
    size_t first = 0, before = 0;
    int64_t grown[WINDOWS];
    int files = 0, threads = 0;
    for (int i = -rounds; i < window * WINDOWS; ++i) {
        if (i == 0) {
            files = count_files(), threads = count_threads();
            first = before = used();
        }
        use(device, rounds + i);
        if (i < 0 || (i + 1) % window) continue;
        size_t now = used();
        grown[i / window] = (int64_t)now - (int64_t)before;
        before = now;
    }
    double each = ((double)before - (double)first) / count;
    if (wanted)
        print_message("%d rounds: %zu bytes in use before, %zu after: %.2f a round\n", count, first,
                      before, each);
    qsort(grown, WINDOWS, sizeof *grown, by_size);
    if (grown[WINDOWS / 2] > LEAK * window)
        fail_msg(
            "%d rounds: %zu bytes in use before, %zu after: half of the fifths left %lld or more",
            count, first, before, (long long)grown[WINDOWS / 2]);
    settles_at(count_files, files);
    settles_at(count_threads, threads);
}

static void scenes_leave_nothing(void **state)
{
    (void)state;
    measure(use_scene, NULL, SCENES, 1);
}

static void simulations_leave_nothing(void **state)
{
    TractrixDevice *device;
    (void)state;
    WELL(tractrix_device_open(&device, &SOFTWARE, &error));
    measure(use_simulation, device, SIMULATIONS, 1);
    tractrix_device_destroy(device);
}

static void devices_leave_nothing(void **state)
{
    (void)state;
    measure(use_device, NULL, DEVICES, 100);
}

// Threads that wait for more work end with the last device, not before. (The driver's own threads
// stay, so they are started first, by a device that uses no other threads.)
static void the_last_device_ends_its_threads(void **state)
{
    TractrixDevice *first, *last;
    (void)state;
    tractrix_set_threads(1);
    use_device(NULL, 0);
    int before = count_threads();
    tractrix_set_threads(4);
    WELL(tractrix_device_open(&first, &SOFTWARE, &error));
    WELL(tractrix_device_open(&last, &SOFTWARE, &error));
    use_simulation(last, 0);
    tractrix_device_destroy(first);
    assert_true(count_threads() > before + 1);
    tractrix_device_destroy(last);
    settles_at(count_threads, before);
    tractrix_set_threads(0);
}

// Blocks that glibc keeps for reuse by a thread (tcache) count as used, so tcache is turned off
// here.
int main(int count, char **arguments)
{
    static const char NO_CACHE[] = "glibc.malloc.tcache_count=0";
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_last_device_ends_its_threads),
        cmocka_unit_test(scenes_leave_nothing),
        cmocka_unit_test(simulations_leave_nothing),
        cmocka_unit_test(devices_leave_nothing),
    };
    (void)count;
    if (!getenv("GLIBC_TUNABLES")) {
        setenv("GLIBC_TUNABLES", NO_CACHE, 1);
        execv("/proc/self/exe", arguments);
        return 1;
    }
    TractrixDevice *device;
    if (tractrix_device_open(&device, &SOFTWARE, &error) == TRACTRIX_NO_GL) {
        printf("skipped: %s\n", error.text);
        return 77;
    }
    tractrix_device_destroy(device);
    return cmocka_run_group_tests_name("library_growth", tests, NULL, NULL);
}
