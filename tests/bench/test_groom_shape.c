// SPDX-License-Identifier: MIT
// Distances from a groom, occupied voxels and depths, on strands with known results.
#include "bench/groom_shape.h"
#include "mesh/scalp.h"
#include "support/hair_fixture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

// Two straight strands along x: one of 1 m from the origin, and one of half that length 5 cm above
// it.
enum { LONG = 11, SHORT = 6, POINTS = LONG + SHORT };

typedef struct Stage {
    Strands strands;
    Hair hair;
    Mesh mesh;
    GroomShape shape;
    float (*points)[3]; // the groom's positions in the hair's order, for tests to change
} Stage;

static void create(Stage *stage)
{
    Error error;
    *stage = (Stage){0};
    assert_int_equal(strands_create(&stage->strands, 2, POINTS, &error), RESULT_OK);
    stage->strands.first[1] = LONG, stage->strands.first[2] = POINTS;
    for (int j = 0; j < POINTS; ++j) {
        stage->strands.position[j][0] = 0.1f * (float)(j < LONG ? j : j - LONG);
        stage->strands.position[j][1] = j < LONG ? 0 : 0.05f;
    }
    assert_int_equal(hair_create(&stage->hair, &stage->strands, 0, &fixture_gpu()->limits, &error),
                     RESULT_OK);
    assert_int_equal(scalp_make_mesh(&stage->mesh, SCALP_SPHERE, 32, &error), RESULT_OK);
    if (groom_shape_create(&stage->shape, &stage->hair, &stage->strands, &stage->mesh, &error))
        fail_msg("%s", error.text);
    stage->points = malloc(POINTS * sizeof *stage->points);
    assert_non_null(stage->points);
    memcpy(stage->points, stage->shape.point, POINTS * sizeof *stage->points);
}

static void destroy(Stage *stage)
{
    free(stage->points);
    groom_shape_destroy(&stage->shape);
    mesh_destroy(&stage->mesh);
    hair_destroy(&stage->hair);
    strands_destroy(&stage->strands);
}

static const float (*points_of(const Stage *stage))[3]
{
    return (const float(*)[3])stage->points;
}

static double voxels_of(const Stage *stage)
{
    double count;
    Error error;
    assert_int_equal(groom_shape_voxels(&stage->shape, points_of(stage), &count, &error),
                     RESULT_OK);
    return count;
}

// All particles are moved by 6 cm: 0.06 of the long strand's length, 0.12 of the short one's. Roots
// do not count.
static void test_displacement(void **state)
{
    Stage stage;
    double mean, tips;
    (void)state;
    create(&stage);
    groom_shape_displacement(&stage.shape, points_of(&stage), &mean, &tips);
    assert_true(mean == 0 && tips == 0);
    for (int v = 0; v < POINTS; ++v) stage.points[v][2] += 0.06f;
    groom_shape_displacement(&stage.shape, points_of(&stage), &mean, &tips);
    assert_float_equal(mean, (10 * 0.06 + 5 * 0.12) / 15, 1e-6);
    assert_float_equal(tips, (0.06 + 0.12) / 2, 1e-6);
    assert_float_equal(
        groom_shape_step(&stage.shape, points_of(&stage), (const float(*)[3])stage.shape.point),
        0.12, 1e-6);
    stage.points[3][0] = NAN;
    assert_true(isnan(
        groom_shape_step(&stage.shape, points_of(&stage), (const float(*)[3])stage.shape.point)));
    destroy(&stage);
}

// The mean distance of both tips from the vertical line through x = 1, z = 1.
static void test_spread(void **state)
{
    Stage stage;
    (void)state;
    create(&stage);
    assert_float_equal(
        groom_shape_spread(&stage.shape, points_of(&stage), (const float[3]){1, 7, 1}),
        (1 + hypot(0.5, 1)) / 2, 1e-6);
    destroy(&stage);
}

// Cells of 1 cm with the points in their middles: 101 and 51 cells are occupied, and 101 if both
// strands lie in the same cells, however unevenly they are sampled.
static void test_voxels(void **state)
{
    Stage stage;
    (void)state;
    create(&stage);
    assert_float_equal(stage.shape.edge, 0.01, 1e-7);
    assert_true(stage.shape.voxels == 101 + 51);
    assert_true(voxels_of(&stage) == 101 + 51);
    for (int v = 0; v < POINTS; ++v) stage.points[v][1] = 0.002f;
    assert_true(voxels_of(&stage) == 101);
    // beyond the voxels that are counted separately
    for (int v = 0; v < POINTS; ++v) stage.points[v][0] += 1e12f;
    assert_true(voxels_of(&stage) >= 1);
    stage.points[0][0] = NAN;
    assert_true(isnan(voxels_of(&stage)));
    destroy(&stage);
}

// The groom's roots lie 10 cm and 5 cm deep in a ball of radius 0.1 m. The ball's mesh has flat
// triangles, which are nearer by up to 1 - cos(pi/64) of the radius. A point of the long strand
// that was outside is put 4 cm deep.
static void test_depth(void **state)
{
    Stage stage;
    Error error;
    double deepest, beyond;
    (void)state;
    create(&stage);
    assert_int_equal(groom_shape_depth(&stage.shape, points_of(&stage), &deepest, &beyond, &error),
                     RESULT_OK);
    assert_float_equal(deepest, 0.1, 5e-4);
    assert_true(beyond == 0);
    uint32_t tip = stage.shape.length[0] > 0.75f ? stage.shape.first[1] - 1 : POINTS - 1;
    stage.points[tip][0] = 0.06f;
    assert_int_equal(groom_shape_depth(&stage.shape, points_of(&stage), &deepest, &beyond, &error),
                     RESULT_OK);
    assert_float_equal(deepest, 0.1, 5e-4);
    assert_float_equal(beyond, 0.04, 5e-4);
    destroy(&stage);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_displacement),
        cmocka_unit_test(test_spread),
        cmocka_unit_test(test_voxels),
        cmocka_unit_test(test_depth),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
