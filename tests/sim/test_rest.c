// SPDX-License-Identifier: MIT
// --rest groom: styled hair is at rest in its file's shape, and moves from there.
#include "support/hair_fixture.h"
#include "support/simulation_fixture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// The fixture's hair on a head that is still from time 0 on, rotated about z by `tilt` (rad).
static void create(SimulationFixture *fixture, const char *algo, const char *variant, float tilt,
                   int rate)
{
    const float still[3] = {0}, turned[3] = {0, 0, tilt};
    simulation_fixture_create(fixture, algo, variant);
    Scene *scene = &fixture->scene;
    track_destroy(&scene->bodies[0].head.translation);
    track_destroy(&scene->bodies[0].head.rotation);
    keyframes_append(&scene->bodies[0].head.translation.keys, 0, still, 3, NULL);
    keyframes_append(&scene->bodies[0].head.rotation.keys, 0, turned, 3, NULL);
    scene->run.wind[0] = 0;
    scene->run.fps = (float)rate;
    scene->sections[0].params.sleep = 0;
}

typedef float Float3[3];

static Float3 *read_positions(SimulationFixture *fixture, int frame)
{
    const Hair *hair = &fixture->simulation.sections[0].hair;
    Float3 *positions = malloc(hair->particle_count * sizeof *positions);
    Error error;
    assert_non_null(positions);
    simulation_fixture_go(fixture, frame);
    assert_int_equal(hair_read_positions(hair, positions, &error), RESULT_OK);
    return positions;
}

// Mean distance of all particles from their earlier positions, relative to the longest strand.
static double displacement(SimulationFixture *fixture, Float3 *from, int frame)
{
    const Hair *hair = &fixture->simulation.sections[0].hair;
    Float3 *to = read_positions(fixture, frame);
    double sum = 0;
    for (uint64_t i = 0; i < hair->particle_count; ++i)
        sum +=
            sqrt(pow((double)(to[i][0] - from[i][0]), 2) + pow((double)(to[i][1] - from[i][1]), 2) +
                 pow((double)(to[i][2] - from[i][2]), 2));
    free(to);
    return sum / (double)hair->particle_count / (double)hair->longest;
}

static double displacement_after(SimulationFixture *fixture, int frame)
{
    simulation_fixture_start(fixture);
    Float3 *start = read_positions(fixture, 0);
    double moved = displacement(fixture, start, frame);
    free(start);
    simulation_fixture_destroy(fixture);
    return moved;
}

static bool is_published(const char *variant)
{
    return strcmp(variant, "thesis") == 0 || strcmp(variant, "tressfx4") == 0;
}

static void check_groom(const char *algo, const char *variant)
{
    static const int rates[] = {30, 60, 240};
    for (int i = 0; i < 3; ++i)
        for (int tilted = 0; tilted < 2; ++tilted) {
            SimulationFixture fixture;
            create(&fixture, algo, variant, tilted ? 0.8f : 0, rates[i]);
            double moved = displacement_after(&fixture, 2 * rates[i]);
            if (is_published(variant) ? moved < 0.005 : !(moved < 1e-4))
                fail_msg("%s %s, %d Hz, %s: moved by %.2g of its length", algo, variant, rates[i],
                         tilted ? "tilted" : "upright", moved);
        }
}

static void a_groom_stays_where_its_file_has_it(void **state)
{
    (void)state;
    simulation_fixture_each(check_groom);
}

static bool never_steps(const char *algo)
{
    return strcmp(algo, "none") == 0;
}

static void check_hanging(const char *algo, const char *variant)
{
    SimulationFixture fixture;
    if (never_steps(algo)) return;
    create(&fixture, algo, variant, 0, 60);
    fixture.scene.sections[0].params.rest = REST_HANGING;
    double moved = displacement_after(&fixture, 120);
    if (!(moved > 0.005)) fail_msg("%s %s moved by %.2g only", algo, variant, moved);
}

static void hanging_hair_falls_from_its_style(void **state)
{
    (void)state;
    simulation_fixture_each(check_hanging);
}

// A head that tilts by a right angle after time 0, so that gravity acts across the hair.
static void check_tilt(const char *algo, const char *variant)
{
    const float turned[3] = {0, 0, 1.5f};
    SimulationFixture fixture;
    if (never_steps(algo)) return;
    create(&fixture, algo, variant, 0, 60);
    keyframes_append(&fixture.scene.bodies[0].head.rotation.keys, 1, turned, 3, NULL);
    simulation_fixture_start(&fixture);
    const Hair *hair = &fixture.simulation.sections[0].hair;
    Float3 *start = read_positions(&fixture, 0), *tilted = read_positions(&fixture, 240);
    double sum = 0, c = cos((double)turned[2]), s = sin((double)turned[2]);
    for (uint64_t i = 0; i < hair->particle_count; ++i) { // compared with a stiff groom
        double x = c * (double)start[i][0] - s * (double)start[i][1] - (double)tilted[i][0],
               y = s * (double)start[i][0] + c * (double)start[i][1] - (double)tilted[i][1];
        sum += sqrt(x * x + y * y);
    }
    double fallen = sum / (double)hair->particle_count / (double)hair->longest;
    free(start);
    free(tilted);
    simulation_fixture_destroy(&fixture);
    if (!(fallen > 0.02)) fail_msg("%s %s fell by %.2g only", algo, variant, fallen);
}

static void a_tilted_head_lets_hair_fall(void **state)
{
    (void)state;
    simulation_fixture_each(check_tilt);
}

// Keyed gravity: the groom balances gravity at time 0, and falls when gravity changes.
static void only_the_first_gravity_is_held(void **state)
{
    (void)state;
    const float first[3] = {3, -9, 1}, later[3] = {-5, -9, 1};
    for (int change = 0; change < 2; ++change) {
        SimulationFixture fixture;
        create(&fixture, "hybrid", "", 0, 60);
        keyframes_append(&fixture.scene.gravity.keys, 0, first, 3, NULL);
        if (change) keyframes_append(&fixture.scene.gravity.keys, 1, later, 3, NULL);
        double moved = displacement_after(&fixture, 120);
        assert_true(change ? moved > 0.02 : moved < 1e-4);
    }
}

static void loose_hair_falls(void **state)
{
    (void)state;
    static const char *const solvers[] = {"split", "hybrid", "chain", "dftl"};
    for (size_t i = 0; i < sizeof solvers / sizeof *solvers; ++i) {
        SimulationFixture fixture;
        create(&fixture, solvers[i], "", 0, 60);
        fixture.scene.sections[0].params.style = 0;
        assert_true(displacement_after(&fixture, 60) > 0.05);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_groom_stays_where_its_file_has_it),
        cmocka_unit_test(hanging_hair_falls_from_its_style),
        cmocka_unit_test(a_tilted_head_lets_hair_fall),
        cmocka_unit_test(only_the_first_gravity_is_held),
        cmocka_unit_test(loose_hair_falls),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
