// SPDX-License-Identifier: MIT
// The levels of cull.h, each against the one below it.
#include "passes/cull.h"

#include "glsl/draw/draw.h"

#include "base/random.h"
#include "support/hair_fixture.h"
#include "support/needed.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

enum { MOST = 41 * 23 };

// The minimum over all tiles (i, j) whose larger tile is (x, y) or next to it.
static float expected(const float *nearest, int columns, int rows, int level, int x, int y)
{
    float least = INFINITY;
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i)
            if (abs((i >> level) - x) <= 1 && abs((j >> level) - y) <= 1)
                least = fminf(least, nearest[j * columns + i]);
    return least;
}

static float *make_levels(const float *nearest, int columns, int rows)
{
    const GpuLimits *limits = &fixture_gpu()->limits;
    int64_t size = (int64_t)sizeof(float) * HIDE_LEVELS * columns * rows;
    Cull cull = {.limits = limits, .tiles = {columns, rows}};
    NEEDED(gpu_buffer_create(&cull.nearest, limits, "tiles", size, nearest, 0, error));
    NEEDED(gpu_buffer_create(&cull.levels, limits, "levels", size, NULL, GL_R32F, error));
    NEEDED(cull_make_levels(&cull, error));
    float *levels = gpu_buffer_read(&cull.levels);
    assert_non_null(levels);
    cull_destroy(&cull);
    return levels;
}

static void each_level_has_the_least_around(void **state)
{
    (void)state;
    static const int sizes[][2] = {{41, 23}, {16, 8}, {1, 1}, {1, 20}, {33, 2}};
    Random random = random_create(1, 0);
    for (size_t c = 0; c < sizeof sizes / sizeof *sizes; ++c) {
        int columns = sizes[c][0], rows = sizes[c][1];
        float nearest[HIDE_LEVELS * MOST] = {0};
        for (int i = 0; i < columns * rows; ++i) nearest[i] = (float)random_real(&random);
        float *levels = make_levels(nearest, columns, rows);
        for (int k = 0; k < HIDE_LEVELS; ++k)
            for (int y = 0; y <= (rows - 1) >> k; ++y)
                for (int x = 0; x <= (columns - 1) >> k; ++x)
                    assert_true(levels[(k * rows + y) * columns + x] ==
                                expected(nearest, columns, rows, k, x, y));
        free(levels);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(each_level_has_the_least_around)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
