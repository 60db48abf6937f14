// SPDX-License-Identifier: MIT
#include "support/driver_threads.h"

#include "support/threads.h"

#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

// FNV-1a hash.
static uint64_t digest(const unsigned char *bytes, size_t size)
{
    uint64_t hash = 0xcbf29ce484222325u;
    for (size_t i = 0; i < size; ++i) hash = (hash ^ bytes[i]) * 0x100000001b3u;
    return hash;
}

void driver_threads_tell(const Gpu *gpu, const void *bytes, size_t size)
{
    const char *asked = getenv("LP_NUM_THREADS");
    int threads = -1;
    // A thread has its name only after it has begun.
    for (int i = 0; i < 500 && strstr(gpu->renderer, "llvmpipe"); ++i) {
        threads = threads_named("llvmpipe");
        if (!asked || threads >= atoi(asked)) break;
        usleep(10000);
    }
    printf("found %016" PRIx64 " of %zu by %d\n", digest(bytes, size), size, threads);
}

void assert_driver_threads_do_not_matter(const char *argument)
{
    char self[400] = "", command[500], line[500];
    uint64_t expected = 0;
    assert_true(readlink("/proc/self/exe", self, sizeof self - 1) > 0);
    for (int i = 0; i < 3; ++i) {
        uint64_t hash = 0;
        size_t size = 0;
        int threads = 0, told = 0;
        snprintf(command, sizeof command, "LP_NUM_THREADS=%d '%s' '%s'", i, self, argument);
        FILE *child = popen(command, "r");
        assert_non_null(child);
        while (fgets(line, sizeof line, child))
            told += sscanf(line, "found %" SCNx64 " of %zu by %d", &hash, &size, &threads) == 3;
        assert_int_equal(pclose(child), 0);
        assert_int_equal(told, 1);
        assert_true(size > 0);
        if (threads >= 0) assert_true(i > 0 ? threads >= i : threads == 0);
        if (i == 0) expected = hash;
        assert_true(hash == expected);
    }
}
