// SPDX-License-Identifier: MIT
// The share of a light that a mesh leaves at points, computed over lanes, against its definition in
// double precision.
#include "lanes/shadow.h"

#include "base/random.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum {
    W = STRAND_TILE,
    SIDE = 64, // texels of a map
    MAPS = 2,
    ROWS = 150, // of W points each
    POINTS = ROWS * W,
    SQUARES = SIDE / SHADOW_MESH_SQUARE
};

typedef struct MeshScene {
    float depths[MAPS][SIDE][SIDE], bounds[MAPS * SQUARES * SQUARES][2];
    float positions[ROWS][3][W], past[MAPS][ROWS][W], covered[ROWS][W];
    LaneShadow shadow;
    int taps;
} MeshScene;

static float between(Random *random, double low, double high)
{
    return (float)(low + (high - low) * random_real(random));
}

// A slope with steps, so that tiles lie in front of, behind and across points. One column or row of
// texels, the first of a square, is near the light while the rest of that square is far away, so
// that only it lies in front of the points.
static void make_depths(MeshScene *scene, Random *random)
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

// The first light is directional; the second is a lamp, and some points lie behind it.
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

static MeshScene *make_scene(void)
{
    MeshScene *scene = calloc(1, sizeof *scene);
    Random random = random_create(7, 0);
    assert_non_null(scene);
    make_depths(scene, &random);
    make_params(&scene->shadow.params);
    for (int i = 0; i < ROWS; ++i)
        for (int k = 0; k < 3 * W; ++k)
            scene->positions[i][k / W][k % W] = between(&random, -1.2, 1.2);
    scene->shadow.mesh.depths = &scene->depths[0][0][0];
    scene->shadow.mesh.bounds = scene->bounds;
    return scene;
}

static double row_of(const float row[4], const float x[3])
{
    return (double)row[0] * (double)x[0] + (double)row[1] * (double)x[1] +
           (double)row[2] * (double)x[2] + (double)row[3];
}

// The share of light that passes the mesh; `near` becomes the distance from where rounding decides.
static double past(const MeshScene *scene, int map, const float x[3], double *near)
{
    const ShadowParams *params = &scene->shadow.params;
    const float(*rows)[4] = (const float(*)[4])params->mesh_from_world[map];
    double w = row_of(rows[3], x), sum = 0, from[2],
           depth = fmin(row_of(rows[2], x) / w - (double)params->place[map][2], 1);
    int taps = scene->taps, first[2];
    *near = fabs(w);
    for (int k = 0; k < 2; ++k) {
        from[k] = fmin(fmax(row_of(rows[k], x) / w - 0.5 * (taps - 1), 0), SIDE - taps);
        first[k] = (int)from[k];
        from[k] -= first[k];
    }
    for (int j = 0; j < taps; ++j)
        for (int i = 0; i < taps; ++i) {
            double u = i == 0          ? 1 - from[0]
                       : i == taps - 1 ? from[0]
                                       : 1,
                   v = j == 0          ? 1 - from[1]
                       : j == taps - 1 ? from[1]
                                       : 1,
                   gap = (double)scene->depths[map][first[1] + j][first[0] + i];
            *near = fmin(*near, fabs(gap - depth) + (depth == 1 ? 1 : 0));
            if (gap >= depth) sum += u * v;
        }
    return sum / ((taps - 1) * (taps - 1));
}

SIMD_INLINE void find(const MeshScene *scene, int part)
{
    MeshScene *out = (MeshScene *)scene;
    (void)part;
    for (int m = 0; m < MAPS; ++m)
        for (int i = 0; i < ROWS; ++i)
            shadow_look_mesh(&scene->shadow, m, scene->positions[i], scene->taps, out->past[m][i],
                             out->covered[i]);
}

SIMD_STAGE(find, MeshScene)

// Near the lamp, where w is 0.01, positions in the map err by 2^-23 of several hundred texels.
static void test_definition(void **state)
{
    (void)state;
    MeshScene *scene = make_scene();
    for (int parts = 1; parts <= 3; ++parts) {
        int whole = 0, none = 0, partly = 0, unclear = 0;
        scene->taps = 2 * parts;
        shadow_mesh_bound(scene->shadow.mesh.depths, SIDE, MAPS, scene->bounds, parts);
        run_find(scene, 1);
        for (int m = 0; m < MAPS; ++m)
            for (int i = 0; i < POINTS; ++i) {
                const float x[3] = {scene->positions[i / W][0][i % W],
                                    scene->positions[i / W][1][i % W],
                                    scene->positions[i / W][2][i % W]};
                double near, expected = past(scene, m, x, &near),
                             got = (double)scene->past[m][i / W][i % W];
                if (near < 1e-2 * 1e-2) {
                    ++unclear;
                    continue;
                }
                if (!(fabs(got - expected) <= 2e-3))
                    fail_msg("map %d, point %d: %g, expected %g", m, i, got, expected);
                whole += expected == 1, none += expected == 0;
                partly += expected > 0.01 && expected < 0.99;
            }
        assert_true(unclear < MAPS * POINTS / 50);
        assert_true(whole > POINTS / 16 && none > POINTS / 16 && partly > POINTS / 16);
    }
    free(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_definition)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
