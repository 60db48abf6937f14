// SPDX-License-Identifier: MIT
#include "scene/fit.h"
#include "scene/camera.h"

#include <cglm/cglm.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool fit_is_free(const Scene *scene)
{
    return scene->run.eye.automatic && !track_is_given(&scene->eye) &&
           !track_is_given(&scene->target);
}

// Sets a pair of opposite sides of the view: right and left (`side` 0) or top and bottom (1).
static void set_sides(FitSide sides[2], const View *view, int side, float slope, float scale)
{
    for (int i = 0; i < 2; ++i) {
        sides[i].widening = scale / slope;
        sides[i].reach = -INFINITY;
        for (int k = 0; k < 3; ++k)
            sides[i].normal[k] =
                view->view[k][2] + (i ? -1.0f : 1.0f) * scale / slope * view->view[k][side];
    }
}

Result fit_create(Fit *fit, const Scene *scene, const Framing *expected, Error *error)
{
    const RunParams *run = &scene->run;
    *fit = (Fit){.frame_count = run->frames};
    fit->frames = malloc((size_t)run->frames * sizeof *fit->frames);
    if (!fit->frames)
        return error_set(error, RESULT_FAILED, "no memory for the cameras of %d frames",
                         run->frames);
    for (int frame = 0; frame < run->frames; ++frame) {
        View view;
        camera_view(&view, scene, expected, frame);
        float slope = tanf(view.fov / 2), aspect = (float)run->size[0] / (float)run->size[1];
        set_sides(&fit->frames[frame][0], &view, 0, slope * aspect, 1 + run->margin);
        set_sides(&fit->frames[frame][2], &view, 1, slope, 1 + run->margin);
    }
    return RESULT_OK;
}

void fit_destroy(Fit *fit)
{
    free(fit->frames);
    *fit = (Fit){0};
}

void fit_add(Fit *fit, int frame, const float (*points)[3], size_t count, float radius)
{
    for (int i = 0; i < 4; ++i) {
        FitSide *side = &fit->frames[frame][i];
        const float *n = side->normal;
        float reach = -INFINITY;
        for (size_t p = 0; p < count; ++p) {
            float along = n[0] * points[p][0] + n[1] * points[p][1] + n[2] * points[p][2];
            reach = along > reach ? along : reach;
        }
        side->reach = fmaxf(side->reach, reach + side->widening * radius);
    }
}

// --- The target.

typedef struct Search {
    const Fit *fit;
    int sides;         // sides of a frame to consider: 2 (left and right) or 4
    double axis[2][3]; // unit vectors along which the target may move
    int axes;
    double reach; // m, largest move in either direction
} Search;

static double distance_needed(const Search *search, const double target[3])
{
    double distance = 0;
    for (int frame = 0; frame < search->fit->frame_count; ++frame)
        for (int i = 0; i < search->sides; ++i) {
            const FitSide *side = &search->fit->frames[frame][i];
            double needed = (double)side->reach;
            for (int k = 0; k < 3; ++k) needed -= (double)side->normal[k] * target[k];
            distance = fmax(distance, needed);
        }
    return distance;
}

static double search_along(const Search *search, int axis, const double from[3], double target[3]);

static double distance_at(const Search *search, int axis, const double from[3], double by,
                          double target[3])
{
    double moved[3];
    for (int k = 0; k < 3; ++k) moved[k] = from[k] + by * search->axis[axis][k];
    return search_along(search, axis + 1, moved, target);
}

// The smallest distance that is needed if the target may move from `from` along this axis and the
// following ones. Nested golden-section searches are valid because a convex function stays convex
// when it is minimised over some of its variables. 24 sections leave 1e-5 of the range; the
// returned distance is exact for the returned target.
static double search_along(const Search *search, int axis, const double from[3], double target[3])
{
    const double golden = 0.61803398874989485;
    if (axis == search->axes) {
        memmove(target, from, 3 * sizeof *target);
        return distance_needed(search, from);
    }
    double low = -search->reach, high = search->reach;
    double a = high - golden * (high - low), b = low + golden * (high - low);
    double found[3];
    double at_a = distance_at(search, axis, from, a, found);
    double at_b = distance_at(search, axis, from, b, found);
    for (int i = 0; i < 24; ++i)
        if (at_a < at_b) {
            high = b, b = a, at_b = at_a;
            a = high - golden * (high - low);
            at_a = distance_at(search, axis, from, a, found);
        } else {
            low = a, a = b, at_a = at_b;
            b = low + golden * (high - low);
            at_b = distance_at(search, axis, from, b, found);
        }
    return distance_at(search, axis, from, 0.5 * (low + high), target);
}

static void put_axis(Search *search, vec3 direction)
{
    for (int k = 0; k < 3; ++k) search->axis[search->axes][k] = (double)direction[k];
    ++search->axes;
}

static double room_to_search(const Framing *framing)
{
    double room = 0;
    for (int k = 0; k < 3; ++k) room += (double)framing->all.high[k] - (double)framing->all.low[k];
    return room;
}

// Whether the frames look from all sides across these axes. From one side alone (a single frame of
// a turntable), every step of the target towards the eye would seem to bring the camera closer.
static bool looks_from_all_sides(const Fit *fit, vec3 across, vec3 ahead)
{
    vec3 sum = {0};
    for (int frame = 0; frame < fit->frame_count; ++frame)
        for (int i = 0; i < 2; ++i) // the slopes of right and left cancel out
            glm_vec3_add(sum, (float *)fit->frames[frame][i].normal, sum);
    float mean = 0.5f / (float)fit->frame_count;
    return mean * hypotf(glm_vec3_dot(sum, across), glm_vec3_dot(sum, ahead)) < 0.5f;
}

// For a whole turn, moves the target to the axis for which left and right need the smallest
// distance, so that the hair turns about its middle. Top and bottom are not considered there: they
// would prefer an axis that moves high hair away from the camera. Then finds the best height.
static void find_target(const Fit *fit, const Scene *scene, const Framing *framing,
                        double target[3])
{
    vec3 up = {0}, arm = {0}, across, ahead;
    memcpy(up, scene->run.camera_up, sizeof up);
    glm_vec3_normalize(up);
    for (int k = 0; k < 3; ++k) arm[k] = framing->eye[k] - framing->target[k];
    glm_vec3_crossn(up, arm, across);
    glm_vec3_cross(across, up, ahead);
    Search beside = {.fit = fit, .sides = 2, .reach = room_to_search(framing)}, height = beside;
    put_axis(&beside, across);
    put_axis(&beside, ahead);
    if (fabsf(scene->run.turntable) >= 360 && looks_from_all_sides(fit, across, ahead))
        search_along(&beside, 0, target, target);
    height.sides = 4;
    put_axis(&height, up);
    search_along(&height, 0, target, target);
}

void fit_solve(const Fit *fit, const Scene *scene, Framing *framing)
{
    double target[3];
    vec3 back = {0};
    for (int k = 0; k < 3; ++k) {
        target[k] = (double)framing->target[k];
        back[k] = framing->eye[k] - framing->target[k];
    }
    glm_vec3_normalize(back);
    const Search all = {.fit = fit, .sides = 4};
    if (!(distance_needed(&all, target) > 0)) return;
    if (scene->run.target.automatic) find_target(fit, scene, framing, target);
    double distance = distance_needed(&all, target);
    for (int k = 0; k < 3; ++k) {
        framing->target[k] = (float)target[k];
        framing->eye[k] = (float)(target[k] + distance * (double)back[k]);
    }
}
