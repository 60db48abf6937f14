// SPDX-License-Identifier: MIT
// The reader of exact motions, the error of hair against them, and the documented errors of
// convergent solvers.
#include "bench/table.h"
#include "support/reference_motion.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static double released(const char *algo, int steps_per_frame)
{
    return reference_error("a_horizontal_n16_c4", algo, "", steps_per_frame, NULL);
}

static void chain_is_of_second_order(void **state)
{
    (void)state;
    double coarse = released("chain", 2), fine = released("chain", 8);
    assert_true(coarse < 0.005);
    assert_true(coarse / fine > 10); // 16 in theory; less where few frames are compared
}

static void hybrid_and_emulation_are_of_second_order_too(void **state)
{
    (void)state;
    for (int i = 0; i < 2; ++i) {
        const char *algo = i ? "emulation" : "hybrid";
        double coarse = released(algo, 2), fine = released(algo, 8);
        assert_true(coarse < 0.002);     // measured: 0.00175 and 0.00171
        assert_true(coarse / fine > 10); // 16 in theory; 11 as long as the energy guard acts
    }
}

static void the_order_is_the_slope_of_a_line(void **state)
{
    (void)state;
    const double rates[] = {30, 60, 120}, errors[] = {0.16, 0.04, 0.01};
    double spread;
    assert_true(fabs(table_slope(rates, errors, 3, &spread) + 2) < 1e-12);
    assert_true(spread < 1e-6); // the root of the rounding error
    assert_true(table_slope(rates, errors, 1, &spread) == 0);
    assert_true(isnan(spread));
    // Off a line by 1 at one end of three points a unit apart: the residuals' standard deviation is
    // 1/sqrt(6), over the spread of x, sqrt(2).
    const double units[] = {1, exp(1), exp(2)};
    assert_true(fabs(table_slope(units, (const double[]){exp(1), 1, 1}, 3, &spread) + 0.5) < 1e-12);
    assert_true(fabs(spread - sqrt(1.0 / 6 / 2)) < 1e-12);
}

// The error of hair that does not move equals the distance that the exact strand has moved.
static void hair_that_stays_is_as_far_off_as_the_motion_goes(void **state)
{
    (void)state;
    Error error;
    Motion motion;
    double sum = 0, counted = 0;
    assert_int_equal(trial_read_motion(&motion, "tests/data/motion", "c_root2Hz_n16_c4", &error),
                     0);
    assert_int_equal(motion.n, 16);
    assert_true(fabs(trial_root(&motion, 0.25) - 0.04) < 1e-12);
    for (size_t f = 1; f < motion.frame_count; ++f)
        for (int j = 1; motion.frames[f].followed && j < motion.n; ++j, counted += 1.0 / 15)
            for (int k = 0; k < 3; ++k) {
                double root = k == 0 ? trial_root(&motion, motion.frames[f].time) : 0;
                double r = motion.frames[f].points[j][k] - motion.frames[0].points[j][k] - root;
                sum += r * r / 15;
            }
    double still = reference_error("c_root2Hz_n16_c4", "none", "", 1, NULL);
    assert_true(fabs(still / (sqrt(sum / counted) / motion.length) - 1) < 1e-5);
    trial_destroy_motion(&motion);
}

static void bad_motions_are_refused(void **state)
{
    (void)state;
    Error error;
    Motion motion;
    MotionFolder folder;
    assert_int_equal(trial_read_motion(&motion, "tests/data", "scene_full", &error),
                     RESULT_BAD_INPUT);
    assert_non_null(strstr(error.text, "scene_full.json: n: "));
    assert_int_equal(trial_read_motion(&motion, "tests/data", "nothing", &error), RESULT_BAD_INPUT);
    assert_int_equal(trial_read_folder(&folder, "tests/golden", &error), RESULT_BAD_INPUT);
    trial_destroy_folder(&folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(chain_is_of_second_order),
        cmocka_unit_test(hybrid_and_emulation_are_of_second_order_too),
        cmocka_unit_test(the_order_is_the_slope_of_a_line),
        cmocka_unit_test(hair_that_stays_is_as_far_off_as_the_motion_goes),
        cmocka_unit_test(bad_motions_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
