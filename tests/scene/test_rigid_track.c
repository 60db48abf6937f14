// SPDX-License-Identifier: MIT
// Motion of the head by keys, formulas and samples.
#include "scene/rigid_track.h"
#include "support/head_formulas.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const float PI = 3.14159265f;

// Moves `point` by the track's motion, by means of the quaternion's matrix.
static void move(const RigidTrack *track, double time, const float point[3], float moved[3])
{
    float q[4], t[3];
    rigid_track_evaluate(track, time, q, t);
    assert_true(fabsf(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1) < 1e-6f);
    float x = q[0], y = q[1], z = q[2], w = q[3];
    const float matrix[3][3] = {
        {1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
        {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
        {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)},
    };
    for (int i = 0; i < 3; i++)
        moved[i] =
            matrix[i][0] * point[0] + matrix[i][1] * point[1] + matrix[i][2] * point[2] + t[i];
}

static void assert_at(const float moved[3], float x, float y, float z)
{
    assert_true(fabsf(moved[0] - x) < 1e-5f && fabsf(moved[1] - y) < 1e-5f &&
                fabsf(moved[2] - z) < 1e-5f);
}

static void turn_to(RigidTrack *track, double time, float x, float y, float z)
{
    Error error;
    const float vector[3] = {x, y, z};
    assert_int_equal(keyframes_append(&track->rotation.keys, time, vector, 3, &error), RESULT_OK);
}

static void a_track_without_keys_moves_nothing(void **state)
{
    (void)state;
    RigidTrack track = {.pivot = {1, 2, 3}};
    float q[4], t[3];
    rigid_track_evaluate(&track, 7, q, t);
    const float identity[4] = {0, 0, 0, 1}, zero[3] = {0, 0, 0};
    assert_memory_equal(q, identity, sizeof q);
    assert_memory_equal(t, zero, sizeof t);
    rigid_track_destroy(&track);
}

static void a_turn_is_right_handed_and_leaves_its_pivot_in_place(void **state)
{
    (void)state;
    RigidTrack track = {.pivot = {0, 1, 0}, .rotation.keys.interpolation = INTERPOLATION_LINEAR};
    turn_to(&track, 0, 0, 0, 0);
    turn_to(&track, 1, 0, 0, PI / 2);
    float moved[3];
    move(&track, 1, (const float[3]){0, 1, 0}, moved);
    assert_at(moved, 0, 1, 0);
    move(&track, 1, (const float[3]){2, 1, 0}, moved);
    assert_at(moved, 0, 3, 0);
    move(&track, 0.5, (const float[3]){1, 1, 5}, moved);
    assert_at(moved, sqrtf(0.5f), 1 + sqrtf(0.5f), 5);
    rigid_track_destroy(&track);
}

static void translation_comes_after_the_turn(void **state)
{
    (void)state;
    RigidTrack track = {0};
    Error error;
    const float shift[3] = {10, 0, 0};
    turn_to(&track, 0, 0, PI, 0);
    assert_int_equal(keyframes_append(&track.translation.keys, 0, shift, 3, &error), RESULT_OK);
    float moved[3];
    move(&track, 0, (const float[3]){1, 2, 3}, moved);
    assert_at(moved, 9, 2, -3);
    rigid_track_destroy(&track);
}

static void turns_of_more_than_half_a_circle_are_made_as_written(void **state)
{
    (void)state;
    RigidTrack track = {.rotation.keys.interpolation = INTERPOLATION_LINEAR};
    turn_to(&track, 0, 0, 0, 0);
    turn_to(&track, 2, 0, 0, 4 * PI);
    float moved[3];
    move(&track, 0.25, (const float[3]){1, 0, 0}, moved);
    assert_at(moved, 0, 1, 0);
    move(&track, 0.75, (const float[3]){1, 0, 0}, moved);
    assert_at(moved, 0, -1, 0);
    move(&track, 2, (const float[3]){1, 0, 0}, moved);
    assert_at(moved, 1, 0, 0);
    rigid_track_destroy(&track);
}

// A single key is constant; two keys of the rotation alone are a motion.
static void only_two_keys_of_either_kind_move(void **state)
{
    (void)state;
    for (int turns = 0; turns < 2; ++turns) {
        RigidTrack track = {0};
        Keyframes *keys = turns ? &track.rotation.keys : &track.translation.keys;
        assert_true(rigid_track_is_still(&track));
        assert_int_equal(keyframes_append(keys, 0, (const float[]){0, 0, 0}, 3, NULL), RESULT_OK);
        assert_true(rigid_track_is_still(&track));
        assert_int_equal(keyframes_append(keys, 1, (const float[]){0, 1, 0}, 3, NULL), RESULT_OK);
        assert_false(rigid_track_is_still(&track));
        rigid_track_destroy(&track);
    }
}

static void formulas_move_in_metres_and_turn_in_degrees(void **state)
{
    (void)state;
    RigidTrack track = {0};
    head_set_translation(&track, "0.5*t", "sin(pi*t/2)", "-1");
    head_set_rotation(&track, "0", "0", "t<1 ? 0 : 90*smoothstep(1, 2, t)");
    assert_false(rigid_track_is_still(&track));
    float moved[3];
    move(&track, 1, (const float[3]){1, 0, 0}, moved);
    assert_at(moved, 1.5f, 1, -1);
    move(&track, 3, (const float[3]){1, 0, 0}, moved);
    assert_at(moved, 1.5f, 0, -1);
    rigid_track_destroy(&track);
}

// A body that flies and turns by samples, while its track turns and moves it: the samples' motion
// comes first.
static void samples_come_before_the_keys(void **state)
{
    (void)state;
    const double half = sqrt(0.5);
    RigidMotion motions[] = {{{0, 0, 0, 1}, {0, 0, 0}}, {{0, 0, half, half}, {1, 0, 0}}};
    const RigidSamples samples = {.times = {.count = 2, .rate = 1}, .motion = motions};
    RigidTrack track = {.samples = &samples};
    assert_false(rigid_track_is_still(&track));
    float moved[3];
    move(&track, 0, (const float[3]){1, 2, 3}, moved);
    assert_at(moved, 1, 2, 3);
    for (int time = 1; time < 5; time += 3) { // the last sample applies afterwards, too
        move(&track, time, (const float[3]){1, 2, 3}, moved);
        assert_at(moved, -1, 1, 3);
    }
    Error error;
    const float shift[3] = {10, 0, 0};
    turn_to(&track, 0, 0, PI, 0);
    assert_int_equal(keyframes_append(&track.translation.keys, 0, shift, 3, &error), RESULT_OK);
    move(&track, 1, (const float[3]){1, 2, 3}, moved); // -1, 1, 3 turned about y and shifted
    assert_at(moved, 11, 1, -3);
    rigid_track_destroy(&track);
}

static void a_formula_that_fails_somewhere_is_reported_and_cut(void **state)
{
    (void)state;
    RigidTrack track = {0};
    Error error;
    head_set_translation(&track, "1/(t-1)", "sqrt(2-t)", "0");
    assert_int_equal(rigid_track_check(&track, 0.5, &error), RESULT_OK);
    assert_int_equal(rigid_track_check(&track, 1, &error), RESULT_BAD_INPUT);
    assert_non_null(strstr(error.text, "translate[0]: '1/(t-1)' is inf at t = 1, expected"));
    assert_int_equal(rigid_track_check(&track, 3, &error), RESULT_BAD_INPUT);
    assert_non_null(strstr(error.text, "translate[1]"));
    float q[4], t[3];
    rigid_track_evaluate(&track, 1, q, t);
    assert_true(t[0] == 1e6f);
    rigid_track_evaluate(&track, 3, q, t);
    assert_true(t[1] == 0);
    rigid_track_destroy(&track);
}

static void what_is_no_formula_of_t_is_refused(void **state)
{
    (void)state;
    static const char *const TEXTS[] = {"",    "sin(", "x",     "2 3",   "1,2",    "t=3",
                                        "a=1", "t++",  "\"a\"", "min()", "sin(t)@"};
    for (size_t i = 0; i < sizeof TEXTS / sizeof TEXTS[0]; i++) {
        Formula formula;
        Error error = {{0}};
        if (formula_create(&formula, TEXTS[i], &error) != RESULT_BAD_INPUT ||
            !strstr(error.text, "expected a formula of t") || formula.text)
            fail_msg("'%s': %s", TEXTS[i], error.text);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_track_without_keys_moves_nothing),
        cmocka_unit_test(a_turn_is_right_handed_and_leaves_its_pivot_in_place),
        cmocka_unit_test(translation_comes_after_the_turn),
        cmocka_unit_test(turns_of_more_than_half_a_circle_are_made_as_written),
        cmocka_unit_test(only_two_keys_of_either_kind_move),
        cmocka_unit_test(formulas_move_in_metres_and_turn_in_degrees),
        cmocka_unit_test(samples_come_before_the_keys),
        cmocka_unit_test(a_formula_that_fails_somewhere_is_reported_and_cut),
        cmocka_unit_test(what_is_no_formula_of_t_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
