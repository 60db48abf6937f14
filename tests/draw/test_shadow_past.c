// SPDX-License-Identifier: MIT
// What C finds that a mesh leaves of lights at points of hair, beside the definition of
// glsl/draw/shadow.glsl in double precision.
#include "lanes/shadow_past.h"

#include "base/random.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum {
    SIDE = 64, // texels of a map
    MAPS = 2,
    STRANDS = 40, // the last tile is not full
    VERTICES = 50,
    SLOTS = 48,
    POINTS = SLOTS * VERTICES
};

typedef struct Scene {
    float depths[MAPS][SIDE][SIDE];
    float positions[POINTS][4];
    float left[MAPS][POINTS], reaching[MAPS][POINTS];
    ShadowParams params;
    MappedCaster caster;
} Scene;

static float between(Random *random, double low, double high)
{
    return (float)(low + (high - low) * random_real(random));
}

// A slope with steps, so that tiles lie before, behind and across points; and before the third
// squares a square far off, so that only what stands in their first column or row is before them.
static void make_depths(Scene *scene, Random *random)
{
    for (int m = 0; m < MAPS; ++m)
        for (int y = 0; y < SIDE; ++y)
            for (int x = 0; x < SIDE; ++x) {
                int across = m ? y : x;
                float slope = (x * 3 + y) % 40 < 7 ? 1 : 0.3f + 0.005f * (float)(x + y);
                scene->depths[m][y][x] = across < 16 || across > 32 ? slope : across < 32 ? 1 : 0;
            }
    for (int i = 0; i < 50; ++i)
        scene->depths[i % MAPS][(int)(random_real(random) * SIDE)]
                     [(int)(random_real(random) * SIDE)] = between(random, 0, 1);
}

// The first light is directional, the second a lamp that some points lie behind.
static void make_params(ShadowParams *params)
{
    const float rows[MAPS][4][4] = {
        {{30, 2, 1, 32}, {-1, 33, 0, 30}, {0.1f, 0, 0.5f, 0.5f}, {0, 0, 0, 1}},
        {{30, 2, 30, 30}, {-1, 33, 30, 33}, {0.1f, 0, 0.9f, 0.4f}, {0, 0, 1, 0.9f}}};
    *params = (ShadowParams){.maps = MAPS, .mesh_side = SIDE};
    for (int m = 0; m < MAPS; ++m) {
        memcpy(params->mesh_from_world[m], rows[m], sizeof rows[m]);
        memcpy(params->from_world[m], rows[m], sizeof rows[m]);
        params->place[m][2] = 0.01f;
    }
}

static Scene *make_scene(void)
{
    Scene *scene = calloc(1, sizeof *scene);
    Random random = random_create(7, 0);
    assert_non_null(scene);
    make_depths(scene, &random);
    make_params(&scene->params);
    for (int i = 0; i < POINTS; ++i)
        for (int k = 0; k < 3; ++k) scene->positions[i][k] = between(&random, -1.2, 1.2);
    for (int m = 0; m < MAPS; ++m)
        for (int i = 0; i < POINTS; ++i) scene->left[m][i] = between(&random, 0, 1);
    scene->caster = (MappedCaster){
        .position = (const float(*)[4])scene->positions,
        .material = {.vertex_count = VERTICES, .drawn_strands = STRANDS, .smooth_parts = 1}};
    return scene;
}

static double row_of(const float row[4], const float x[4])
{
    return (double)row[0] * (double)x[0] + (double)row[1] * (double)x[1] +
           (double)row[2] * (double)x[2] + (double)row[3];
}

// What is left past the mesh; `near` says how close the point is to where a rounding decides.
static double past(const Scene *scene, int map, const float x[4], double *near)
{
    const float(*rows)[4] = (const float(*)[4])scene->params.mesh_from_world[map];
    double w = row_of(rows[3], x), sum = 0,
           depth = fmin(row_of(rows[2], x) / w - (double)scene->params.place[map][2], 1);
    double from[2];
    *near = fabs(w);
    if (row_of(scene->params.from_world[map][3], x) <= 0) return 1;
    for (int k = 0; k < 2; ++k) from[k] = fmin(fmax(row_of(rows[k], x) / w - 0.5, 0), SIDE - 2);
    int column = (int)from[0], row = (int)from[1];
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
            double u = from[0] - column, v = from[1] - row,
                   gap = (double)scene->depths[map][row + j][column + i];
            *near = fmin(*near, fabs(gap - depth) + (depth == 1 ? 1 : 0));
            if (gap >= depth) sum += (i ? u : 1 - u) * (j ? v : 1 - v);
        }
    return sum;
}

// Places in the map are off by 2^-23 of some hundred texels near the lamp, where w is 0.01.
static void test_definition(void **state)
{
    (void)state;
    Scene *scene = make_scene();
    ShadowPast bounds = {0};
    Error error = {{0}};
    int whole = 0, none = 0, partly = 0, unclear = 0;
    for (int parts = 1; parts <= 3; ++parts) {
        const float *depths = &scene->depths[0][0][0];
        memset(scene->reaching, 0xff, sizeof scene->reaching);
        assert_int_equal(shadow_past_begin(&bounds, &scene->params, depths, parts, &error),
                         RESULT_OK);
        shadow_past_find(&bounds, &scene->params, depths, &scene->caster, POINTS,
                         &scene->left[0][0], &scene->reaching[0][0], parts);
        for (int m = 0; m < MAPS; ++m)
            for (int i = 0; i < POINTS; ++i) {
                double near, expected = past(scene, m, scene->positions[i], &near);
                if (near < 1e-2 * 1e-2) {
                    ++unclear;
                    continue;
                }
                double got = (double)scene->reaching[m][i] / (double)scene->left[m][i];
                if (!(fabs(got - expected) <= 2e-3))
                    fail_msg("map %d, point %d: %g, expected %g", m, i, got, expected);
                whole += expected == 1, none += expected == 0;
                partly += expected > 0.01 && expected < 0.99;
            }
    }
    shadow_past_destroy(&bounds);
    free(scene);
    assert_true(unclear < 3 * MAPS * POINTS / 100);
    assert_true(whole > POINTS / 4 && none > POINTS / 4 && partly > POINTS / 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_definition)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
