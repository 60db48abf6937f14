// SPDX-License-Identifier: MIT
#include "draw/light_frame.h"

#include "base/double3.h"

#include <math.h>
#include <string.h>

LightView light_frame_view(const Light *light, const float middle[3])
{
    LightView view = {.perspective = light->kind != LIGHT_DIRECTIONAL};
    double *way = view.axis[2];
    Double3 across = {0};
    for (int k = 0; k < 3; ++k) {
        view.origin[k] = view.perspective ? (double)light->position[k] : 0;
        way[k] =
            view.perspective ? (double)middle[k] - view.origin[k] : -(double)light->direction[k];
    }
    if (way[0] == 0 && way[1] == 0 && way[2] == 0) way[1] = -1; // the lamp is at the centre
    double3_normalize(way);
    across[fabs(way[1]) < 0.9 ? 1 : 0] = 1;
    double3_cross(across, way, view.axis[0]);
    double3_normalize(view.axis[0]);
    double3_cross(way, view.axis[0], view.axis[1]);
    return view;
}

void light_frame_row(const LightView *view, int k, double row[4])
{
    memset(row, 0, 4 * sizeof *row);
    if (k == 3 && !view->perspective) {
        row[3] = 1;
        return;
    }
    const double *axis = view->axis[k < 3 ? k : 2];
    for (int i = 0; i < 3; ++i) {
        row[i] = axis[i];
        row[3] -= axis[i] * view->origin[i];
    }
}

bool light_frame_place(const LightView *view, const double x[3], double place[3])
{
    for (int k = 0; k < 3; ++k) {
        double row[4];
        light_frame_row(view, k, row);
        place[k] = row[0] * x[0] + row[1] * x[1] + row[2] * x[2] + row[3];
    }
    if (!view->perspective) return true;
    if (place[2] <= 0) return false;
    place[0] /= place[2];
    place[1] /= place[2];
    return true;
}

// Scales and shifts rows 0 and 1 of the view so that they give coordinates in texels. The texel
// size is rounded up to an eighth of an octave and the shift to whole texels, so that small
// movements of the box do not change the map.
static void set_window(LightFrame *frame, const double low[2], const double high[2], int side,
                       int margin)
{
    double extent = fmax(fmax(high[0] - low[0], high[1] - low[1]), 1e-6);
    double texel = exp2(ceil(8 * log2(extent)) / 8) / (side - 2 * margin);
    for (int k = 0; k < 2; ++k) {
        double shift = side / 2.0 - floor((low[k] + high[k]) / (2 * texel));
        for (int i = 0; i < 4; ++i)
            frame->rows[k][i] = frame->rows[k][i] / texel + shift * frame->rows[3][i];
    }
    frame->texel = texel;
}

static void set_depth(LightFrame *frame, double near, double far)
{
    double range = far - near;
    for (int i = 0; i < 4; ++i)
        frame->rows[2][i] = frame->rows[2][i] / range - (i == 3 ? near / range : 0);
    frame->depth[0] = near;
    frame->depth[1] = far;
}

static LightFrame begin(const LightView *view, const double box[6], int side, int margin)
{
    LightFrame frame = {0};
    for (int k = 0; k < 4; ++k) light_frame_row(view, k, frame.rows[k]);
    set_window(&frame, box, box + 3, side, margin);
    return frame;
}

LightFrame light_frame_steady(const LightView *view, const double box[6], int side, int margin)
{
    LightFrame frame = begin(view, box, side, margin);
    double range = exp2(ceil(8 * log2(fmax(1.02 * (box[5] - box[2]), 1e-6))) / 8),
           near = box[2] - 0.01 * range;
    set_depth(&frame, near, near + range);
    return frame;
}

LightFrame light_frame_drawn(const LightView *view, const double box[6], int side, int margin)
{
    LightFrame frame = begin(view, box, side, margin);
    double range = fmax(box[5] - box[2], 1e-6), near = box[2] - 0.01 * range,
           far = box[5] + 0.01 * range;
    if (view->perspective) {
        near = fmax(near, 1e-3 * far);
        for (int i = 0; i < 4; ++i)
            frame.rows[2][i] = far / (far - near) * (frame.rows[3][i] - (i == 3 ? near : 0));
        frame.depth[0] = near, frame.depth[1] = far;
    } else {
        set_depth(&frame, near, far);
    }
    return frame;
}
