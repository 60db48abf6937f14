// SPDX-License-Identifier: MIT
// Gravity and wind over time.
#include "scene/forces.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static void make_scene(Scene *scene, float x, float y, float z)
{
    assert_int_equal(scene_create(scene, NULL), RESULT_OK);
    scene->run.wind[0] = x, scene->run.wind[1] = y, scene->run.wind[2] = z;
}

static void without_wind_there_is_gravity_alone(void **state)
{
    (void)state;
    Scene scene;
    Forces forces;
    make_scene(&scene, 0, 0, 0);
    forces_evaluate(&forces, &scene, 1.5);
    assert_true(forces.gravity[1] == -9.81f && forces.gravity[0] == 0 && forces.gravity[2] == 0);
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 3; ++k) assert_true(forces.wind[i][k] == 0);
    assert_true(forces_are_constant(&scene));
    scene_destroy(&scene);
}

static void four_winds_turn_by_the_spread_and_keep_the_mean(void **state)
{
    (void)state;
    Scene scene;
    Forces forces;
    make_scene(&scene, 3, 1, -2);
    scene.run.gust = 0;
    forces_evaluate(&forces, &scene, 7);
    const double length = sqrt(14),
                 expected = cos((double)scene.run.wind_spread * 3.14159265358979 / 180);
    for (int k = 0; k < 3; ++k) {
        double mean = 0;
        for (int i = 0; i < 4; ++i) mean += (double)forces.wind[i][k] / 4;
        assert_true(fabs(mean - (double)scene.run.wind[k]) < 1e-6);
    }
    for (int i = 0; i < 4; ++i) {
        const float *w = forces.wind[i];
        double size = sqrt((double)(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]));
        assert_true(fabs((3 * (double)w[0] + (double)w[1] - 2 * (double)w[2]) / (length * size) -
                         expected) < 1e-6);
    }
    scene_destroy(&scene);
}

// With any period of repetition: gusts are adapted to it by at most half a wave per period.
static void gusts_repeat_if_told(void **state)
{
    (void)state;
    Scene scene;
    make_scene(&scene, 3, 0, 0);
    scene.run.gust_repeat = 4;
    const float periods[] = {0.3f, 1.7f, 2, 100};
    for (int p = 0; p < 4; ++p) {
        float most = 0;
        scene.run.gust_period = periods[p];
        for (double time = -1; time < 3; time += 0.13) {
            Forces now, later, middle;
            forces_evaluate(&now, &scene, time);
            forces_evaluate(&later, &scene, time + 4);
            forces_evaluate(&middle, &scene, time + 1.9);
            assert_true(fabsf(now.wind[0][0] - later.wind[0][0]) < 1e-5f);
            most = fmaxf(most, fabsf(now.wind[0][0] - middle.wind[0][0]));
        }
        assert_true(most > 0.3f);
    }
    scene_destroy(&scene);
}

// Each of the three sines gets the nearest whole number of waves in that time: 3.64, 8.4 and 18.8
// waves become 4, 8 and 19.
static void gusts_that_repeat_keep_nearly_their_rates(void **state)
{
    (void)state;
    const double turn = 2 * 3.14159265358979;
    Scene scene;
    make_scene(&scene, 2, 0, 0);
    scene.run.gust = 0.5f;
    scene.run.gust_repeat = 4;
    scene.run.gust_period = 1.1f;
    for (double time = 0; time < 4; time += 0.17) {
        Forces forces;
        forces_evaluate(&forces, &scene, time);
        double gust = 0.5 * sin(turn * time) + 0.3 * sin(turn * 2 * time + 1.3) +
                      0.2 * sin(turn * 4.75 * time + 2.1),
               mean = 0;
        for (int i = 0; i < 4; ++i) mean += (double)forces.wind[i][0] / 4;
        assert_true(fabs(mean - 2 * (1 + 0.5 * gust)) < 1e-5);
    }
    scene_destroy(&scene);
}

static double spread_of(float asked_deg)
{
    Scene scene;
    Forces forces;
    make_scene(&scene, 2, 0, 0);
    scene.run.gust = 0;
    scene.run.wind_spread = asked_deg;
    forces_evaluate(&forces, &scene, 0);
    scene_destroy(&scene);
    const float *w = forces.wind[0];
    return atan2(hypot((double)w[1], (double)w[2]), (double)w[0]) * 180 / 3.14159265358979;
}

// A right angle would require infinite wind.
static void the_spread_ends_just_before_a_right_angle(void **state)
{
    (void)state;
    assert_true(fabs(spread_of(85) - 85) < 1e-3);
    assert_true(fabs(spread_of(90) - 89) < 1e-3);
}

static void gusts_stay_within_their_share_and_vary(void **state)
{
    (void)state;
    Scene scene;
    Forces forces;
    double low = 10, high = 0;
    make_scene(&scene, 2, 0, 0);
    scene.run.gust = 0.4f;
    assert_false(forces_are_constant(&scene));
    for (int i = 0; i < 4000; ++i) {
        forces_evaluate(&forces, &scene, 0.01 * i);
        double mean = 0;
        for (int k = 0; k < 4; ++k) mean += (double)forces.wind[k][0] / 4;
        low = fmin(low, mean), high = fmax(high, mean);
    }
    assert_true(low >= 2 * 0.6 - 1e-6 && high <= 2 * 1.4 + 1e-6);
    assert_true(low < 2 * 0.8 && high > 2 * 1.2);
    scene_destroy(&scene);
}

// Wind that is the same everywhere and has no gusts.
static void make_even_wind(Scene *scene)
{
    make_scene(scene, 9, 9, 9);
    scene->run.gust = 0;
    scene->run.wind_spread = 0;
}

static void keyframes_win_over_constants(void **state)
{
    (void)state;
    Scene scene;
    Forces forces;
    make_even_wind(&scene);
    scene.wind.keys.interpolation = INTERPOLATION_LINEAR;
    assert_int_equal(keyframes_append(&scene.wind.keys, 0, (const float[]){0, 0, 0}, 3, NULL),
                     RESULT_OK);
    assert_int_equal(keyframes_append(&scene.wind.keys, 2, (const float[]){4, 0, 0}, 3, NULL),
                     RESULT_OK);
    assert_int_equal(keyframes_append(&scene.gravity.keys, 0, (const float[]){0, 0, -3}, 3, NULL),
                     RESULT_OK);
    forces_evaluate(&forces, &scene, 1);
    assert_true(fabsf(forces.wind[2][0] - 2) < 1e-6f && fabsf(forces.wind[2][1]) < 1e-6f);
    assert_true(forces.gravity[2] == -3 && forces.gravity[1] == 0);
    scene_destroy(&scene);
}

static void formulas_blow_with_the_time(void **state)
{
    (void)state;
    Scene scene;
    Forces forces;
    make_even_wind(&scene);
    assert_true(forces_are_constant(&scene));
    const char *const texts[] = {"2*t", "0", "-1"};
    for (uint32_t i = 0; i < 3; ++i)
        assert_int_equal(
            track_set_formula(&scene.wind, i, texts[i], &(TrackRange){-100, 100, 1}, NULL),
            RESULT_OK);
    assert_false(forces_are_constant(&scene));
    forces_evaluate(&forces, &scene, 3);
    assert_true(fabsf(forces.wind[2][0] - 6) < 1e-5f && fabsf(forces.wind[2][2] + 1) < 1e-6f);
    scene_destroy(&scene);
}

// Only times from 0 are checked for formulas that have no value, and only they count for
// --substeps auto.
static void before_time_0_formulas_and_keys_stand_still(void **state)
{
    (void)state;
    Scene scene;
    Forces start, before;
    make_scene(&scene, 9, 9, 9);
    scene.run.gust = 0;
    for (uint32_t i = 0; i < 3; ++i)
        assert_int_equal(track_set_formula(&scene.wind, i, i == 0 ? "exp(-t)" : "2 + sqrt(t)",
                                           &(TrackRange){-1e6, 1e6, 1}, NULL),
                         RESULT_OK);
    for (int time = -4; time <= 0; time += 2)
        assert_int_equal(keyframes_append(&scene.gravity.keys, time,
                                          (const float[]){0, (float)time - 5, 0}, 3, NULL),
                         RESULT_OK);
    forces_evaluate(&start, &scene, 0);
    forces_evaluate(&before, &scene, -3);
    assert_true(start.gravity[1] == -5);
    assert_memory_equal(&before, &start, sizeof start);
    scene.run.gust = 0.5f; // gusts go on
    forces_evaluate(&start, &scene, 0);
    forces_evaluate(&before, &scene, -3);
    assert_memory_equal(before.gravity, start.gravity, sizeof start.gravity);
    assert_true(fabsf(before.wind[0][0] - start.wind[0][0]) > 1e-3f);
    scene_destroy(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_wind_there_is_gravity_alone),
        cmocka_unit_test(four_winds_turn_by_the_spread_and_keep_the_mean),
        cmocka_unit_test(gusts_repeat_if_told),
        cmocka_unit_test(gusts_that_repeat_keep_nearly_their_rates),
        cmocka_unit_test(the_spread_ends_just_before_a_right_angle),
        cmocka_unit_test(gusts_stay_within_their_share_and_vary),
        cmocka_unit_test(keyframes_win_over_constants),
        cmocka_unit_test(formulas_blow_with_the_time),
        cmocka_unit_test(before_time_0_formulas_and_keys_stand_still),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
