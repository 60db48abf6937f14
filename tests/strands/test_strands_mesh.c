// SPDX-License-Identifier: MIT
// Hair on a mesh: fitting hair to it, moving roots onto it, pushing hair out of it, and depths
// inside it.
#include "formats/mesh_read.h"
#include "formats/strands_read.h"
#include "mesh/scalp.h"
#include "strands/strands_mesh.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// A ball of radius 0.1 m, whose triangles are at most 0.22 mm below it: 0.1 (1 - cos(pi / 48)).
static const double RADIUS = 0.1, FLAT = 2.2e-4;
enum { RINGS = 48 };

typedef struct Ball {
    Mesh mesh;
    Surface surface;
} Ball;

static void make_ball(Ball *ball, uint32_t rings)
{
    assert_int_equal(scalp_make_mesh(&ball->mesh, SCALP_SPHERE, rings, NULL), RESULT_OK);
    assert_int_equal(surface_create(&ball->surface, &ball->mesh, "ball", NULL), RESULT_OK);
}

static void destroy_ball(Ball *ball)
{
    surface_destroy(&ball->surface);
    mesh_destroy(&ball->mesh);
}

// Strands of three vertices along x, y and z, at these distances from the centre.
static Strands make_spokes(float root, float middle, float tip)
{
    Strands strands;
    const float at[3] = {root, middle, tip};
    assert_int_equal(strands_create(&strands, 3, 9, NULL), RESULT_OK);
    for (uint32_t s = 0; s < 3; ++s) {
        strands.first[s + 1] = 3 * (s + 1);
        for (uint32_t k = 0; k < 3; ++k) strands.position[3 * s + k][s] = at[k];
    }
    return strands;
}

static double height_of(const float position[3])
{
    Double3 at;
    double3_from_float(position, at);
    return double3_length(at);
}

static void roots_are_put_onto_the_mesh_and_strands_keep_their_shape(void **state)
{
    (void)state;
    Ball ball;
    StrandsShift shift;
    Strands strands = make_spokes(0.104f, 0.15f, 0.2f);
    strands.position[3][1] = 0.09f; // below the skin
    make_ball(&ball, RINGS);
    assert_int_equal(strands_attach(&strands, &ball.surface, &shift, NULL), RESULT_OK);
    for (uint32_t s = 0; s < 3; ++s)
        assert_float_equal(height_of(strands.position[3 * s]), RADIUS, FLAT);
    assert_float_equal(strands.position[1][0] - strands.position[0][0], 0.046, 1e-7);
    assert_float_equal(strands.position[5][1] - strands.position[3][1], 0.11, 1e-7);
    assert_int_equal(shift.strands, 3);
    assert_float_equal(shift.median, 0.004, FLAT);
    assert_float_equal(shift.most, 0.01, FLAT);
    strands_destroy(&strands);
    destroy_ball(&ball);
}

static void depth_is_the_distance_below_the_surface_but_of_roots(void **state)
{
    (void)state;
    Ball ball;
    double depth[9];
    Strands strands = make_spokes(0.05f, 0.07f, 0.2f);
    make_ball(&ball, RINGS);
    float before[9][3];
    memcpy(before, strands.position, sizeof before);
    assert_int_equal(strands_find_depth(&strands, &ball.surface, depth, NULL), RESULT_OK);
    assert_memory_equal(strands.position, before, sizeof before);
    for (uint32_t s = 0; s < 3; ++s) {
        assert_true(depth[3 * s] < 0); // a root
        assert_float_equal(depth[3 * s + 1], 0.03, FLAT);
        assert_float_equal(depth[3 * s + 2], -0.1, FLAT);
    }
    strands_destroy(&strands);
    destroy_ball(&ball);
}

static void vertices_are_pushed_out_to_the_gap_and_no_others_move(void **state)
{
    (void)state;
    Ball ball;
    StrandsShift shift;
    Strands strands = make_spokes(0.098f, 0.07f, 0.2f);
    strands.position[5][1] = 0.1005f; // outside, but nearer than the gap
    make_ball(&ball, RINGS);
    assert_int_equal(strands_push_out(&strands, &ball.surface, 0.001, &shift, NULL), RESULT_OK);
    for (uint32_t s = 0; s < 3; ++s) {
        assert_float_equal(height_of(strands.position[3 * s]), 0.098, 1e-7); // roots stay
        assert_float_equal(height_of(strands.position[3 * s + 1]), RADIUS + 0.001, FLAT);
    }
    assert_float_equal(strands.position[5][1], RADIUS + 0.001, FLAT);
    assert_true(strands.position[2][0] == 0.2f && strands.position[8][2] == 0.2f);
    assert_int_equal(shift.vertices, 4);
    assert_int_equal(shift.strands, 3);
    assert_float_equal(shift.median, 0.03, FLAT); // of the strands that were inside
    assert_float_equal(shift.most, 0.03, FLAT);
    strands_destroy(&strands);
    destroy_ball(&ball);
}

// A groom of another size, rotated and moved, is fitted back. The bob's roots are 0.1 mm off the
// bundled head's mesh, a thousandth of its radius: 0.3 %, 0.3 degrees and 1 mm are allowed.
static void a_groom_is_scaled_turned_and_moved_onto_its_head(void **state)
{
    (void)state;
    Mesh mesh;
    Surface surface;
    StrandsFit fit;
    const struct {
        double scale, turn_deg;
        int axis;
        double way[3];
    } cases[] = {{1, 0, 0, {0, 0, 0}},
                 {1.25, 12, 1, {0.03, -0.02, 0.01}},
                 {0.02, 20, 0, {3, 1, -2}},
                 {40, 15, 2, {0, 0, 90}}};
    assert_int_equal(mesh_read(&mesh, "assets/head.obj", 1, false, NULL), RESULT_OK);
    assert_int_equal(surface_create(&surface, &mesh, "head", NULL), RESULT_OK);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        Strands strands, own;
        StrandsMove move = strands_move_rotation(cases[i].axis, cases[i].turn_deg);
        assert_int_equal(strands_read(&own, "assets/bob.tfx", NULL, NULL, NULL), RESULT_OK);
        assert_int_equal(strands_join(&strands, &own, 1, NULL), RESULT_OK);
        move.scale = cases[i].scale;
        memcpy(move.translation, cases[i].way, sizeof move.translation);
        strands_move(&strands, &move);
        assert_int_equal(strands_find_fit(&fit, &strands, &surface, NULL), RESULT_OK);
        assert_float_equal(fit.move.scale * cases[i].scale, 1, 3e-3);
        assert_float_equal(fit.turned_deg, cases[i].turn_deg, 0.3);
        assert_true(fit.after < 2e-4);
        strands_move(&strands, &fit.move);
        for (uint32_t s = 0; s < own.strand_count; ++s)
            for (int k = 0; k < 3; ++k)
                assert_float_equal(strands.position[own.first[s]][k], own.position[own.first[s]][k],
                                   1e-3);
        strands_destroy(&strands);
        strands_destroy(&own);
    }
    surface_destroy(&surface);
    mesh_destroy(&mesh);
}

static void two_strands_tell_no_fit(void **state)
{
    (void)state;
    Ball ball;
    StrandsFit fit;
    Error error = {""};
    Strands strands = make_spokes(0.1f, 0.15f, 0.2f);
    make_ball(&ball, 8);
    strands.strand_count = 2;
    assert_int_equal(strands_find_fit(&fit, &strands, &ball.surface, &error), RESULT_FAILED);
    assert_string_equal(error.text, "2 strands: expected at least 3 to fit a groom");
    strands_destroy(&strands);
    destroy_ball(&ball);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(roots_are_put_onto_the_mesh_and_strands_keep_their_shape),
        cmocka_unit_test(depth_is_the_distance_below_the_surface_but_of_roots),
        cmocka_unit_test(vertices_are_pushed_out_to_the_gap_and_no_others_move),
        cmocka_unit_test(a_groom_is_scaled_turned_and_moved_onto_its_head),
        cmocka_unit_test(two_strands_tell_no_fit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
