// SPDX-License-Identifier: MIT
// Automatic cameras: hair stays in the frame whatever moves, and fills the frame.
#include "scene/camera.h"
#include "strands/paint.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cglm/cglm.h>
#include <cmocka.h>

enum { STRANDS = 40, VERTICES = 6 };

// A tuft of strands of 0.3 m on a ball of 0.1 m, scaled.
static Strands make_tuft(float scale)
{
    Error error;
    Strands strands;
    assert_int_equal(strands_create(&strands, STRANDS, STRANDS * VERTICES, &error), RESULT_OK);
    for (uint32_t s = 0; s < STRANDS; ++s) {
        strands.first[s + 1] = (s + 1) * VERTICES;
        float angle = 2.4f * (float)s, y = 1 - (float)s / STRANDS, r = sqrtf(1 - y * y);
        for (uint32_t j = 0; j < VERTICES; ++j) {
            float out = scale * (0.1f + 0.06f * (float)j);
            float *x = strands.position[s * VERTICES + j];
            x[0] = out * r * cosf(angle), x[1] = out * y, x[2] = out * r * sinf(angle);
        }
    }
    return strands;
}

typedef struct Shot {
    Scene scene;
    Section section;
    Strands strands;
    Framing framing;
} Shot;

static void open_shot(Shot *shot, float scale)
{
    Error error;
    memset(shot, 0, sizeof *shot);
    assert_int_equal(params_create_run(&shot->scene.run, &error), RESULT_OK);
    assert_int_equal(params_create_section(&shot->section.params, &error), RESULT_OK);
    shot->scene.sections = &shot->section;
    shot->scene.section_count = shot->scene.body_count = 1;
    shot->scene.bodies[0].section_count = 1;
    shot->strands = make_tuft(scale);
}

static void close_shot(Shot *shot)
{
    params_destroy_run(&shot->scene.run);
    params_destroy_section(&shot->section.params);
    rigid_track_destroy(&shot->scene.bodies[0].head);
    track_destroy(&shot->scene.eye);
    track_destroy(&shot->scene.target);
    track_destroy(&shot->scene.fov);
    strands_destroy(&shot->strands);
}

static void frame_shot(Shot *shot)
{
    outline_frame(&shot->framing, &shot->scene, &shot->strands, NULL);
}

static void view_of(Shot *shot, int frame, View *view)
{
    camera_view(view, &shot->scene, &shot->framing, frame);
}

// The largest |x/w| or |y/w| of strands moved by `translation`; all must lie between the near and
// far planes.
static float extent_in_frame(const Shot *shot, const View *view, const float translation[3])
{
    float most = 0;
    mat4 from_world;
    glm_mat4_mul((vec4 *)view->projection, (vec4 *)view->view, from_world);
    for (uint32_t v = 0; v < shot->strands.vertex_count; ++v) {
        vec4 x = {0, 0, 0, 1}, clip;
        for (int k = 0; k < 3; ++k) x[k] = shot->strands.position[v][k] + translation[k];
        glm_mat4_mulv(from_world, x, clip);
        assert_true(clip[3] > 0 && fabsf(clip[2]) < clip[3]);
        most = fmaxf(most, fmaxf(fabsf(clip[0]), fabsf(clip[1])) / clip[3]);
    }
    return most;
}

static const float STILL[3] = {0, 0, 0};

// Puts all hair on a horizontal line. Seen 45 degrees from the camera's right, it is a point, and
// from 45 degrees to the left it has its full width (`side` 1), or the other way round (-1).
static void lay_aslant(Shot *shot, float side)
{
    Strands *strands = &shot->strands;
    frame_shot(shot);
    float to[2];
    for (int k = 0; k < 2; ++k) to[k] = shot->framing.eye[2 * k] - shot->framing.target[2 * k];
    float angle = atan2f(to[0], to[1]) + side * 0.785398f;
    for (uint32_t v = 0; v < strands->vertex_count; ++v) {
        float along = 0.4f * ((float)v / (float)(strands->vertex_count - 1) - 0.5f);
        const float at[3] = {along * sinf(angle), 0, along * cosf(angle)};
        memcpy(strands->position[v], at, sizeof at);
    }
}

// Motion within 120 frames of 2 s; the rest is 0.
typedef struct Motion {
    const char *name;
    float turntable, aslant;
    float head_from, head_to[3]; // position at 2 s; it is at 0 until `head_from` (s)
    float fov[3];                // at 0, 1 and 2 s (deg)
} Motion;

static const Motion MOTIONS[] = {
    {.name = "still"},
    {.name = "turntable", .turntable = 360},
    {.name = "moving head", .head_to = {0.5f, 0.2f, -0.3f}},
    {.name = "head that moves at the end", .head_from = 1.9f, .head_to = {0.9f, 0, 0}},
    {.name = "zoom out", .fov = {10, 20, 40}},
    {.name = "zoom in", .fov = {40, 20, 10}},
    {.name = "zoom in and out", .fov = {40, 10, 20}},
    {.name = "a quarter to the left", .turntable = 90, .aslant = -1, .fov = {10, 10, 10}},
    {.name = "a quarter to the right", .turntable = -90, .aslant = 1, .fov = {10, 10, 10}},
    {.name = "a quarter past a point", .turntable = 90, .aslant = 1, .fov = {10, 10, 10}},
    {.name = "a quarter past a point, right", .turntable = -90, .aslant = -1, .fov = {10, 10, 10}},
};

static void open_motion(Shot *shot, const Motion *motion)
{
    Error error = {{0}};
    open_shot(shot, 1);
    shot->section.params.style = 1;
    shot->scene.run.turntable = motion->turntable;
    shot->section.params.followers.automatic = false; // only the strands
    shot->section.params.followers.value = 0;
    if (motion->aslant != 0) lay_aslant(shot, motion->aslant);
    Keyframes *track = &shot->scene.bodies[0].head.translation.keys;
    keyframes_append(track, 0, STILL, 3, &error);
    if (motion->head_from > 0) keyframes_append(track, (double)motion->head_from, STILL, 3, &error);
    keyframes_append(track, 2, motion->head_to, 3, &error);
    for (int i = 0; i < 3 && motion->fov[0] > 0; ++i)
        keyframes_append(&shot->scene.fov.keys, i, &motion->fov[i], 1, &error);
}

static void hair_stays_in_the_frame_and_fills_it(void **state)
{
    (void)state;
    for (size_t m = 0; m < sizeof MOTIONS / sizeof *MOTIONS; ++m) {
        Shot shot;
        open_motion(&shot, &MOTIONS[m]);
        frame_shot(&shot);
        float most = 0;
        for (int frame = 0; frame < shot.scene.run.frames; ++frame) {
            View view;
            float rotation[4], translation[3];
            view_of(&shot, frame, &view);
            rigid_track_evaluate(&shot.scene.bodies[0].head, frame / 60.0, rotation, translation);
            most = fmaxf(most, extent_in_frame(&shot, &view, translation));
        }
        if (!(most <= 1 && most > 0.8f))
            fail_msg("%s: hair reaches %g of the frame", MOTIONS[m].name, (double)most);
        close_shot(&shot);
    }
}

// Loose hair falls out of its style: the camera must leave space below.
static void room_is_left_for_hair_that_falls(void **state)
{
    (void)state;
    Shot loose, rigid;
    open_shot(&loose, 1);
    open_shot(&rigid, 1);
    loose.section.params.style = 0;
    rigid.section.params.style = 1;
    frame_shot(&loose);
    frame_shot(&rigid);
    assert_true(loose.framing.target[1] < rigid.framing.target[1] - 0.05f);
    close_shot(&loose);
    close_shot(&rigid);
}

static void turntable_keeps_its_distance_and_comes_round(void **state)
{
    (void)state;
    Shot shot;
    View first, view;
    open_shot(&shot, 1);
    shot.scene.run.turntable = 360;
    frame_shot(&shot);
    view_of(&shot, 0, &first);
    float distance = glm_vec3_distance(first.eye, shot.framing.target);
    for (int frame = 1; frame <= 120; ++frame) {
        view_of(&shot, frame, &view);
        assert_true(fabsf(glm_vec3_distance(view.eye, shot.framing.target) - distance) <
                    1e-5f * distance);
        assert_true(fabsf(view.eye[1] - first.eye[1]) < 1e-5f * distance);
    }
    // frame 120 equals frame 0
    assert_true(glm_vec3_distance(view.eye, first.eye) < 1e-5f * distance);
    view_of(&shot, 30, &view); // a quarter turn: from the front past +x
    assert_true(view.eye[0] > shot.framing.target[0] && view.eye[2] < first.eye[2]);
    close_shot(&shot);
}

static void frames_are_repeatable(void **state)
{
    (void)state;
    Shot shot, again;
    View a, b;
    open_shot(&shot, 1);
    open_shot(&again, 1);
    frame_shot(&shot);
    frame_shot(&again);
    memset(&a, 0, sizeof a), memset(&b, 0, sizeof b);
    view_of(&shot, 17, &a);
    view_of(&again, 17, &b);
    assert_memory_equal(&a, &b, sizeof a);
    close_shot(&shot);
    close_shot(&again);
}

static void the_unit_does_not_change_the_picture(void **state)
{
    (void)state;
    Shot one, hundred;
    View a, b;
    open_shot(&one, 1);
    open_shot(&hundred, 100);
    frame_shot(&one);
    frame_shot(&hundred);
    view_of(&one, 0, &a);
    view_of(&hundred, 0, &b);
    assert_true(fabsf(extent_in_frame(&one, &a, STILL) - extent_in_frame(&hundred, &b, STILL)) <
                1e-4f);
    assert_true(
        fabsf(100 * paint_auto_radius(&one.strands, 0) / paint_auto_radius(&hundred.strands, 0) -
              1) < 1e-4f);
    close_shot(&one);
    close_shot(&hundred);
}

static void given_eye_and_target_are_taken(void **state)
{
    (void)state;
    Shot shot;
    View view;
    vec3 seen;
    Error error;
    open_shot(&shot, 1);
    shot.scene.run.eye = (AutoVec3){false, {1, 2, 3}};
    shot.scene.run.target = (AutoVec3){false, {0, 1, 0}};
    frame_shot(&shot);
    view_of(&shot, 5, &view);
    assert_memory_equal(view.eye, shot.scene.run.eye.value, sizeof(vec3));
    glm_mat4_mulv3(view.view, (vec3){0, 1, 0}, 1, seen);
    assert_true(fabsf(seen[0]) < 1e-6f && fabsf(seen[1]) < 1e-6f && seen[2] < 0);
    keyframes_append(&shot.scene.eye.keys, 0, (float[3]){0, 0, 5}, 3, &error);
    keyframes_append(&shot.scene.eye.keys, 1, (float[3]){0, 0, 9}, 3, &error);
    view_of(&shot, 60, &view);
    assert_true(fabsf(view.eye[2] - 9) < 1e-5f);
    close_shot(&shot);
}

static void set_formulas(Track *track, const char *range, const char *const texts[3])
{
    const ParamInfo *info = params_find(range);
    const TrackRange bounds = {info->minimum, info->maximum, 1};
    for (uint32_t i = 0; i < 3 && texts[i]; ++i)
        assert_int_equal(track_set_formula(track, i, texts[i], &bounds, NULL), RESULT_OK);
}

// An eye that circles its target, itself in motion, while the lens zooms. Formulas follow the
// scene's clock: in half speed, frame 60 of 30 a second is at 1 s.
static void formulas_move_eye_target_and_lens(void **state)
{
    (void)state;
    Shot shot;
    View view;
    open_shot(&shot, 1);
    shot.scene.run.fps = 30;
    shot.scene.run.speed = 0.5f;
    set_formulas(&shot.scene.eye, "eye", (const char *[]){"3*sin(pi*t/2)", "1+t", "3*cos(pi*t/2)"});
    set_formulas(&shot.scene.target, "eye", (const char *[]){"0", "1+t", "0"});
    set_formulas(&shot.scene.fov, "fov", (const char *[]){"40-10*t", NULL, NULL});
    frame_shot(&shot);
    view_of(&shot, 60, &view);
    const vec3 expected = {3, 2, 0};
    for (int k = 0; k < 3; ++k) assert_true(fabsf(view.eye[k] - expected[k]) < 1e-5f);
    assert_true(fabsf(glm_deg(view.fov) - 30) < 1e-4f);
    vec3 seen;
    glm_mat4_mulv3(view.view, (vec3){0, 2, 0}, 1, seen);
    assert_true(fabsf(seen[0]) < 1e-5f && fabsf(seen[1]) < 1e-5f && fabsf(seen[2] + 3) < 1e-5f);
    close_shot(&shot);
}

static void every_camera_is_finite(void **state)
{
    (void)state;
    const float eyes[][3] = {{0, 0, 0}, {0, 5, 0}, {0, -5, 0}, {0, 0, -3}, {1e6f, 0, 0}};
    const float ups[][3] = {{0, 1, 0}, {0, 0, 1}, {0, 0, 0}, {0, 0, -1}};
    for (int e = -1; e < 5; ++e)
        for (int u = 0; u < 4; ++u) {
            Shot shot;
            View view;
            open_shot(&shot, 1);
            if (e >= 0) memcpy(shot.scene.run.eye.value, eyes[e], sizeof eyes[e]);
            shot.scene.run.eye.automatic = e < 0;
            shot.scene.run.target.automatic = false; // the origin
            memcpy(shot.scene.run.camera_up, ups[u], sizeof ups[u]);
            shot.scene.run.turntable = 90;
            frame_shot(&shot);
            view_of(&shot, 40, &view);
            for (int i = 0; i < 16; ++i) {
                assert_true(isfinite(view.view[i / 4][i % 4]));
                assert_true(isfinite(view.projection[i / 4][i % 4]));
            }
            mat3 turn, product; // the view must be a rotation
            glm_mat4_pick3(view.view, turn);
            assert_true(fabsf(glm_mat3_det(turn) - 1) < 1e-4f);
            glm_mat3_transpose_to(turn, product);
            glm_mat3_mul(turn, product, product);
            assert_true(fabsf(product[0][0] - 1) < 1e-4f && fabsf(product[1][0]) < 1e-4f);
            assert_true(view.near_distance > 0 && view.far_distance > view.near_distance);
            close_shot(&shot);
        }
}

// Followers are up to the radius away from their guides.
static void room_is_left_for_followers(void **state)
{
    (void)state;
    Shot shot;
    open_shot(&shot, 1);
    shot.section.params.followers.automatic = false;
    shot.section.params.followers.value = 0;
    frame_shot(&shot);
    float high = shot.framing.hair.high[1];
    shot.section.params.followers.value = 4;
    shot.section.params.follower_radius.automatic = false;
    shot.section.params.follower_radius.value = 0.2f;
    shot.section.params.tip_separation = 0;
    frame_shot(&shot);
    assert_true(fabsf(shot.framing.hair.high[1] - high - 0.2f) < 1e-5f);
    close_shot(&shot);
}

static void of_an_empty_scene_the_planes_are_in_order(void **state)
{
    (void)state;
    Shot shot;
    View view;
    open_shot(&shot, 1);
    memset(&shot.framing, 0, sizeof shot.framing);
    shot.framing.eye[2] = 2;
    view_of(&shot, 0, &view);
    assert_true(view.near_distance > 0 && view.near_distance < view.far_distance);
    close_shot(&shot);
}

// 20 degrees from the vertical, the image is still upright; exactly along it, another direction is
// up.
static void up_is_kept_as_long_as_it_can_be(void **state)
{
    (void)state;
    Shot shot;
    View view;
    open_shot(&shot, 1);
    frame_shot(&shot);
    shot.scene.run.eye.automatic = shot.scene.run.target.automatic = false;
    memcpy(shot.scene.run.target.value, (float[3]){0, 0, 0}, sizeof(float[3]));
    memcpy(shot.scene.run.eye.value, (float[3]){0.342f, 0.94f, 0}, sizeof(float[3]));
    view_of(&shot, 0, &view);
    // Row 1 of the view is the image's up direction.
    assert_true(fabsf(view.view[1][1] - 0.342f) < 1e-3f && view.view[0][1] < -0.9f);
    close_shot(&shot);
}

static void denser_hair_is_drawn_finer(void **state)
{
    (void)state;
    Strands few = make_tuft(1), many;
    Error error;
    assert_int_equal(strands_create(&many, 800 * STRANDS, 800 * few.vertex_count, &error),
                     RESULT_OK);
    for (uint32_t s = 0; s <= 800 * STRANDS; ++s) many.first[s] = s * VERTICES;
    for (uint32_t v = 0; v < many.vertex_count; ++v)
        memcpy(many.position[v], few.position[v % few.vertex_count], sizeof(float[3]));
    float coarse = paint_auto_radius(&few, 0), fine = paint_auto_radius(&many, 0);
    assert_true(fine < coarse && fine > 0 && coarse <= 0.3f / 100);
    Strands none = {0};
    assert_true(paint_auto_radius(&none, 0) > 0);
    strands_destroy(&few);
    strands_destroy(&many);
}

// All hair lies between the near and far depth in all frames, and the two are close to the hair.
static void depths_span_the_scene(void **state)
{
    (void)state;
    Shot shot;
    float range[2], nearest = INFINITY, farthest = 0;
    open_shot(&shot, 1);
    shot.scene.run.frames = 100;
    shot.scene.run.turntable = 360;
    frame_shot(&shot);
    camera_depth_range(range, &shot.scene, &shot.framing);
    for (int frame = 0; frame < 100; ++frame) {
        View view;
        view_of(&shot, frame, &view);
        for (uint32_t v = 0; v < shot.strands.vertex_count; ++v) {
            vec3 x = {0}, seen;
            memcpy(x, shot.strands.position[v], sizeof x);
            glm_mat4_mulv3(view.view, x, 1, seen);
            nearest = fminf(nearest, -seen[2]);
            farthest = fmaxf(farthest, -seen[2]);
        }
    }
    assert_true(range[0] <= nearest && range[1] > farthest);
    assert_true(range[0] > 0.6f * nearest && range[1] < 1.5f * farthest);
    close_shot(&shot);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(depths_span_the_scene),
        cmocka_unit_test(hair_stays_in_the_frame_and_fills_it),
        cmocka_unit_test(room_is_left_for_hair_that_falls),
        cmocka_unit_test(turntable_keeps_its_distance_and_comes_round),
        cmocka_unit_test(frames_are_repeatable),
        cmocka_unit_test(the_unit_does_not_change_the_picture),
        cmocka_unit_test(given_eye_and_target_are_taken),
        cmocka_unit_test(formulas_move_eye_target_and_lens),
        cmocka_unit_test(every_camera_is_finite),
        cmocka_unit_test(room_is_left_for_followers),
        cmocka_unit_test(of_an_empty_scene_the_planes_are_in_order),
        cmocka_unit_test(up_is_kept_as_long_as_it_can_be),
        cmocka_unit_test(denser_hair_is_drawn_finer),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
