// SPDX-License-Identifier: MIT
// The distance field of a deforming mesh.
#include "sim/moving_field.h"
#include "support/body_fixture.h"
#include "support/hair_fixture.h"
#include "support/shapes.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

typedef struct Ball {
    Mesh mesh;
    Body body;
    Strands strands;
} Ball;

// Stretches along x and rotates.
static void swell(double time, const double rest[3], double place[3])
{
    double c = cos(time), s = sin(time);
    place[0] = (1 + 0.3 * time) * rest[0];
    place[1] = c * rest[1] - s * rest[2];
    place[2] = s * rest[1] + c * rest[2];
}

static void turn(double time, const double rest[3], double place[3])
{
    double c = cos(time), s = sin(time);
    place[0] = rest[0] + 0.1 * time;
    place[1] = c * rest[1] - s * rest[2];
    place[2] = s * rest[1] + c * rest[2];
}

static void make_ball(Ball *ball, BodyMotion *motion)
{
    const Mesh none = {0};
    const BodyOptions options = {"ball", 0.5f, 90, false};
    MeshSequence sequence;
    *ball = (Ball){0};
    shapes_make_sphere(&ball->mesh, 30, 40, 0.1f);
    body_fixture_sample(&sequence, &ball->mesh, motion, 10, 0, 11);
    assert_int_equal(strands_create(&ball->strands, 6, 12, NULL), RESULT_OK);
    for (uint32_t s = 0; s < 6; ++s) {
        ball->strands.first[s] = 2 * s;
        for (uint32_t j = 0; j < 2; ++j)
            ball->strands.position[2 * s + j][s % 3] = (s < 3 ? 0.1f : -0.1f) * (float)(j + 1);
    }
    ball->strands.first[6] = 12;
    assert_int_equal(
        body_create(&ball->body, &sequence, &ball->mesh, &none, &ball->strands, 1, &options, NULL),
        RESULT_OK);
}

static void destroy_ball(Ball *ball)
{
    body_destroy(&ball->body);
    strands_destroy(&ball->strands);
    mesh_destroy(&ball->mesh);
}

static void open_field(MovingField *field, Ball *ball, BodyMotion *motion)
{
    make_ball(ball, motion);
    assert_int_equal(
        moving_field_create(field, fixture_gpu(), &ball->body, 0.1f, 0.002f, 24, &(Error){{0}}),
        RESULT_OK);
}

static void close_field(MovingField *field, Ball *ball)
{
    moving_field_destroy(field);
    destroy_ball(ball);
}

static float (*place(const Body *body, double time))[3]
{
    float(*position)[3] = calloc(body->mesh->vertex_count, sizeof *position);
    assert_non_null(position);
    mesh_sequence_evaluate(&body->sequence, time, position);
    return position;
}

static void update(MovingField *field, const Body *body, double before, double after)
{
    float(*from)[3] = place(body, before), (*to)[3] = place(body, after);
    moving_field_update(field, (const float(*)[3])from, (const float(*)[3])to);
    free(from);
    free(to);
}

// Compares every grid point with the exact distance.
static void check_distances(const MovingField *field, const Body *body, double time)
{
    Mesh mesh = *body->mesh;
    Surface surface;
    mesh.position = place(body, time);
    assert_int_equal(surface_create(&surface, &mesh, "ball", NULL), RESULT_OK);
    float(*texel)[4] = gpu_buffer_read(&field->field.values);
    const uint32_t *size = field->field.size;
    double spacing = (double)field->field.spacing;
    SurfacePoint nearest = {.triangle = surface.triangle[0]};
    for (size_t i = 0; i < distance_field_count(&field->field); i += 7) {
        const size_t at[3] = {i % size[0], i / size[0] % size[1], i / size[0] / size[1]};
        Double3 p;
        for (int k = 0; k < 3; ++k) p[k] = (double)field->field.low[k] + spacing * (double)at[k];
        double exact = surface_nearest(&surface, p, &nearest), found = (double)texel[i][0];
        if (exact > (double)field->outside) {
            assert_true(found > 0.99 * (double)field->outside);
            continue;
        }
        // Within one spacing, distances are exact except for vertices' rounding, 1/128 of a spacing
        // per coordinate. Farther inside, a point has the nearest of its neighbours' triangles. One
        // of the neighbours, a spacing away, is nearer to the surface by at least 1/sqrt(3)
        // spacings, so that the distance to its triangle errs by at most 1 - 1/sqrt(3) spacings.
        double allowed = fabs(exact) < 0.98 * spacing ? 0.0137 * spacing : 0.43 * spacing;
        if (!(fabs(found - exact) < allowed))
            fail_msg("%zu %zu %zu: %g, exact %g (spacing %g)", at[0], at[1], at[2], found, exact,
                     spacing);
    }
    free(texel);
    surface_destroy(&surface);
    free(mesh.position);
}

static void distances_are_those_of_the_mesh_now(void **state)
{
    (void)state;
    Ball ball;
    MovingField field;
    open_field(&field, &ball, swell);
    update(&field, &ball.body, 0, 0);
    check_distances(&field, &ball.body, 0);
    update(&field, &ball.body, 0.7, 0.8);
    check_distances(&field, &ball.body, 0.8);
    assert_int_equal(field.builds, 2);
    close_field(&field, &ball);
}

// The surface's motion: the ball's point now at (x, y, z) was before at x times the ratio of the
// two stretches.
static void samples_know_how_the_surface_moves(void **state)
{
    (void)state;
    Ball ball;
    MovingField field;
    open_field(&field, &ball, swell);
    update(&field, &ball.body, 0.5, 0.6);
    float(*texel)[4] = gpu_buffer_read(&field.field.values);
    const uint32_t *size = field.field.size;
    size_t moving = 0;
    for (size_t i = 0; i < distance_field_count(&field.field); ++i) {
        if (fabsf(texel[i][0]) > 0.2f * field.field.spacing) continue;
        // The head, the best rigid fit of the roots, does not rotate with the stretching mesh.
        float x = field.field.low[0] + field.field.spacing * (float)(i % size[0]);
        float expected = x * (0.3f * 0.1f) / (1 + 0.3f * 0.6f);
        assert_true(fabsf(texel[i][1] - expected) < 0.1f * fabsf(expected) + 2e-4f);
        moving += fabsf(expected) > 1e-3f;
    }
    assert_true(moving > 20);
    update(&field, &ball.body, 0.6, 0.6); // no motion
    free(texel);
    texel = gpu_buffer_read(&field.field.values);
    for (size_t i = 0; i < distance_field_count(&field.field); ++i)
        assert_true(texel[i][1] == 0 && texel[i][2] == 0 && texel[i][3] == 0);
    assert_int_equal(field.builds, 1);
    free(texel);
    close_field(&field, &ball);
}

static void a_rigid_motion_builds_nothing_anew(void **state)
{
    (void)state;
    Ball ball;
    MovingField field;
    open_field(&field, &ball, turn);
    for (int i = 0; i < 20; ++i) update(&field, &ball.body, 0.05 * i, 0.05 * (i + 1));
    assert_int_equal(field.builds, 1);
    close_field(&field, &ball);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(distances_are_those_of_the_mesh_now),
        cmocka_unit_test(samples_know_how_the_surface_moves),
        cmocka_unit_test(a_rigid_motion_builds_nothing_anew),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
