// SPDX-License-Identifier: MIT
// Tracks of keys with smooth and linear interpolation.
#include "scene/keyframes.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

typedef struct Sample {
    double time;
    float value;
} Sample;

static Keyframes make_track(const Sample *samples, uint32_t count, Interpolation interpolation)
{
    Keyframes keys = {.interpolation = interpolation};
    Error error;
    for (uint32_t i = 0; i < count; i++)
        assert_int_equal(keyframes_append(&keys, samples[i].time, &samples[i].value, 1, &error),
                         RESULT_OK);
    return keys;
}

static double at(const Keyframes *keys, double time)
{
    float value;
    keyframes_evaluate(keys, time, &value);
    return (double)value;
}

// Uneven times, with a rise, a constant part, a fall and a turning point.
static const Sample SAMPLES[] = {{-1, 2}, {0, 3}, {0.1, 7}, {2, 7}, {3, -1}, {3.5, -0.5f}, {9, 4}};
enum { SAMPLE_COUNT = sizeof SAMPLES / sizeof SAMPLES[0] };

static void both_kinds_pass_through_every_key_and_are_constant_outside(void **state)
{
    (void)state;
    for (int kind = INTERPOLATION_SMOOTH; kind <= INTERPOLATION_LINEAR; kind++) {
        Keyframes keys = make_track(SAMPLES, SAMPLE_COUNT, (Interpolation)kind);
        for (int i = 0; i < SAMPLE_COUNT; i++)
            assert_true(at(&keys, SAMPLES[i].time) == (double)SAMPLES[i].value);
        assert_true(at(&keys, -1e9) == 2 && at(&keys, 1e9) == 4);
        keyframes_destroy(&keys);
        keyframes_destroy(&keys);
    }
}

static void linear_is_halfway_in_the_middle(void **state)
{
    (void)state;
    Keyframes keys = make_track(SAMPLES, SAMPLE_COUNT, INTERPOLATION_LINEAR);
    for (int i = 0; i + 1 < SAMPLE_COUNT; i++) {
        double middle = (SAMPLES[i].time + SAMPLES[i + 1].time) / 2;
        double expected = ((double)SAMPLES[i].value + (double)SAMPLES[i + 1].value) / 2;
        assert_true(fabs(at(&keys, middle) - expected) < 1e-6);
    }
    keyframes_destroy(&keys);
}

static void smooth_never_leaves_the_range_of_its_two_keys(void **state)
{
    (void)state;
    Keyframes keys = make_track(SAMPLES, SAMPLE_COUNT, INTERPOLATION_SMOOTH);
    for (int i = 0; i + 1 < SAMPLE_COUNT; i++) {
        double from = (double)SAMPLES[i].value, to = (double)SAMPLES[i + 1].value, before = from;
        for (int step = 1; step <= 100; step++) {
            double u = step / 100.0;
            double value = at(&keys, SAMPLES[i].time * (1 - u) + SAMPLES[i + 1].time * u);
            assert_true((value - before) * (to >= from ? 1 : -1) >= -1e-6);
            before = value;
        }
        assert_true(fabs(before - to) < 1e-6);
    }
    keyframes_destroy(&keys);
}

// At a key, the slopes on both sides agree. Linear interpolation, whose slope jumps there, shows
// that the test can fail. With h = 1e-3 s and values below 8, rounding to float changes a slope by
// 8 * 2^-24 / 1e-3 < 1e-3, and curvature (at most 6 * 4 / 0.1^2 per s2) by 2.4.
static double slope_jump(Interpolation interpolation)
{
    Keyframes keys = make_track(SAMPLES, SAMPLE_COUNT, interpolation);
    double worst = 0, h = 1e-3;
    for (int i = 0; i < SAMPLE_COUNT; i++) {
        double t = SAMPLES[i].time;
        double left = (at(&keys, t) - at(&keys, t - h)) / h;
        double right = (at(&keys, t + h) - at(&keys, t)) / h;
        worst = fmax(worst, fabs(right - left));
    }
    keyframes_destroy(&keys);
    return worst;
}

static void smooth_has_no_jump_in_velocity_even_at_its_ends(void **state)
{
    (void)state;
    assert_true(slope_jump(INTERPOLATION_SMOOTH) < 2.5);
    assert_true(slope_jump(INTERPOLATION_LINEAR) > 30);
}

// In the middle of an interval, a cubic Hermite curve is h/8 (slope before - slope behind) from the
// mean of its ends. Slopes as in the paper: G = S1 S2 / (a S2 + (1 - a) S1) with a = (1 + h2 / (h1
// + h2)) / 3, where S is the slope between keys and h the length of an interval in seconds.
static void smooth_has_the_slopes_of_fritsch_and_butland(void **state)
{
    (void)state;
    static const double waits[][2] = {{1, 3}, {4, 0.5}, {2, 2}};
    static const double rises[][2] = {{1, 2}, {-3, -0.5}, {2, -1}, {0, 5}};
    for (int w = 0; w < 3; ++w)
        for (int r = 0; r < 4; ++r) {
            double h1 = waits[w][0], h2 = waits[w][1], s1 = rises[r][0], s2 = rises[r][1];
            double a = (1 + h2 / (h1 + h2)) / 3;
            double slope = s1 * s2 > 0 ? s1 * s2 / (a * s2 + (1 - a) * s1) : 0;
            const Sample samples[] = {
                {0, 0}, {h1, (float)(s1 * h1)}, {h1 + h2, (float)(s1 * h1 + s2 * h2)}};
            Keyframes keys = make_track(samples, 3, INTERPOLATION_SMOOTH);
            double before = 0.5 * s1 * h1 - h1 / 8 * slope;
            double after = s1 * h1 + 0.5 * s2 * h2 + h2 / 8 * slope;
            assert_true(fabs(at(&keys, h1 / 2) - before) < 16 * 0x1p-24); // rounding of up to 16
            assert_true(fabs(at(&keys, h1 + h2 / 2) - after) < 16 * 0x1p-24);
            keyframes_destroy(&keys);
        }
}

static void one_key_is_a_constant(void **state)
{
    (void)state;
    const Sample one = {5, 3};
    Keyframes keys = make_track(&one, 1, INTERPOLATION_SMOOTH);
    assert_true(at(&keys, 0) == 3 && at(&keys, 5) == 3 && at(&keys, 6) == 3);
    keyframes_destroy(&keys);
}

static void times_must_be_finite_and_increase(void **state)
{
    (void)state;
    Keyframes keys = {0};
    Error error;
    float value[2] = {1, 2};
    assert_int_equal(keyframes_append(&keys, NAN, value, 2, &error), RESULT_BAD_INPUT);
    assert_int_equal(keyframes_append(&keys, 1, value, 2, &error), RESULT_OK);
    assert_int_equal(keyframes_append(&keys, 1, value, 2, &error), RESULT_BAD_INPUT);
    assert_non_null(strstr(error.text, "got 1 s, expected more than 1 s"));
    assert_int_equal(keyframes_append(&keys, 0.5, value, 2, &error), RESULT_BAD_INPUT);
    assert_int_equal(keyframes_append(&keys, INFINITY, value, 2, &error), RESULT_BAD_INPUT);
    assert_int_equal(keys.count, 1);
    keyframes_destroy(&keys);
}

static void many_keys_are_all_found(void **state)
{
    (void)state;
    Keyframes keys = {.interpolation = INTERPOLATION_LINEAR};
    Error error;
    for (int i = 0; i < 1000; i++) {
        float value[4] = {(float)i, (float)-i, 0, 1};
        assert_int_equal(keyframes_append(&keys, i, value, 4, &error), RESULT_OK);
    }
    for (int i = 0; i < 999; i++) {
        float value[4];
        keyframes_evaluate(&keys, i + 0.5, value);
        assert_true(value[0] == (float)i + 0.5f && value[1] == -value[0] && value[3] == 1);
    }
    keyframes_destroy(&keys);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(both_kinds_pass_through_every_key_and_are_constant_outside),
        cmocka_unit_test(linear_is_halfway_in_the_middle),
        cmocka_unit_test(smooth_never_leaves_the_range_of_its_two_keys),
        cmocka_unit_test(smooth_has_no_jump_in_velocity_even_at_its_ends),
        cmocka_unit_test(smooth_has_the_slopes_of_fritsch_and_butland),
        cmocka_unit_test(one_key_is_a_constant),
        cmocka_unit_test(times_must_be_finite_and_increase),
        cmocka_unit_test(many_keys_are_all_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
