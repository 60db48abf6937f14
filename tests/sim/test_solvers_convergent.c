// SPDX-License-Identifier: MIT
// Invariants of the solvers that converge to the motion of rigid chains. test_solver_<name>.c
// compares each with its double-precision form.
#include "support/reference_motion.h"
#include "support/twin.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

// Bounds of errors relative to the strand's length. First, of a released strand at 120 Hz, and the
// factor by which the error must be smaller at 480 Hz: 16 for a second-order method, less while the
// energy guard is active. Second, of the geometric mean over all scenarios with 1, 2 and 4 steps
// per frame of 1/60 s.
//
// Measured, 60, 120 and 480 Hz: 0.0048, 0.0017 and 0.00015 (hybrid), 0.00014 (emulation), as in
// their double-precision forms. Means: chain 0.018, 0.0098 and 0.0050 as the reference
// implementation; hybrid 0.0189, 0.0080, 0.0036; emulation 0.0190, 0.0081, 0.0035.
//
// ROUNDED: what operations that round like a CPU's add to a mean, at most. A GPU's (H200) added
// 4e-5 to chain's.
static const struct {
    const char *algo;
    double released, ratio, mean[3];
} SOLVERS[] = {
    {"chain", 0.03, 12, {0.02, 0.01, 0.005}},
    {"hybrid", 0.003, 10, {0.02, 0.009, 0.004}},
    {"emulation", 0.003, 10, {0.02, 0.009, 0.004}},
};
static const double ROUNDED = 2e-5;
enum { SOLVER_COUNT = sizeof SOLVERS / sizeof *SOLVERS };

static void require(bool holds, int solver, const char *what, double value)
{
    if (!holds) fail_msg("%s: %s %.3g", SOLVERS[solver].algo, what, value);
}

static void errors_fall_with_the_step(void **state)
{
    (void)state;
    static const char scenario[] = "a_horizontal_n16_c4";
    for (int i = 0; i < SOLVER_COUNT; ++i) {
        const char *algo = SOLVERS[i].algo;
        double at_60 = reference_error(scenario, algo, "", 1, NULL);
        double coarse = reference_error(scenario, algo, "", 2, NULL);
        double fine = reference_error(scenario, algo, "", 8, NULL);
        printf("%s %s: %.3g at 60 Hz, %.3g at 120 Hz, %.3g at 480 Hz\n", algo, scenario, at_60,
               coarse, fine);
        require(coarse < SOLVERS[i].released, i, "error at 120 Hz of", coarse);
        require(coarse / fine > SOLVERS[i].ratio, i, "error falls only by", coarse / fine);
    }
}

static void mean_errors_fall_with_the_step(void **state)
{
    (void)state;
    for (int i = 0; i < SOLVER_COUNT; ++i)
        for (int k = 0; k < 3; ++k) {
            double error = reference_mean_error(SOLVERS[i].algo, "", 1 << k, NULL);
            double most = SOLVERS[i].mean[k] + (fixture_rounding() - 1) * ROUNDED;
            require(error < most, i, "mean error of", error);
        }
}

// Hangs straight down without drag for 10 s, within 1e-5 of the length.
static void hanging_hair_stays_at_rest(void **state)
{
    (void)state;
    enum { N = 16 };
    Vec start[N], q[N];
    for (int j = 0; j < N; ++j) start[j][0] = 0.1, start[j][1] = 0.3 - 0.016 * j, start[j][2] = 0;
    for (int i = 0; i < SOLVER_COUNT; ++i) {
        HairFixture fixture;
        fixture_create(&fixture, (const Vec *)start, 1, N, SOLVERS[i].algo, "", 0, 0);
        for (int step = 0; step < 600; ++step) fixture_step(&fixture);
        twin_read_strand(&fixture, 0, q);
        double off = twin_rms((const Vec *)q, (const Vec *)start, N, 0.24);
        require(off < 1e-5, i, "hanging hair has moved by", off);
        fixture_destroy(&fixture);
    }
}

static double length_error_after_jump(const char *algo, int n)
{
    Vec start[64], q[64];
    TwinStrand rest;
    HairFixture fixture;
    twin_make_curl(start, n, 0, 3);
    twin_start(&rest, n, (const Vec *)start);
    fixture_create(&fixture, (const Vec *)start, 1, n, algo, "", 0.5f, 0);
    for (int i = 0; i < 200; ++i) {
        fixture.step.head.translation[1] = i == 100 ? 200 : 0;
        fixture_step(&fixture);
    }
    twin_read_strand(&fixture, 0, q);
    fixture_destroy(&fixture);
    return twin_length_error(&rest, (const Vec *)q);
}

// The head jumps by 1000 lengths and back. Chain's solve fails, and tractrices replace it in that
// step.
static void lengths_survive_a_jump(void **state)
{
    (void)state;
    for (int i = 0; i < SOLVER_COUNT; ++i)
        for (int n = 8; n <= 64; n *= 8) {
            double off = length_error_after_jump(SOLVERS[i].algo, n);
            require(off < 1e-5, i, "a segment's length is off by", off);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_fall_with_the_step),
        cmocka_unit_test(mean_errors_fall_with_the_step),
        cmocka_unit_test(hanging_hair_stays_at_rest),
        cmocka_unit_test(lengths_survive_a_jump),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
