// SPDX-License-Identifier: MIT
#include "fit.h"
#include "camera.h"

#include <cglm/cglm.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool fit_is_free(const Scene *scene)
{
    return scene->run.eye.automatic && !scene->eye.count && !scene->target.count;
}

// `side` of the view (0: right, 1: top) and its opposite.
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
    double axis[3][3]; // along which the target may move from `from`, unit vectors; up first
    int axes;
    double from[3];
    double reach; // m, how far either way
} Search;

static double distance_needed(const Fit *fit, const double target[3])
{
    double distance = 0;
    for (int frame = 0; frame < fit->frame_count; ++frame)
        for (int i = 0; i < 4; ++i) {
            const FitSide *side = &fit->frames[frame][i];
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

// The least distance that is needed with the target at `from` moved along this axis and the
// following ones, by golden sections: what is convex stays so when it is minimised over some of its
// variables. 24 sections leave 1e-5 of the range; the distance is exact for the target found.
static double search_along(const Search *search, int axis, const double from[3], double target[3])
{
    const double golden = 0.61803398874989485;
    if (axis == search->axes) {
        memcpy(target, from, 3 * sizeof *target);
        return distance_needed(search->fit, from);
    }
    double low = -search->reach, high = search->reach;
    double a = high - golden * (high - low), b = low + golden * (high - low);
    double at_a = distance_at(search, axis, from, a, target);
    double at_b = distance_at(search, axis, from, b, target);
    for (int i = 0; i < 24; ++i)
        if (at_a < at_b) {
            high = b, b = a, at_b = at_a;
            a = high - golden * (high - low);
            at_a = distance_at(search, axis, from, a, target);
        } else {
            low = a, a = b, at_a = at_b;
            b = low + golden * (high - low);
            at_b = distance_at(search, axis, from, b, target);
        }
    return distance_at(search, axis, from, 0.5 * (low + high), target);
}

static void begin_search(Search *search, const Scene *scene, const Framing *framing)
{
    vec3 up = {0}, arm = {0}, across, ahead;
    memcpy(up, scene->run.camera_up, sizeof up);
    glm_vec3_normalize(up);
    for (int k = 0; k < 3; ++k) arm[k] = framing->eye[k] - framing->target[k];
    glm_vec3_crossn(up, arm, across);
    glm_vec3_cross(across, up, ahead);
    for (int k = 0; k < 3; ++k) {
        float extent = framing->all.high[k] - framing->all.low[k];
        search->axis[0][k] = (double)up[k];
        search->axis[1][k] = (double)across[k];
        search->axis[2][k] = (double)ahead[k];
        search->from[k] = (double)framing->target[k];
        search->reach += (double)extent;
    }
    bool whole = fabsf(scene->run.turntable) >= 360;
    search->axes = !scene->run.target.automatic ? 0 : whole ? 3 : 1;
}

void fit_solve(const Fit *fit, const Scene *scene, Framing *framing)
{
    Search search = {.fit = fit};
    double target[3];
    vec3 back = {0};
    begin_search(&search, scene, framing);
    for (int k = 0; k < 3; ++k) back[k] = framing->eye[k] - framing->target[k];
    glm_vec3_normalize(back);
    double distance = search_along(&search, 0, search.from, target);
    if (!(distance > 0)) return;
    for (int k = 0; k < 3; ++k) {
        framing->target[k] = (float)target[k];
        framing->eye[k] = (float)(target[k] + distance * (double)back[k]);
    }
}
