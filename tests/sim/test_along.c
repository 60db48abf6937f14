// SPDX-License-Identifier: MIT
// Parameters that vary along the strand, in every solver that supports it.
#include "support/hair_fixture.h"
#include "support/simulation_fixture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { SECTIONS_PARAMS = 4, FRAMES = 20 };

typedef float Float3[3];

// Positions after some frames with parameters given like flags: "style", "0.5", NULL.
static Float3 *simulate(const char *algo, const char *variant, const char *const *settings,
                        uint64_t *count)
{
    SimulationFixture fixture;
    Error error;
    simulation_fixture_create(&fixture, algo, variant);
    fixture.scene.sections[0].params.rest = REST_HANGING; // so that gravity moves the hair
    for (; *settings; settings += 2)
        assert_int_equal(params_parse(params_find(settings[0]), &fixture.scene.sections[0].params,
                                      settings[1], &error),
                         RESULT_OK);
    simulation_fixture_start(&fixture);
    simulation_fixture_go(&fixture, FRAMES);
    const Hair *hair = &fixture.simulation.sections[0].hair;
    Float3 *positions = malloc(hair->particle_count * sizeof *positions);
    assert_int_equal(hair_read_positions(hair, positions, &error), RESULT_OK);
    *count = hair->particle_count;
    simulation_fixture_destroy(&fixture);
    return positions;
}

static double farthest(const char *algo, const char *variant, const char *const *a,
                       const char *const *b)
{
    uint64_t count;
    Float3 *one = simulate(algo, variant, a, &count), *other = simulate(algo, variant, b, &count);
    double most = 0;
    for (uint64_t i = 0; i < count; ++i)
        for (int k = 0; k < 3; ++k) most = fmax(most, fabs((double)(one[i][k] - other[i][k])));
    free(one);
    free(other);
    return most;
}

static const char *const PLAIN[] = {
    "style", "0.6", "style-stiffness", "150", "drag", "2", "gravity-share", "0.7", NULL};

// Rounding differs, because one form multiplies once and the other for each vertex, and the
// difference grows over 20 steps.
static void check_constant(const char *algo, const char *variant)
{
    static const char *const constant[] = {"style",           "0.6:0.6", "style-stiffness",
                                           "150:150@0.5:150", "drag",    "2:2",
                                           "gravity-share",   "0.7:0.7", NULL};
    double off = farthest(algo, variant, PLAIN, constant);
    if (!(off < 2e-5)) fail_msg("%s %s: off by %g m", algo, variant, off);
}

static void a_profile_of_one_number_is_that_number(void **state)
{
    (void)state;
    simulation_fixture_each(check_constant);
}

static void check_each(const char *algo, const char *variant)
{
    static const char *const profiles[][9] = {
        {"style", "0.9:0.3", "style-stiffness", "150", "drag", "2", "gravity-share", "0.7", NULL},
        {"style", "0.6", "style-stiffness", "250:50", "drag", "2", "gravity-share", "0.7", NULL},
        {"style", "0.6", "style-stiffness", "150", "drag", "4:0", "gravity-share", "0.7", NULL},
        {"style", "0.6", "style-stiffness", "150", "drag", "2", "gravity-share", "0.4:1", NULL},
    };
    static const char *const styles[] = {"chain", "rod", "hybrid", "emulation", "rope", "dftl"};
    bool published = strcmp(variant, "thesis") == 0 || strcmp(variant, "tressfx4") == 0;
    bool stands = published || strcmp(algo, "none") == 0, springs = false;
    for (size_t i = 0; i < sizeof styles / sizeof *styles; ++i)
        springs |= strcmp(algo, styles[i]) == 0;
    for (int i = 0; i < SECTIONS_PARAMS; ++i) {
        bool takes = !stands && (i != 1 || springs) && (i < 2 || strcmp(algo, "split") != 0);
        double off = farthest(algo, variant, PLAIN, profiles[i]);
        if (takes ? !(off > 1e-4) : !(off < 1e-6))
            fail_msg("%s %s, %s: differs by %g m", algo, variant, profiles[i][2 * i], off);
    }
}

// Published algorithms and split's tip use the mean, which PLAIN has.
static void every_solver_takes_what_it_says(void **state)
{
    (void)state;
    simulation_fixture_each(check_each);
}

// How far vertex 2 of the strands of eight vertices (the first ones) has moved from a stiff groom,
// relative to their tips.
static double root_over_tip(const char *const *settings)
{
    enum { N = 8, STRANDS = 10 };
    static const char *const rigid[] = {"style", "0.999", NULL};
    uint64_t count;
    Float3 *moved = simulate("hybrid", "", settings, &count),
           *groom = simulate("hybrid", "", rigid, &count);
    double gone[2] = {0};
    for (int s = 0; s < STRANDS; ++s)
        for (int end = 0; end < 2; ++end)
            for (int k = 0; k < 3; ++k)
                gone[end] += fabs((double)(moved[s * N + (end ? N - 1 : 2)][k] -
                                           groom[s * N + (end ? N - 1 : 2)][k]));
    free(moved);
    free(groom);
    return gone[0] / gone[1];
}

static void stiff_roots_let_tips_swing(void **state)
{
    (void)state;
    static const char *const stiff_root[] = {"style", "0.95:0.3", NULL}, *const stiff_tip[] = {
                                                                             "style", "0.3:0.95",
                                                                             NULL};
    assert_true(root_over_tip(stiff_root) < 0.5 * root_over_tip(stiff_tip));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_profile_of_one_number_is_that_number),
        cmocka_unit_test(every_solver_takes_what_it_says),
        cmocka_unit_test(stiff_roots_let_tips_swing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
