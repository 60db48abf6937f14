// SPDX-License-Identifier: MIT
// A strand on the screen: its points, the test whether a point can be left out, and the ribbons
// between the kept points. For shaders and for vectorised C. Lengths are in px.
//   REAL: float, or in GLSL a vector of pixels
#ifdef __STDC__
#pragma once
#endif
#include "common/shared_math.h"
#ifndef REAL
#define REAL float
#endif

#define RIBBON_LEAST_OPACITY  (1.0f / 4096.0f) // strands with less opacity are not drawn
#define RIBBON_LEAST_COVERAGE (1.0f / 512.0f)  // a pixel's nearest ribbon covers at least this
#define RIBBON_LEAST_THROUGH  (1.0f / 1024.0f) // pixels with less transmittance count as opaque
#define RIBBON_STRAIGHT       0.05f            // px: most that a left-out point is off the ribbon
#define RIBBON_FOLD           0.25f  // joints with less than this 1 + d0.d1 fold and have no mitre
#define RIBBON_JOINT          512.0f // a joint's bound is up to twice this long

SHARED_STRUCT(RibbonPoint)
{
    float x, y;
    float inverse_w;  // 1/m, of the distance from the eye; 0: not visible
    float half_width; // px
};

// Projects a point (x, y, w in clip space) of a strand with this radius (m), in an image of width x
// height px. Points in front of the near plane are not visible. `focal`: px of one metre at a
// distance of one metre.
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

// The place on the way from a to b (0 .. 1) of the point of a straight ribbon that would replace
// `p`.
SHARED_FUNCTION float ribbon_share(RibbonPoint a, RibbonPoint p, RibbonPoint b)
{
    float chord_x = b.x - a.x, chord_y = b.y - a.y, arm_x = p.x - a.x, arm_y = p.y - a.y;
    float share = (arm_x * chord_x + arm_y * chord_y) /
                  SHARED_MAX(chord_x * chord_x + chord_y * chord_y, 1e-12f);
    return SHARED_MIN(SHARED_MAX(share, 0.0f), 1.0f);
}

// How far `p` is from the point that replaces it if the ribbon runs straight from a to b: in place,
// depth and width. 1 is the most that is allowed.
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

// Off the optical axis a cylinder's outline is wider: by sqrt(1 + (q/focal)^2), where q is the
// distance from the axis at which the cylinder's tangent planes through the eye cut the screen. (x,
// y): a vector of any length along the ribbon; (off_x, off_y): from the axis to the point.
SHARED_FUNCTION float ribbon_widening(float x, float y, float off_x, float off_y, float focal)
{
    float q = (x * off_y - y * off_x) / (SHARED_SQRT(SHARED_MAX(x * x + y * y, 1e-12f)) * focal);
    return SHARED_SQRT(1.0f + q * q);
}

// --- Ends. At a joint of two ribbons, the bound is the sum of both directions. Points on its
// positive side lie beyond the joint; see block.glsl.

SHARED_STRUCT(RibbonBound)
{
    float x, y;
    float offset; // the share beyond the end is clamp(distance along the bound + offset, 0, 1)
};

// The bound of a ribbon with the unit direction (x, y) at the end where a ribbon with the direction
// (other_x, other_y) joins it. The other direction is 0 at a free end.
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

// How far beyond an end pixels may be covered, for a ribbon that reaches `reach` across.
SHARED_FUNCTION float ribbon_overhang(RibbonBound bound, float x, float y, float reach)
{
    float tangent =
        SHARED_ABS(bound.x * y - bound.y * x) / SHARED_MAX(bound.x * x + bound.y * y, 0.1f);
    return bound.offset < 0.75f ? 0.5f : SHARED_MIN(tangent, 3.0f) * reach + 0.01f;
}

// --- The share of a pixel that a ribbon covers. Across the ribbon, a pixel's profile is a
// trapezoid: a box of width a convolved with a box of width b, where a is the larger and b the
// smaller component of the direction. A(t) is the profile's area between the middle and t >= 0:
// A(t) = (m - max(m - (a - b)/2, 0)^2 / (2 b)) / a, where m = min(t, (a + b)/2). At the distance d,
// the ribbon |across| < h covers A(d + h) - sign(d - h) A(|d - h|).

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

// A(t) times a.
SHARED_FUNCTION REAL ribbon_area(REAL t, float inner, float outer, float curve)
{
    REAL m = SHARED_MIN(t, outer), beyond = SHARED_MAX(m - inner, 0.0f);
    return m - curve * (beyond * beyond);
}
