// SPDX-License-Identifier: MIT
// Smooth curves through a strand's particles, for shaders and for vectorised C. A point of a
// segment is the segment's first end plus a weighted sum of three vectors: from the particle before
// to the first end, along the segment, and from its last end to the particle after. At the root and
// the tip the missing neighbour is mirrored: its vector is that of the segment.
#ifdef __STDC__
#pragma once
#endif
#include "common/shared_math.h"

SHARED_STRUCT(CurveWeights)
{
    float before, own, after; // weights of the three vectors
};

// The uniform cubic B-spline at t (0 to 1) of the segment. Its four weights are rewritten for the
// three vectors.
SHARED_FUNCTION CurveWeights curve_spline(float t)
{
    float s = 1.0f - t;
    CurveWeights weights;
    weights.before = -s * s * s * (1.0f / 6.0f);
    weights.after = t * t * t * (1.0f / 6.0f);
    weights.own = ((3.0f * s - 6.0f) * s * s + 4.0f) * (1.0f / 6.0f) + weights.after;
    return weights;
}

// Catmull-Rom with centripetal knots: the distance of knots is the square root of the distance of
// particles.
SHARED_FUNCTION float curve_knot(float x, float y, float z)
{
    return SHARED_MAX(SHARED_SQRT(SHARED_SQRT(x * x + y * y + z * z)), 1e-9f);
}

// Ratios that the tangents at both ends are made of: the segment's knot distance over a neighbour's
// (before, after), and over the sum of both (from, to).
SHARED_STRUCT(CurveKnots) { float before, from, to, after; };

SHARED_FUNCTION CurveKnots curve_knots(float before, float own, float after)
{
    CurveKnots knots;
    knots.before = own / before;
    knots.from = own / (before + own);
    knots.to = own / (own + after);
    knots.after = own / after;
    return knots;
}

// Tangents of the parabolas through three knots (Barry and Goldman 1988), times the segment's knot
// distance.
SHARED_FUNCTION CurveWeights curve_tangent_from(CurveKnots knots)
{
    CurveWeights weights;
    weights.before = knots.before - knots.from;
    weights.own = 1.0f - knots.from;
    weights.after = 0.0f;
    return weights;
}

SHARED_FUNCTION CurveWeights curve_tangent_to(CurveKnots knots)
{
    CurveWeights weights;
    weights.before = 0.0f;
    weights.own = 1.0f - knots.to;
    weights.after = knots.after - knots.to;
    return weights;
}

// The Hermite curve with these tangents.
SHARED_FUNCTION CurveWeights curve_hermite(CurveKnots knots, float t)
{
    float s = 1.0f - t, end = (3.0f - 2.0f * t) * t * t, by_from = t * s * s, by_to = -t * t * s;
    CurveWeights from = curve_tangent_from(knots), to = curve_tangent_to(knots), weights;
    weights.before = by_from * from.before;
    weights.own = end + by_from * from.own + by_to * to.own;
    weights.after = by_to * to.after;
    return weights;
}
