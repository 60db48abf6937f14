// SPDX-License-Identifier: MIT
// The share of a light that passes hair and mesh to a point: how texels of the maps of both are
// read. For shaders and for vectorised C.
#ifdef __STDC__
#pragma once
#endif
#include "kernel/caster.h"

// The place, along one axis, of the first of the `taps` texels that a point looks at, in a map that
// is `side` texels wide.
SHARED_FUNCTION float left_from(float place, float side, float taps)
{
    return SHARED_MIN(SHARED_MAX(place - 0.5f * (taps - 1.0f), 0.0f), side - taps);
}

// Between four texels, the place (u, v) of 0..1 from the first on.
SHARED_FUNCTION float left_mix(float a, float b, float c, float d, float u, float v)
{
    float above = a + u * (b - a), below = c + u * (d - c);
    return above + v * (below - above);
}

// What the mean number of fibres before a point, >= 0, leaves.
SHARED_FUNCTION float left_of_fibres(float fibres) { return SHARED_EXP2(-FLOAT(LOG2E) * fibres); }

// --- Approximated: fibres stand at even distances behind the first, each letting the same share
// through; LEFT_TAPS x LEFT_TAPS texels with the weights of a cone.
#define LEFT_TAPS 5

// The fibres before a depth (no hair lies beyond 1.01), of a texel's first depth; `fibres` in all.
SHARED_FUNCTION float left_fibres(float depth, float first, float fibres)
{
    float behind = SHARED_MIN(depth, 1.01f) - first;
    return behind > 1e-4f && first < 1.0f ? SHARED_MAX(behind * fibres, 1.0f) : 0.0f;
}

// The weight of a texel whose middle is so far off (texels).
SHARED_FUNCTION float left_cone(float x, float y)
{
    return SHARED_MAX(3.0f - SHARED_SQRT(x * x + y * y), 0.0f);
}

// --- The mesh: the share of a square of taps - 1 texels around the point that it does not stand
// before. Texels at the square's edge count by how much of them is inside, so that the share
// changes evenly as the point moves. At the map's edges nothing stands.

// How much of texel i of `taps` is inside along one axis; `share`: of the way to the next texel.
SHARED_FUNCTION float left_inside(int i, int taps, float share)
{
    return i == 0 ? 1.0f - share : i == taps - 1 ? share : 1.0f;
}

// What a texel adds whose depth is `gap`; the point's own is moved towards the light.
SHARED_FUNCTION float left_lit(float gap, float depth, float inside)
{
    return gap < depth ? 0.0f : inside;
}
