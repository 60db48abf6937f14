// SPDX-License-Identifier: MIT
// TressFX's constraints on the GPU against their double-precision form; and the stiffness of
// `steady`, which depends on no other parameter.
#include "support/reference_tressfx.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void shaped(SectionParams *params)
{
    params->tressfx_global_constraint_stiffness = 0.2f;
    params->tressfx_global_constraints_range = 0.4f;
    params->tressfx_local_constraints_iterations = 3;
    params->tressfx_length_constraints_iterations = 5;
}

static void loose(SectionParams *params)
{
    params->tressfx_local_constraint_stiffness = 0.1f;
    params->tressfx_vsp_coeff = 0;
    params->tressfx_damping = 0.02f;
}

static void local_only(SectionParams *params)
{
    params->tressfx_global_constraint_stiffness = 0;
}

// The range ends exactly at a vertex, which is not in the range.
static void range_of_four(SectionParams *params)
{
    params->tressfx_global_constraint_stiffness = 0.2f;
    params->tressfx_global_constraints_range = 0.25f;
}

// The head moves vertices beyond the threshold in most steps; the wind alone never does.
static void clamped(SectionParams *params)
{
    params->tressfx_clamp_position_delta = 1;
}

// Bounds are three times the measured values (twin.h). A strand whips at 240 Hz, with n = 64, and
// with little shape. The free end of a long strand whose first third is held whips more (1.5e-3 at
// 60 Hz), so that n = 64 has local shape only.
static const TwinPair STEADY = {"tressfx", "steady", reference_tressfx_steady, false};
static const TwinPair TRESSFX4 = {"tressfx", "tressfx4", reference_tressfx_4, false};

static void steady_equals_its_double_precision_twin(void **state)
{
    (void)state;
    static const TwinCase cases[] = {
        {2, 60, 1, 0.5, 600, 3 * 1e-7, NULL},
        {3, 60, 1, 0.5, 600, 3 * 7.9e-8, NULL},
        {4, 60, 1, 0.5, 600, 3 * 9.5e-8, NULL},
        {16, 60, 1, 0.5, 600, 3 * 2.8e-7, NULL},
        {16, 240, 1, 0.5, 600, 3 * 5.6e-6, NULL},
        {32, 60, 4, 0.7, 600, 3 * 4.5e-7, shaped},
        {16, 30, 1, 0.5, 600, 3 * 1.8e-7, loose},
        {16, 60, 1, 0.5, 600, 3 * 6.4e-7, loose},
        {64, 60, 1, 0.5, 600, 3 * 1.2e-6, local_only},
        {64, 240, 1, 0.5, 600, 3 * 5.8e-6, local_only},
        {16, 60, 1, 0.5, 60, 3 * 4.2e-7, range_of_four},
        {16, 60, 1, 0.5, 60, 3 * 5.2e-7, clamped},
    };
    twin_require(&STEADY, cases, sizeof cases / sizeof *cases);
}

static void tressfx4_equals_its_double_precision_twin(void **state)
{
    (void)state;
    static const TwinCase cases[] = {
        {2, 60, 1, 0.5, 600, 3 * 9.7e-8, NULL},          {5, 60, 1, 0.5, 600, 3 * 7.9e-8, NULL},
        {16, 60, 1, 0.5, 600, 3 * 2.4e-7, NULL},         {32, 60, 0, 0.7, 600, 3 * 2.7e-7, shaped},
        {16, 60, 1, 0.5, 600, 3 * 4e-6, loose},          {64, 60, 1, 0.5, 600, 3 * 2.4e-6, NULL},
        {16, 60, 1, 0.5, 60, 3 * 3.1e-7, range_of_four}, {16, 60, 1, 0.5, 60, 3 * 2.9e-7, clamped},
    };
    twin_require(&TRESSFX4, cases, sizeof cases / sizeof *cases);
}

// A vertex between a short segment and one more than twice as long moves less.
static void uneven_strands_equal_their_twins_too(void **state)
{
    (void)state;
    static const TwinCase cases[] = {
        {4, 60, 1, 0.5, 60, 3 * 7.3e-8, NULL},
        {16, 60, 1, 0.5, 60, 3 * 4.5e-7, NULL},
        {33, 60, 1, 0.5, 60, 3 * 6.6e-7, local_only},
    };
    twin_require_uneven(&STEADY, cases, 3);
    twin_require_uneven(&TRESSFX4, cases, 2);
}

// A straight strand is held horizontally in gravity (m/s^2). Returns how far its tip is below its
// root after 3 s, relative to its length.
static double sag(const char *variant, int n, double per_second, int passes, float global,
                  float gravity)
{
    Vec start[32] = {{0}}, q[32];
    HairFixture fixture;
    for (int j = 0; j < n; ++j) start[j][0] = 0.25 * j / (n - 1);
    fixture_create(&fixture, (const Vec *)start, 1, n, "tressfx", variant, 0.5f, 1);
    fixture.params.tressfx_local_constraints_iterations = passes;
    fixture.params.tressfx_global_constraint_stiffness = global;
    fixture.params.tressfx_length_constraints_iterations = passes;
    fixture.step.dt = 1 / per_second;
    fixture.step.gravity[1] = -gravity;
    for (int i = 0; i < 3 * (int)per_second; ++i) fixture_step(&fixture);
    twin_read_strand(&fixture, 0, q);
    fixture_destroy(&fixture);
    return -q[n - 1][1] / 0.25;
}

static void spread_of_sags(const char *variant, int n, float global, float gravity, double *least,
                           double *most)
{
    *least = INFINITY, *most = 0;
    for (double per_second = 60; per_second <= 240; per_second *= 2)
        for (int passes = 2; passes <= 4; passes *= 2) {
            double value = sag(variant, n, per_second, passes, global, gravity);
            *least = fmin(*least, value), *most = fmax(*most, value);
        }
    printf(
        "%s, n = %d, 60 to 240 Hz, 2 and 4 passes: the tip hangs by %.3f to %.3f of the length\n",
        variant, n, *least, *most);
}

static void only_the_stiffness_sets_how_stiff_steady_is(void **state)
{
    (void)state;
    double least, most;
    spread_of_sags("steady", 8, 0, 9.81f, &least, &most);
    assert_true(most - least < 0.02 && most < 0.4);
    spread_of_sags("steady", 16, 0, 9.81f, &least, &most);
    assert_true(most - least < 0.04);
    for (int n = 8; n <= 32; n *= 2) { // little bent, with and without the global shape
        for (int global = 0; global < 2; ++global) {
            spread_of_sags("steady", n, 0.4f * (float)global, n < 32 ? 0.5f : 0.1f, &least, &most);
            assert_true(most < 0.3 && most < 1.07 * least);
        }
    }
    spread_of_sags("tressfx4", 8, 0, 9.81f, &least, &most); // shows that the test can fail
    assert_true(most - least > 0.2);
}

// Hair that hangs in its style (--rest hanging) keeps more of the style with the default global
// shape.
static void the_default_global_shape_holds_the_groom(void **state)
{
    (void)state;
    SectionParams params;
    Error error;
    assert_int_equal(params_create_section(&params, &error), RESULT_OK);
    float global = params.tressfx_global_constraint_stiffness;
    params_destroy_section(&params);
    for (double per_second = 60; per_second <= 240; per_second *= 4) {
        double held = sag("steady", 16, per_second, 2, global, 9.81f),
               alone = sag("steady", 16, per_second, 2, 0, 9.81f);
        printf("steady, n = 16 at %.0f Hz: the tip hangs by %.3f, without global shape by %.3f\n",
               per_second, held, alone);
        assert_true(held < 0.9 * alone);
    }
}

// --- Sections with different parameters: simulated together, each moves as it does alone.

static const struct {
    const char *variant;
    float style;
    void (*tune)(SectionParams *params);
} SECTIONS[] = {{"steady", 0.5f, loose}, {"tressfx4", 0.7f, shaped}, {"steady", 0.7f, shaped}};
enum { SECTION_COUNT = sizeof SECTIONS / sizeof *SECTIONS, SECTION_N = 16 };

static void create_section(HairFixture *fixture, int i)
{
    Vec start[SECTION_N];
    twin_make_curl(start, SECTION_N, 0, 2);
    fixture_create_tuned(fixture, (const Vec *)start, 1, SECTION_N, "tressfx", SECTIONS[i].variant,
                         SECTIONS[i].style, 1, SECTIONS[i].tune);
}

static void sections_keep_their_own_parameters(void **state)
{
    (void)state;
    HairFixture together[SECTION_COUNT];
    Vec q[SECTION_COUNT][SECTION_N];
    for (int i = 0; i < SECTION_COUNT; ++i) create_section(&together[i], i);
    for (int step = 0; step < 30; ++step)
        for (int i = 0; i < SECTION_COUNT; ++i) fixture_step(&together[i]);
    for (int i = 0; i < SECTION_COUNT; ++i) {
        HairFixture alone;
        Vec x[SECTION_N];
        create_section(&alone, i);
        for (int step = 0; step < 30; ++step) fixture_step(&alone);
        twin_read_strand(&alone, 0, x);
        twin_read_strand(&together[i], 0, q[i]);
        assert_memory_equal(x, q[i], sizeof x);
        for (int k = 0; k < i; ++k)
            assert_true(twin_rms((const Vec *)q[i], (const Vec *)q[k], SECTION_N, 0.21) > 0.01);
        fixture_destroy(&alone);
    }
    for (int i = 0; i < SECTION_COUNT; ++i) fixture_destroy(&together[i]);
}

// The head moves for one frame, then rests: beyond the threshold of 1.4 cm, the strand moves with
// the root; below, it is left behind.
static void a_jerked_root_takes_the_strand_along(void **state)
{
    (void)state;
    static const struct {
        float way, threshold_cm;
        bool along;
    } cases[] = {
        {0.25f, 1.4f, true}, {0.25f, 1000, false}, {0.0145f, 1.4f, true}, {0.0135f, 1.4f, false}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        Vec start[8] = {{0}}, q[8];
        HairFixture fixture;
        for (int j = 0; j < 8; ++j) start[j][1] = -0.03 * j;
        fixture_create(&fixture, (const Vec *)start, 1, 8, "tressfx", "", 0, 1);
        fixture.params.tressfx_vsp_coeff = 0;
        fixture.params.tressfx_vsp_accel_threshold = cases[i].threshold_cm;
        fixture.step.head.translation[0] = cases[i].way;
        fixture_step(&fixture);
        twin_read_strand(&fixture, 0, q);
        double way = (double)cases[i].way;
        assert_true(cases[i].along ? fabs(q[7][0] - way) < 1e-6 : q[7][0] < 0.8 * way);
        fixture_destroy(&fixture);
    }
}

static void too_long_strands_are_refused_on_cpu_drivers(void **state)
{
    (void)state;
    if (!fixture_gpu()->software) skip();
    Error error;
    Solver solver;
    HairBatch batch = {.vertex_count = 20000, .strand_count = 1};
    const Hair hair = {.batches = &batch, .batch_count = 1};
    SectionParams params;
    assert_int_equal(params_create_section(&params, &error), RESULT_OK);
    free(params.algo);
    params.algo = strdup("tressfx");
    const SolverSetup setup = {.gpu = fixture_gpu(), .hair = &hair, .params = &params};
    assert_int_equal(solver_create(&solver, &setup, &error), RESULT_USAGE);
    assert_non_null(strstr(error.text, "20000"));
    params_destroy_section(&params);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steady_equals_its_double_precision_twin),
        cmocka_unit_test(tressfx4_equals_its_double_precision_twin),
        cmocka_unit_test(uneven_strands_equal_their_twins_too),
        cmocka_unit_test(only_the_stiffness_sets_how_stiff_steady_is),
        cmocka_unit_test(the_default_global_shape_holds_the_groom),
        cmocka_unit_test(sections_keep_their_own_parameters),
        cmocka_unit_test(a_jerked_root_takes_the_strand_along),
        cmocka_unit_test(too_long_strands_are_refused_on_cpu_drivers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
