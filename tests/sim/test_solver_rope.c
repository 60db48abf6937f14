// SPDX-License-Identifier: MIT
// Position-based rope on the GPU against its double-precision form and the exact motion.
#include "support/reference_motion.h"
#include "support/reference_rope.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void stretched(SectionParams *params)
{
    params->stretch_drawn = true;
}

static void two_sweeps(SectionParams *params)
{
    params->rope_iterations = 2;
    params->stretch_drawn = true;
}

static void slow_and_damped(SectionParams *params)
{
    params->rope_iterations = 3;
    params->rope_damping = 0.05f;
    params->rope_time_scale = 0.5f;
}

static void fifty_sweeps(SectionParams *params)
{
    params->rope_iterations = 50;
}

static void compliant(SectionParams *params)
{
    params->rope_compliance = 1e-5f;
}

static const TwinPair BULLET = {"rope", "bullet", reference_rope_bullet_step, true};
static const TwinPair XPBD = {"rope", "xpbd", reference_rope_xpbd_step, true};

// Bounds are three times the measured values, the larger of a CPU with and without AVX.
static void bullets_rope_equals_its_double_precision_twin(void **state)
{
    (void)state;
    static const TwinCase cases[] = {
        {2, 60, 1, 0, 600, 3 * 4.3e-7, NULL},
        {16, 60, 1, 0, 600, 3 * 2.5e-7, NULL},
        {32, 60, 0, 0, 600, 3 * 4.3e-7, NULL},
        {33, 60, 4, 0, 600, 3 * 1.4e-7, NULL},
        {64, 60, 1, 0, 600, 3 * 2.5e-7, NULL},
        {16, 60, 1, 0, 600, 3 * 1.1e-7, slow_and_damped},
        {64, 60, 1, 0, 600, 3 * 3e-7, slow_and_damped},
        {16, 60, 1, 0, 600, 3 * 2e-7, stretched},
        {16, 60, 1, 0.5, 600, 3 * 8.9e-7, NULL},
        {64, 60, 1, 0.8, 600, 3 * 8.6e-8, NULL},
    };
    twin_require(&BULLET, cases, sizeof cases / sizeof *cases);
}

// Measured with drag 4/s after 600 steps of 10 sub-steps: at most 3e-7 of the length, or 2e-5 if
// displacements were differences of positions. With less drag the motion is chaotic, so that only
// its first second is compared: 1.4e-6, and 1e-4 with 12,000 sub-steps (0.07 with such differences;
// 1e-5 with drag 4/s).
static void xpbd_equals_its_double_precision_twin(void **state)
{
    (void)state;
    static const TwinCase cases[] = {
        {2, 60, 4, 0, 600, 3 * 2.3e-7, NULL},
        {16, 60, 4, 0, 600, 3 * 2e-7, NULL},
        {32, 60, 4, 0, 600, 3 * 2.7e-7, NULL},
        {33, 60, 4, 0, 600, 3 * 2.1e-7, NULL},
        {64, 60, 4, 0, 600, 3 * 1.9e-7, NULL},
        {16, 60, 1, 0, 60, 3 * 1.4e-6, NULL},
        {64, 60, 1, 0, 12, 3 * 2.1e-7, NULL},
        {16, 60, 4, 0, 600, 3 * 1.5e-7, slow_and_damped},
        {64, 60, 4, 0, 600, 3 * 2.1e-7, compliant},
        {16, 60, 4, 0, 600, 3 * 2.1e-7, stretched},
        {16, 60, 4, 0.5, 60, 3 * 3.4e-7, NULL},
        {64, 60, 4, 0.8, 20, 3 * 3e-7, NULL},
        {16, 240, 1, 0, 240, 3 * 1e-4, fifty_sweeps},
        {33, 240, 4, 0, 240, 3 * 1e-5, fifty_sweeps},
    };
    twin_require(&XPBD, cases, sizeof cases / sizeof *cases);
}

// The reference implementation of position-based dynamics has errors of 0.65 and 0.18 with 2 and 10
// sweeps; Bullet's links, which overcorrect large stretch, have less.
static void bullets_rope_errs_no_more_than_the_reference_implementation(void **state)
{
    (void)state;
    assert_true(reference_mean_error("rope", "bullet", 1, two_sweeps) < 0.65);
    assert_true(reference_mean_error("rope", "bullet", 1, stretched) < 0.18);
    assert_true(reference_mean_error("rope", "bullet", 1, NULL) < 0.1);
}

// The reference implementation's errors with 10 sub-steps: 0.040, 0.020 and 0.012.
static void xpbd_errs_as_the_reference_implementation(void **state)
{
    (void)state;
    assert_true(fabs(reference_mean_error("rope", "xpbd", 1, stretched) - 0.040) < 0.001);
    assert_true(fabs(reference_mean_error("rope", "xpbd", 2, stretched) - 0.020) < 0.001);
    assert_true(fabs(reference_mean_error("rope", "xpbd", 4, stretched) - 0.012) < 0.0005);
}

// A hanging rope of two links with compliance alpha: the upper link carries 2 g and the lower one 1
// g, so that they are longer by 2 alpha g and alpha g. During a sweep, each particle is h^2 g below
// its rest position.
static void compliance_is_stretch_over_acceleration(void **state)
{
    (void)state;
    const double alpha = (double)1e-4f, g = (double)9.81f;
    const Vec start[3] = {{0, 0, 0}, {0, -0.1, 0}, {0, -0.2, 0}};
    Vec q[3];
    const double fall = g / (600.0 * 600.0);
    HairFixture fixture;
    fixture_create(&fixture, start, 1, 3, "rope", "xpbd", 0, 20);
    fixture.params.rope_compliance = (float)alpha;
    fixture.params.stretch_drawn = true;
    for (int i = 0; i < 600; ++i) fixture_step(&fixture);
    twin_read_strand(&fixture, 0, q);
    assert_true(fabs(q[1][1] - (-0.1 - 2 * alpha * g)) < fall);
    assert_true(fabs(q[2][1] - (-0.2 - 3 * alpha * g)) < fall);
    fixture_destroy(&fixture);
}

static void bullets_rope_refuses_compliance(void **state)
{
    (void)state;
    Error error;
    Solver solver;
    const Hair hair = {0};
    SectionParams params = {.algo = "rope", .variant = "", .rope_compliance = 1e-6f};
    const SolverSetup setup = {.gpu = fixture_gpu(), .hair = &hair, .params = &params};
    assert_int_equal(solver_create(&solver, &setup, &error), RESULT_USAGE);
    assert_non_null(strstr(error.text, "--variant xpbd"));
}

// Gravity of 1e6 m/s^2, a head that jumps by 1e8 m, and links whose ends coincide.
static void no_violence_gives_a_nan(void **state)
{
    (void)state;
    enum { N = 24 };
    Vec start[N];
    twin_make_curl(start, N, 0, 2);
    for (int xpbd = 0; xpbd < 2; ++xpbd)
        for (int kind = 0; kind < 3; ++kind) {
            HairFixture fixture;
            fixture_create(&fixture, (const Vec *)start, 1, N, "rope", xpbd ? "xpbd" : "", 0, 0);
            if (kind == 0) fixture.step.gravity[1] = 1e6f;
            if (kind == 2) fixture.step.gravity[1] = 0;
            for (int i = 0; i < 60; ++i) {
                fixture.step.head.translation[0] = kind == 1 && i % 2 ? 1e8f : 0;
                if (kind == 2)
                    fixture.step.head.translation[0] = (float)(start[1][0] - start[0][0]) * (i % 2);
                fixture_step(&fixture);
            }
            fixture_require_finite(&fixture);
            fixture_destroy(&fixture);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bullets_rope_equals_its_double_precision_twin),
        cmocka_unit_test(xpbd_equals_its_double_precision_twin),
        cmocka_unit_test(bullets_rope_errs_no_more_than_the_reference_implementation),
        cmocka_unit_test(xpbd_errs_as_the_reference_implementation),
        cmocka_unit_test(compliance_is_stretch_over_acceleration),
        cmocka_unit_test(bullets_rope_refuses_compliance),
        cmocka_unit_test(no_violence_gives_a_nan),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
