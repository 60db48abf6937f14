// SPDX-License-Identifier: MIT
// A strand on the screen: its points, which of them may be left out, and the ribbons between the
// rest. For shaders and for vectorised C. Lengths are in px.
//   REAL: float, or in GLSL a vector of pixels
#ifdef __STDC__
#pragma once
#endif
#include "common/shared_math.h"
#ifndef REAL
#define REAL float
#endif

#define RIBBON_LEAST_OPACITY  (1.0f / 4096.0f) // what is clearer is not drawn
#define RIBBON_LEAST_COVERAGE (1.0f / 512.0f)  // of a pixel, by which a ribbon is its nearest one
#define RIBBON_LEAST_THROUGH  (1.0f / 1024.0f) // share of what stands behind that still counts
#define RIBBON_STRAIGHT       0.05f            // px that a point may be off what stands in for it
#define RIBBON_FOLD           0.25f  // of 1 + d0.d1: a joint that is more of a fold has no mitre
#define RIBBON_JOINT          512.0f // length of a joint's bound, times 2 at most

SHARED_STRUCT(RibbonPoint)
{
    float x, y;
    float inverse_w;  // 1/m before the eye; 0: not in sight
    float half_width; // px
};

// A point (x, y, w of clip space) of a strand of this radius (m), in an image of width x height px;
// what lies before the near plane is not in sight. `focal`: px that a metre has at a distance of 1.
SHARED_FUNCTION RibbonPoint ribbon_project(float x, float y, float w, float radius, float width,
                                           float height, float near_distance, float focal)
{
    float inverse = 1.0f / SHARED_MAX(w, 1e-20f);
    RibbonPoint p;
    p.x = (0.5f * SHARED_MIN(SHARED_MAX(x * inverse, -1e4f), 1e4f) + 0.5f) * width;
    p.y = (0.5f * SHARED_MIN(SHARED_MAX(y * inverse, -1e4f), 1e4f) + 0.5f) * height;
    p.inverse_w = w >= 0.999f * near_distance ? inverse : 0.0f;
    p.half_width = focal * radius * inverse;
    return p;
}

// Where on the way from a to b, 0 .. 1, a straight ribbon has what stands in the place of `p`.
SHARED_FUNCTION float ribbon_share(RibbonPoint a, RibbonPoint p, RibbonPoint b)
{
    float chord_x = b.x - a.x, chord_y = b.y - a.y, arm_x = p.x - a.x, arm_y = p.y - a.y;
    float share = (arm_x * chord_x + arm_y * chord_y) /
                  SHARED_MAX(chord_x * chord_x + chord_y * chord_y, 1e-12f);
    return SHARED_MIN(SHARED_MAX(share, 0.0f), 1.0f);
}

// How far `p` is from what stands in its place if the ribbon runs straight from a to b: 1 is as
// much as may be.
SHARED_FUNCTION float ribbon_bend(RibbonPoint a, RibbonPoint p, RibbonPoint b)
{
    float t = ribbon_share(a, p, b);
    float x = SHARED_ABS(p.x - a.x - t * (b.x - a.x)) * (1.0f / RIBBON_STRAIGHT),
          y = SHARED_ABS(p.y - a.y - t * (b.y - a.y)) * (1.0f / RIBBON_STRAIGHT),
          w = SHARED_ABS(p.inverse_w - a.inverse_w - t * (b.inverse_w - a.inverse_w)) /
              (0.001f * p.inverse_w + 1e-20f),
          wide = SHARED_ABS(p.half_width - a.half_width - t * (b.half_width - a.half_width)) /
                 (0.05f * p.half_width);
    x = SHARED_MAX(x, y);
    w = SHARED_MAX(w, wide);
    return SHARED_MAX(x, w);
}

// A cylinder's outline seen off the optical axis is wider: where its tangent planes through the eye
// cut the screen at the distance q from the axis, by sqrt(1 + (q/focal)^2). (x, y) of any length
// lies along the ribbon, (off_x, off_y) is the way from the axis to the point.
SHARED_FUNCTION float ribbon_widening(float x, float y, float off_x, float off_y, float focal)
{
    float q = (x * off_y - y * off_x) / (SHARED_SQRT(SHARED_MAX(x * x + y * y, 1e-12f)) * focal);
    return SHARED_SQRT(1.0f + q * q);
}

// --- Ends. Beyond a joint of two ribbons lies what is on the positive side of its bound, the sum
// of both directions; see block.glsl.

SHARED_STRUCT(RibbonBound)
{
    float x, y;
    float offset; // the share beyond is clamp(distance along the bound + this, 0, 1)
};

// The bound of a ribbon of the unit direction (x, y) at the end where one of the direction
// (other_x, other_y) joins it, which is 0 where there is none.
SHARED_FUNCTION RibbonBound ribbon_bound(float x, float y, float other_x, float other_y)
{
    bool apart = other_x * other_x + other_y * other_y < 0.25f,
         folds = 1.0f + x * other_x + y * other_y < RIBBON_FOLD;
    RibbonBound bound;
    bound.x = apart || folds ? x : RIBBON_JOINT * (x + other_x);
    bound.y = apart || folds ? y : RIBBON_JOINT * (y + other_y);
    bound.offset = apart || folds ? 0.5f : 1.0f;
    return bound;
}

// How far beyond an end the bound lets pixels be, for a ribbon that reaches so far across.
SHARED_FUNCTION float ribbon_overhang(RibbonBound bound, float x, float y, float reach)
{
    float tangent =
        SHARED_ABS(bound.x * y - bound.y * x) / SHARED_MAX(bound.x * x + bound.y * y, 0.1f);
    return bound.offset < 0.75f ? 0.5f : SHARED_MIN(tangent, 3.0f) * reach + 0.01f;
}

// --- The share of a pixel that a ribbon covers: the pixel's profile across the ribbon is a box as
// wide as the larger component a of the direction spread by one as wide as the smaller, b, a
// trapezoid. With its area between the middle and t >= 0, A(t) = (m - max(m - (a - b)/2, 0)^2 / (2
// b)) / a where m = min(t, (a + b)/2), the ribbon |across| < h covers A(d + h) - sign(d - h) A(|d -
// h|) at the distance d.

SHARED_STRUCT(RibbonProfile)
{
    float inner, outer; // (a - b) / 2, (a + b) / 2
    float factor;       // 1 / a
    float curve;        // 1 / (2 b)
};

SHARED_FUNCTION RibbonProfile ribbon_profile(float x, float y)
{
    float a = SHARED_MAX(SHARED_ABS(x), SHARED_ABS(y)),
          b = SHARED_MAX(SHARED_MIN(SHARED_ABS(x), SHARED_ABS(y)), 1e-3f);
    RibbonProfile profile;
    profile.inner = 0.5f * (a - b);
    profile.outer = 0.5f * (a + b);
    profile.factor = 1.0f / a;
    profile.curve = 0.5f / b;
    return profile;
}

// A(t) a.
SHARED_FUNCTION REAL ribbon_area(REAL t, float inner, float outer, float curve)
{
    REAL m = SHARED_MIN(t, outer), beyond = SHARED_MAX(m - inner, 0.0f);
    return m - curve * (beyond * beyond);
}
