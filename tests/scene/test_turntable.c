// SPDX-License-Identifier: MIT
// The angle of a turntable over time.
#include "scene/camera.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cglm/cglm.h>
#include <cmocka.h>

enum { FRAMES = 200 };

static RunParams table(float turn, float ease_in, float ease_out)
{
    return (RunParams){
        .frames = FRAMES, .turntable = turn, .ease_in = ease_in, .ease_out = ease_out};
}

// Degrees from this frame to the next, modulo a full turn.
static double step_at(const RunParams *run, int frame)
{
    return remainder(camera_turntable_deg(run, frame + 1) - camera_turntable_deg(run, frame), 360);
}

static const float EASES[][2] = {{0, 0}, {0.3f, 0}, {0, 0.3f}, {0.25f, 0.5f}, {1, 0}, {0.5f, 0.5f}};
enum { EASE_COUNT = sizeof EASES / sizeof *EASES };

static void whole_turns_come_back_to_the_bit(void **state)
{
    (void)state;
    for (int i = 0; i < EASE_COUNT; ++i)
        for (int turns = -2; turns <= 2; ++turns) {
            RunParams run = table(360.0f * (float)turns, EASES[i][0], EASES[i][1]);
            assert_true(camera_turntable_deg(&run, 0) == 0);
            assert_true(camera_turntable_deg(&run, FRAMES) == 0);
        }
}

// The step from the last frame to the first is not larger than the largest step between frames. If
// an ease-in lasts to the end, the step still grows there, by less than 3 / FRAMES of itself. With
// an ease-out, the step is among the smallest.
static void no_jump_at_the_seam(void **state)
{
    (void)state;
    for (int i = 0; i < EASE_COUNT; ++i) {
        RunParams run = table(360, EASES[i][0], EASES[i][1]);
        double most = 0, seam = step_at(&run, FRAMES - 1);
        for (int frame = 0; frame < FRAMES - 1; ++frame) most = fmax(most, step_at(&run, frame));
        assert_true(seam > 0 && seam <= most * (EASES[i][0] < 1 ? 1 + 1e-9 : 1 + 3.0 / FRAMES));
        if (EASES[i][1] > 0) assert_true(seam < 0.05 * most);
    }
}

// Without easing, a turn is even. With easing, steps grow from 0 to a constant step and shrink
// again. Neighbouring steps differ by no more than the curve's greatest acceleration: v times 3/2
// divided by the ease's length, with v = 360 / (1 - (a + b) / 2).
static void eases_speed_up_and_slow_down(void **state)
{
    (void)state;
    RunParams even = table(360, 0, 0);
    for (int frame = 0; frame < FRAMES; ++frame)
        assert_true(fabs(step_at(&even, frame) - 360.0 / FRAMES) < 1e-9);
    RunParams run = table(360, 0.25f, 0.5f);
    double v = 360 / (1 - 0.375) / FRAMES, most = v * 1.5 / (0.25 * FRAMES);
    assert_true(step_at(&run, 0) < 0.01 * v && step_at(&run, FRAMES - 1) < 0.01 * v);
    for (int frame = 1; frame < FRAMES; ++frame) {
        double grown = step_at(&run, frame) - step_at(&run, frame - 1);
        if (frame < 50) assert_true(grown > 0 && grown <= most);
        if (frame > 50 && frame < 100) assert_true(fabs(grown) < 1e-9);
        if (frame > 100) assert_true(grown < 0 && grown >= -most);
    }
    assert_true(fabs(step_at(&run, 75) - v) < 1e-9);
}

static void the_camera_of_the_next_round_is_that_of_the_first(void **state)
{
    (void)state;
    Scene scene = {.run = table(-720, 0.2f, 0)};
    scene.run.size[0] = 320, scene.run.size[1] = 200;
    scene.run.fps = 30, scene.run.speed = 1, scene.run.fov = 30;
    scene.run.camera_up[1] = 1;
    scene.run.eye.automatic = scene.run.target.automatic = true;
    Framing framing = {.target = {0.1f, 0.2f, 0.3f}, .eye = {0.4f, 0.3f, 1.2f}};
    for (int frame = 0; frame < FRAMES; frame += 7) {
        View view, next;
        memset(&view, 0, sizeof view), memset(&next, 0, sizeof next);
        camera_view(&view, &scene, &framing, frame);
        camera_view(&next, &scene, &framing, frame + FRAMES);
        if (frame == 0) assert_memory_equal(&view, &next, sizeof view);
        for (int k = 0; k < 3; ++k) assert_true(fabsf(view.eye[k] - next.eye[k]) < 1e-5f);
    }
}

// Lights keep their directions relative to the camera.
static void lights_turn_with_the_camera(void **state)
{
    (void)state;
    Scene scene;
    assert_int_equal(scene_create(&scene, NULL), RESULT_OK);
    scene.run.frames = FRAMES, scene.run.turntable = 360;
    scene.lights[1].kind = LIGHT_POINT;
    memcpy(scene.lights[1].position, (float[3]){0.5f, 0.7f, -0.2f}, sizeof(vec3));
    Framing framing = {.target = {0.1f, 0.2f, 0.3f}, .eye = {0.4f, 0.3f, 1.2f}};
    vec3 first[2], seen[2];
    for (int turns = 0; turns < 2; ++turns)
        for (int frame = 0; frame < FRAMES; frame += 20) {
            View view;
            Light lights[SCENE_MAX_LIGHTS];
            scene.run.turn_lights = turns;
            camera_view(&view, &scene, &framing, frame);
            camera_lights(lights, &scene, &framing, frame);
            glm_mat4_mulv3(view.view, lights[0].direction, 0, seen[0]);
            glm_mat4_mulv3(view.view, lights[1].position, 1, seen[1]);
            if (frame == 0) memcpy(first, seen, sizeof first);
            for (int i = 0; i < 2; ++i) {
                float moved = glm_vec3_distance(first[i], seen[i]);
                assert_true(turns || frame == 0 ? moved < 1e-5f : moved > 0.05f);
            }
        }
    scene_destroy(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(whole_turns_come_back_to_the_bit),
        cmocka_unit_test(no_jump_at_the_seam),
        cmocka_unit_test(eases_speed_up_and_slow_down),
        cmocka_unit_test(lights_turn_with_the_camera),
        cmocka_unit_test(the_camera_of_the_next_round_is_that_of_the_first),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
