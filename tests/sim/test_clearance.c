// SPDX-License-Identifier: MIT
// Colliders do not push a groom at rest, however near or deep it lies. If it moves, they keep it at
// its rest depth or at the margin.
#include "support/hair_fixture.h"
#include "support/simulation_fixture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { STRANDS = 16, N = 10, FPS = 60 };
static const double RADIUS = 0.1, MARGIN = 1e-3;
static const char HEAD[] = "sphere:0,0,0,0.1";

// Height above the ball, m: from 4 mm deep to 3.5 mm outside.
static double height_of(int strand)
{
    return 5e-4 * (strand - STRANDS / 2);
}

// Strands along the ball's meridians, from near its top to its equator.
static void lay_strands(Strands *strands)
{
    strands_destroy(strands);
    assert_int_equal(strands_create(strands, STRANDS, STRANDS * N, NULL), RESULT_OK);
    for (int s = 0; s < STRANDS; ++s)
        for (int j = 0; j < N; ++j) {
            double around = 2 * M_PI * s / STRANDS, down = 0.3 + 1.2 * j / (N - 1),
                   r = RADIUS + height_of(s);
            float *at = strands->position[s * N + j];
            strands->first[s] = (uint32_t)(s * N);
            at[0] = (float)(r * sin(down) * cos(around));
            at[1] = (float)(r * cos(down));
            at[2] = (float)(r * sin(down) * sin(around));
        }
    strands->first[STRANDS] = STRANDS * N;
}

static void create(SimulationFixture *fixture, const char *algo, const char *variant, bool still)
{
    Error error;
    simulation_fixture_create(fixture, algo, variant);
    lay_strands(&fixture->strands);
    memset(fixture->scene.run.wind, 0, sizeof fixture->scene.run.wind);
    fixture->scene.run.gust = 0;
    fixture->scene.sections[0].params.sleep = 0;
    if (still) rigid_track_destroy(&fixture->scene.bodies[0].head);
    if (still) fixture->scene.bodies[0].head = (RigidTrack){0};
    assert_int_equal(colliders_parse(&fixture->scene.bodies[0].colliders, HEAD, &error), RESULT_OK);
}

static bool keeps_groom(const char *algo, const char *variant)
{
    SimulationFixture fixture;
    simulation_fixture_create(&fixture, algo, variant);
    bool keeps = solver_keeps_groom(&fixture.scene.sections[0].params) &&
                 strcmp(algo, "none") != 0; // `none` is not pushed at all
    simulation_fixture_destroy(&fixture);
    return keeps;
}

// Drawn positions without the head's motion.
static float (*read_points(const SimulationFixture *fixture, const Hair *hair))[3]
{
    const HeadPose *head = &fixture->simulation.bodies[0].head;
    float(*points)[3] = calloc(hair->particle_count, sizeof *points);
    assert_non_null(points);
    assert_int_equal(hair_read_positions(hair, points, NULL), RESULT_OK);
    versor back;
    glm_quat_conjugate((float *)head->rotation, back);
    for (uint64_t i = 0; i < hair->particle_count; ++i) {
        for (int k = 0; k < 3; ++k) points[i][k] -= head->translation[k];
        glm_quat_rotatev(back, points[i], points[i]);
    }
    return points;
}

static double norm(const float v[3])
{
    return sqrt((double)v[0] * (double)v[0] + (double)v[1] * (double)v[1] +
                (double)v[2] * (double)v[2]);
}

// Half a millimetre of 12 cm is 4e-3; rounding and tressfx's iterations leave 1e-5.
static void check_rest(const char *algo, const char *variant)
{
    SimulationFixture fixture;
    if (!keeps_groom(algo, variant)) return;
    create(&fixture, algo, variant, true);
    simulation_fixture_start(&fixture);
    simulation_fixture_go(&fixture, FPS);
    float(*points)[3] = read_points(&fixture, &fixture.simulation.sections[0].hair);
    double most = 0;
    for (int i = 0; i < STRANDS * N; ++i) {
        float off[3];
        for (int k = 0; k < 3; ++k) off[k] = points[i][k] - fixture.strands.position[i][k];
        most = fmax(most, norm(off));
    }
    if (most > 2e-6) fail_msg("%s %s: %g m from the groom", algo, variant, most);
    uint64_t contacts = simulation_report(&fixture.simulation).contacts;
    if (contacts) fail_msg("%s %s: %llu contacts", algo, variant, (unsigned long long)contacts);
    free(points);
    simulation_fixture_destroy(&fixture);
}

static void a_groom_in_a_collider_stays_there(void **state)
{
    (void)state;
    simulation_fixture_each(check_rest);
}

// The tolerance of a clearance (collide.comp) is 1e-4 of the longest strand, and as much remains of
// a depth that is pushed out (test_solvers_collision.c).
static void check_held(const char *algo, const char *variant)
{
    SimulationFixture fixture;
    if (!keeps_groom(algo, variant)) return;
    create(&fixture, algo, variant, false);
    fixture.scene.run.wind[0] = 6;
    fixture.scene.run.wind[1] = -6;
    fixture.scene.sections[0].params.drag = 4;
    simulation_fixture_start(&fixture);
    double moved = 0;
    for (int frame = 2; frame <= FPS; frame += 2) {
        simulation_fixture_go(&fixture, frame);
        float(*points)[3] = read_points(&fixture, &fixture.simulation.sections[0].hair);
        for (int i = 0; i < STRANDS * N; ++i) {
            double height = norm(points[i]) - RADIUS, own = height_of(i / N);
            double length = 1.2 * (RADIUS + height_of(STRANDS));
            moved = fmax(moved, fabs(height - own));
            if (height < fmin(MARGIN, own) - 2e-4 * length)
                fail_msg("%s %s, frame %d: strand %d at %g m, in the groom at %g m", algo, variant,
                         frame, i / N, height, own);
        }
        free(points);
    }
    if (!(moved > 1e-3)) fail_msg("%s %s: moved only %g m", algo, variant, moved);
    simulation_fixture_destroy(&fixture);
}

static void hair_that_moves_gets_no_deeper_than_its_groom(void **state)
{
    (void)state;
    simulation_fixture_each(check_held);
}

// The number of particles that touch the ball after a few steps.
static uint64_t contacts_of(RestRule rest, float style)
{
    SimulationFixture fixture;
    create(&fixture, "hybrid", "", true);
    fixture.scene.sections[0].params.rest = (int)rest;
    fixture.scene.sections[0].params.style = style;
    simulation_fixture_start(&fixture);
    simulation_fixture_go(&fixture, 3);
    uint64_t contacts = simulation_report(&fixture.simulation).contacts;
    simulation_fixture_destroy(&fixture);
    return contacts;
}

static void hair_that_hangs_or_is_loose_is_pushed_out(void **state)
{
    (void)state;
    assert_true(contacts_of(REST_GROOM, 0.5f) == 0);
    assert_true(contacts_of(REST_HANGING, 0.5f) > 0);
    assert_true(contacts_of(REST_GROOM, 0) > 0);
}

// How far followers have moved from their start after half a second at rest, m.
static double followers_off(bool collide)
{
    SimulationFixture fixture;
    create(&fixture, "hybrid", "", true);
    SectionParams *params = &fixture.scene.sections[0].params;
    params->followers = (AutoInt){.value = 3};
    params->follow = FOLLOW_OFFSET;
    params->follower_radius = (AutoFloat){.value = 0.003f};
    params->collide = collide;
    simulation_fixture_start(&fixture);
    const Hair *hair = &fixture.simulation.sections[0].follow.hair;
    float(*before)[3] = read_points(&fixture, hair);
    simulation_fixture_go(&fixture, FPS / 2);
    float(*after)[3] = read_points(&fixture, hair);
    double most = 0, deepest = 0;
    for (uint64_t i = 0; i < hair->particle_count; ++i) {
        float off[3];
        for (int k = 0; k < 3; ++k) off[k] = after[i][k] - before[i][k];
        most = fmax(most, norm(off));
        deepest = fmin(deepest, norm(before[i]) - RADIUS);
    }
    assert_true(deepest < -0.003); // some start inside and stay there
    free(before);
    free(after);
    simulation_fixture_destroy(&fixture);
    return most;
}

static void followers_keep_their_own_place(void **state)
{
    (void)state;
    assert_true(followers_off(true) < 2e-6);
    assert_true(followers_off(false) < 2e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_groom_in_a_collider_stays_there),
        cmocka_unit_test(hair_that_moves_gets_no_deeper_than_its_groom),
        cmocka_unit_test(hair_that_hangs_or_is_loose_is_pushed_out),
        cmocka_unit_test(followers_keep_their_own_place),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
