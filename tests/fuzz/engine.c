// SPDX-License-Identifier: MIT
// Lets libFuzzer run the target named by the environment variable FUZZ_TARGET, with the limits of
// time and memory that docs/reliability.md promises.
#include "fuzz/fuzz.h"

#include <malloc.h>
#include <sanitizer/allocator_interface.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

// SLOWER: sanitizers and branch counters slow the target down.
enum { MEMORY_FACTOR = 64, MEMORY_BASE = 64 << 20, SLOWER = 8 };

static atomic_llong held, most;
static const FuzzTarget *target;

static void count_malloc(const volatile void *block, size_t size)
{
    (void)block;
    long long now = atomic_fetch_add(&held, (long long)size) + (long long)size;
    if (now > atomic_load(&most)) atomic_store(&most, now);
}

static void count_free(const volatile void *block)
{
    if (block)
        atomic_fetch_sub(&held, (long long)__sanitizer_get_allocated_size((const void *)block));
}

int LLVMFuzzerInitialize(int *argc, char ***argv);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
    (void)argc, (void)argv;
    const char *name = getenv("FUZZ_TARGET");
    target = name ? fuzz_find(name) : NULL;
    if (!target) {
        fputs("fuzz: FUZZ_TARGET: expected one of", stderr);
        for (size_t i = 0; i < FUZZ_TARGET_COUNT; ++i) fprintf(stderr, " %s", FUZZ_TARGETS[i].name);
        fputs("\n", stderr);
        exit(2);
    }
    __sanitizer_install_malloc_and_free_hooks(count_malloc, count_free);
    return 0;
}

static double processor_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    double before = processor_seconds();
    long long base = atomic_load(&held);
    atomic_store(&most, base);
    fuzz_run(target, data, size);
    long long taken = atomic_load(&most) - base;
    fuzz_claim(taken <= (long long)size * MEMORY_FACTOR + MEMORY_BASE,
               "%lld bytes of memory for an input of %zu", taken, size);
    double seconds = processor_seconds() - before;
    fuzz_claim(seconds <= SLOWER, "%.1f s for an input of %zu bytes", seconds, size);
    return 0;
}
