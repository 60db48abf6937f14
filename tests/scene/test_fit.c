// SPDX-License-Identifier: MIT
// The fitting camera: in its view, points reach the margin and never cross it.
#include "scene/camera.h"
#include "scene/fit.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cglm/cglm.h>
#include <cmocka.h>

enum { POINTS = 300, FRAMES = 90 };

typedef struct Shot {
    Scene scene;
    Framing framing;
    float sway; // m, motion of the points over the sequence
} Shot;

// An irregular cloud far from the origin with a spike, so that neither a box nor a ball
// approximates it well.
static void point_at(const Shot *shot, int frame, int i, float point[3])
{
    float a = 2.4f * (float)i, h = (float)i / POINTS, r = 0.1f + 0.3f * h * h;
    point[0] = 1 + r * cosf(a) + 0.2f * h + shot->sway * sinf(0.2f * (float)frame) * h;
    point[1] = 2 + 0.8f * h;
    point[2] = -3 + 0.4f * r * sinf(a) + (i == POINTS - 1 ? 0.5f : 0);
}

static void points_of(const Shot *shot, int frame, float points[POINTS][3])
{
    for (int i = 0; i < POINTS; ++i) point_at(shot, frame, i, points[i]);
}

static void open_shot(Shot *shot)
{
    Error error;
    memset(shot, 0, sizeof *shot);
    assert_int_equal(params_create_run(&shot->scene.run, &error), RESULT_OK);
    shot->scene.run.frames = FRAMES;
    shot->scene.run.turntable = 360;
    // As outline_frame leaves it, but with the eye far too near.
    for (int i = 0; i < POINTS; ++i) {
        float point[3];
        point_at(shot, 0, i, point);
        outline_add(&shot->framing.all, (const float(*)[3]) & point, 1);
    }
    for (int k = 0; k < 3; ++k)
        shot->framing.target[k] = 0.5f * (shot->framing.all.low[k] + shot->framing.all.high[k]);
    const float arm[3] = {0.1f, 0.05f, 0.2f};
    for (int k = 0; k < 3; ++k) shot->framing.eye[k] = shot->framing.target[k] + arm[k];
}

static void close_shot(Shot *shot)
{
    params_destroy_run(&shot->scene.run);
    track_destroy(&shot->scene.fov);
}

static void fit(Shot *shot, float radius)
{
    Fit fit;
    Error error;
    float points[POINTS][3];
    assert_int_equal(fit_create(&fit, &shot->scene, &shot->framing, &error), RESULT_OK);
    for (int frame = 0; frame < shot->scene.run.frames; ++frame) {
        points_of(shot, frame, points);
        fit_add(&fit, frame, (const float(*)[3])points, POINTS, radius);
    }
    fit_solve(&fit, &shot->scene, &shot->framing);
    fit_destroy(&fit);
}

// The largest |x| and |y| of points with this radius in all frames; 1 is the edge of the image.
static void find_extent(const Shot *shot, float radius, float most[2])
{
    most[0] = most[1] = 0;
    for (int frame = 0; frame < FRAMES; ++frame) {
        float points[POINTS][3];
        View view;
        points_of(shot, frame, points);
        camera_view(&view, &shot->scene, &shot->framing, frame);
        for (int i = 0; i < POINTS; ++i) {
            vec3 seen;
            glm_mat4_mulv3(view.view, points[i], 1, seen);
            assert_true(seen[2] < 0);
            for (int k = 0; k < 2; ++k)
                most[k] =
                    fmaxf(most[k], (fabsf(seen[k]) + radius) * view.projection[k][k] / -seen[2]);
        }
    }
}

// Floats of this size are accurate to 1e-6 of the distance.
static void check_margin(Shot *shot, float radius)
{
    float most[2], edge = 1 / (1 + shot->scene.run.margin);
    fit(shot, radius);
    find_extent(shot, radius, most);
    assert_true(fmaxf(most[0], most[1]) <= edge + 1e-5f);
    assert_true(fmaxf(most[0], most[1]) >= edge - 1e-5f);
}

static void points_touch_the_margin_and_never_cross_it(void **state)
{
    (void)state;
    const float turns[] = {0, 45, 360, -720};
    for (int i = 0; i < 4; ++i)
        for (int wide = 0; wide < 2; ++wide) {
            Shot shot;
            open_shot(&shot);
            shot.scene.run.turntable = turns[i];
            shot.scene.run.ease_in = 0.3f;
            shot.scene.run.margin = wide ? 0 : 0.06f;
            shot.scene.run.size[0] = wide ? 1000 : 300;
            shot.scene.run.size[1] = 400;
            shot.sway = 0.5f;
            check_margin(&shot, 0);
            close_shot(&shot);
        }
}

static void the_points_radius_and_a_zoom_are_counted_in(void **state)
{
    (void)state;
    Error error;
    Shot shot;
    open_shot(&shot);
    check_margin(&shot, 0.05f);
    keyframes_append(&shot.scene.fov.keys, 0, (float[1]){50}, 1, &error);
    keyframes_append(&shot.scene.fov.keys, 1, (float[1]){20}, 1, &error);
    check_margin(&shot, 0.05f);
    track_destroy(&shot.scene.fov);
    assert_int_equal(
        track_set_formula(&shot.scene.fov, 0, "t < 0.1 ? 50 : 20", &(TrackRange){1, 170, 1}, NULL),
        RESULT_OK);
    check_margin(&shot, 0.05f);
    close_shot(&shot);
}

static float distance_of(const Shot *shot)
{
    return glm_vec3_distance((float *)shot->framing.eye, (float *)shot->framing.target);
}

// Tests that no target 1.5 to 20 mm away brings the camera closer: vertically, and horizontally if
// only the sides limit the distance, which is the case in a narrow frame seen from the height of
// the target. The target is accurate to 1e-5 of the search's range, 4 m here, and the distance
// changes by at most 40 times as much (scale / slope).
static void on_whole_turns_no_other_target_brings_the_camera_closer(void **state)
{
    (void)state;
    static const float steps[] = {0.02f, 0.005f, 0.0015f};
    for (int i = 0; i < 18; ++i) {
        Shot shot;
        int axis = i % 6 / 2;
        open_shot(&shot);
        if (axis != 1) {
            shot.scene.run.size[0] = 100, shot.scene.run.size[1] = 1000;
            shot.framing.eye[1] = shot.framing.target[1];
        }
        fit(&shot, 0);
        Shot other = shot;
        other.scene.run.target.automatic = false;
        for (int k = 0; k < 3; ++k) {
            float by = k == axis ? (i % 2 ? steps[i / 6] : -steps[i / 6]) : 0;
            other.scene.run.target.value[k] = other.framing.target[k] += by;
            other.framing.eye[k] += by;
        }
        fit(&other, 0);
        assert_true(distance_of(&other) > distance_of(&shot) - 2e-3f);
        assert_memory_equal(other.framing.target, other.scene.run.target.value, sizeof(vec3));
        close_shot(&shot);
    }
}

// One frame of a turntable, or several from the same side, look as they would without a turntable.
static void a_single_view_of_a_turn_keeps_its_distance(void **state)
{
    (void)state;
    for (int frames = 1; frames <= 2; ++frames) {
        Shot turn, still;
        open_shot(&turn);
        open_shot(&still);
        turn.scene.run.frames = still.scene.run.frames = frames;
        turn.scene.run.turntable = 360 * (float)frames;
        still.scene.run.turntable = 0;
        fit(&turn, 0);
        fit(&still, 0);
        for (int k = 0; k < 3; ++k) {
            assert_true(fabsf(turn.framing.eye[k] - still.framing.eye[k]) < 1e-4f);
            assert_true(fabsf(turn.framing.target[k] - still.framing.target[k]) < 1e-4f);
        }
        close_shot(&turn);
        close_shot(&still);
    }
}

static void without_points_nothing_changes(void **state)
{
    (void)state;
    Shot shot;
    Fit fit;
    Error error;
    open_shot(&shot);
    Framing before = shot.framing;
    assert_int_equal(fit_create(&fit, &shot.scene, &shot.framing, &error), RESULT_OK);
    fit_add(&fit, 3, NULL, 0, 0.1f);
    fit_solve(&fit, &shot.scene, &shot.framing);
    assert_memory_equal(&before, &shot.framing, sizeof before);
    fit_destroy(&fit);
    close_shot(&shot);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_touch_the_margin_and_never_cross_it),
        cmocka_unit_test(the_points_radius_and_a_zoom_are_counted_in),
        cmocka_unit_test(on_whole_turns_no_other_target_brings_the_camera_closer),
        cmocka_unit_test(a_single_view_of_a_turn_keeps_its_distance),
        cmocka_unit_test(without_points_nothing_changes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
