// SPDX-License-Identifier: MIT
#include "scene/camera.h"
#include "scene/schedule.h"

#include <cglm/cglm.h>

#include <math.h>
#include <string.h>

static void auto_or_track(const Track *track, const AutoVec3 *param, const float automatic[3],
                          double time, float *value)
{
    track_evaluate_or(track, param->automatic ? automatic : param->value, time, value);
}

// Chooses an up vector (unit) that is not parallel to `direction` (unit): `wanted`, if possible.
static void choose_up(const float wanted[3], vec3 direction, vec3 up)
{
    vec3 across;
    memcpy(up, wanted, sizeof(vec3));
    glm_vec3_normalize(up);
    glm_vec3_cross(up, direction, across);
    if (glm_vec3_norm(across) > 1e-4f) return;
    glm_vec3_copy((vec3){0, 0, -1}, up);
    if (fabsf(direction[2]) > 0.9f) glm_vec3_copy((vec3){0, 1, 0}, up);
}

// --- The turntable.

// The integral of 3 s^2 - 2 s^3 from 0 to s.
static double eased(double s)
{
    return s * s * s - 0.5 * s * s * s * s;
}

// The share of the turn that is done after the share u of the sequence. With full speed v, an
// ease-in of length a covers v a/2, an ease-out of length b covers v b/2, the rest v (1 - a - b);
// the sum is 1.
static double turned(double u, double a, double b)
{
    double v = 1 / (1 - 0.5 * (a + b));
    if (u < a) return v * a * eased(u / a);
    if (u > 1 - b) return 1 - v * b * eased((1 - u) / b);
    return v * (u - 0.5 * a);
}

double camera_turntable_deg(const RunParams *run, int frame)
{
    int rounds = frame / run->frames;
    double u = (double)(frame % run->frames) / run->frames;
    double share = turned(u, (double)run->ease_in, (double)run->ease_out);
    return fmod((double)run->turntable * (rounds + share), 360);
}

// Rotates a vector by the turntable's angle, in place.
static void turn(const Scene *scene, int frame, float vector[3])
{
    double degrees = camera_turntable_deg(&scene->run, frame);
    vec3 axis = {0};
    memcpy(axis, scene->run.camera_up, sizeof axis);
    if (degrees != 0 && glm_vec3_norm(axis) > 0)
        glm_vec3_rotate(vector, glm_rad((float)degrees), axis);
}

static void turn_about(const Scene *scene, int frame, vec3 middle, vec3 point)
{
    vec3 arm, turned;
    glm_vec3_sub(point, middle, arm);
    glm_vec3_copy(arm, turned);
    turn(scene, frame, turned);
    if (memcmp(arm, turned, sizeof arm) != 0) glm_vec3_add(middle, turned, point);
}

static void look_at(View *view, vec3 target, const float camera_up[3])
{
    vec3 direction, up;
    glm_vec3_sub(target, view->eye, direction);
    float distance = glm_vec3_norm(direction);
    if (distance > 0)
        glm_vec3_scale(direction, 1 / distance, direction);
    else
        glm_vec3_copy((vec3){0, 0, -1}, direction);
    choose_up(camera_up, direction, up);
    glm_look(view->eye, direction, up, view->view);
}

// Puts the near plane well in front of the expected hair, which may swing out, and the far plane
// well behind it. The depth values of the hair do not depend on these planes.
static void find_depths(View *view, const Outline *all)
{
    float nearest = 1e30f, farthest = 0;
    for (int i = 0; i < 8 && all->any; ++i) {
        vec3 p = {0}, seen;
        outline_corner(all, i, p);
        glm_mat4_mulv3(view->view, p, 1, seen);
        nearest = fminf(nearest, -seen[2]);
        farthest = fmaxf(farthest, -seen[2]);
    }
    if (!(farthest > 0)) farthest = 1;
    view->far_distance = 4 * farthest;
    view->near_distance = fmaxf(0.1f * fminf(nearest, farthest), 1e-3f * farthest);
}

void camera_view(View *view, const Scene *scene, const Framing *framing, int frame)
{
    double time = schedule_frame_time(&scene->run, frame);
    vec3 target = {0};
    float fov_deg = scene->run.fov;
    auto_or_track(&scene->target, &scene->run.target, framing->target, time, target);
    auto_or_track(&scene->eye, &scene->run.eye, framing->eye, time, view->eye);
    if (track_is_given(&scene->fov)) track_evaluate(&scene->fov, time, &fov_deg);
    turn_about(scene, frame, target, view->eye);
    look_at(view, target, scene->run.camera_up);
    find_depths(view, &framing->all);
    view->fov = glm_rad(fov_deg);
    glm_perspective(view->fov, (float)scene->run.size[0] / (float)scene->run.size[1],
                    view->near_distance, view->far_distance, view->projection);
}

void camera_depth_range(float range[2], const Scene *scene, const Framing *framing)
{
    enum { MOST_FRAMES = 64 };
    View view;
    int frames = scene->run.frames, count = frames < MOST_FRAMES ? frames : MOST_FRAMES;
    float nearest = 1e30f, farthest = 0, least = 1e30f;
    for (int i = 0; i < count && framing->all.any; ++i) {
        camera_view(&view, scene, framing, (int)((int64_t)i * frames / count));
        least = fminf(least, view.near_distance);
        for (int p = 0; p < OUTLINE_DIRECTIONS; ++p) {
            vec3 point = {0}, seen;
            memcpy(point, framing->all.point[p], sizeof point);
            glm_mat4_mulv3(view.view, point, 1, seen);
            nearest = fminf(nearest, -seen[2]);
            farthest = fmaxf(farthest, -seen[2]);
        }
    }
    if (!(nearest < farthest)) nearest = least = 0, farthest = fmaxf(farthest, 1);
    float room = 0.05f * (farthest - nearest);
    range[0] = fmaxf(nearest - room, least);
    range[1] = farthest + room;
}

void camera_lights(Light lights[SCENE_MAX_LIGHTS], const Scene *scene, const Framing *framing,
                   int frame)
{
    vec3 target = {0};
    memcpy(lights, scene->lights, sizeof scene->lights);
    if (!scene->run.turn_lights) return;
    auto_or_track(&scene->target, &scene->run.target, framing->target,
                  schedule_frame_time(&scene->run, frame), target);
    for (uint32_t i = 0; i < scene->light_count; ++i) {
        turn(scene, frame, lights[i].direction);
        turn_about(scene, frame, target, lights[i].position);
    }
}

EnvironmentAxes camera_environment(const Scene *scene, int frame)
{
    EnvironmentAxes axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (int k = 0; k < 3; ++k) {
        glm_vec3_rotate(axes.axis[k], glm_rad(scene->run.environment_turn), (vec3){0, 1, 0});
        if (scene->run.turn_lights) turn(scene, frame, axes.axis[k]);
    }
    return axes;
}
