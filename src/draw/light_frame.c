// SPDX-License-Identifier: MIT
#include "draw/light_frame.h"

#include <math.h>

// Row k of the window (0, 1) is that of the view in texels.
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
    for (int k = 0; k < 4; ++k) light_view_row(view, k, frame.rows[k]);
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
