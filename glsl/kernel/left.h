// SPDX-License-Identifier: MIT
// The share of a light that reaches a point past hair and mesh: how the texels of both shadow maps
// are sampled. For shaders and for vectorised C.
#ifdef __STDC__
#pragma once
#endif
#include "kernel/caster.h"

// The place, along one axis, of the first of the `taps` texels that a point samples, in a map of
// `side` texels.
SHARED_FUNCTION float left_from(float place, float side, float taps)
{
    return SHARED_MIN(SHARED_MAX(place - 0.5f * (taps - 1.0f), 0.0f), side - taps);
}

// Bilinear interpolation between four texels at (u, v), 0..1 from the first.
SHARED_FUNCTION float left_mix(float a, float b, float c, float d, float u, float v)
{
    float above = a + u * (b - a), below = c + u * (d - c);
    return above + v * (below - above);
}

// The transmittance of the mean number of fibres in front of a point (>= 0).
SHARED_FUNCTION float left_of_fibres(float fibres) { return SHARED_EXP2(-FLOAT(LOG2E) * fibres); }

// --- Approximated maps. Behind the first fibre, fibres stand at equal distances; each lets the
// same share through. A point samples LEFT_TAPS x LEFT_TAPS texels with the weights of a cone.
#define LEFT_TAPS 5

// The number of fibres in front of a depth, from a texel's first depth. No hair lies beyond 1.01.
// `fibres`: fibres in the whole depth range.
SHARED_FUNCTION float left_fibres(float depth, float first, float fibres)
{
    float behind = SHARED_MIN(depth, 1.01f) - first;
    return behind > 1e-4f && first < 1.0f ? SHARED_MAX(behind * fibres, 1.0f) : 0.0f;
}

// The weight of a texel whose centre is this far away (texels).
SHARED_FUNCTION float left_cone(float x, float y)
{
    return SHARED_MAX(3.0f - SHARED_SQRT(x * x + y * y), 0.0f);
}

// --- The mesh: the share of a square of taps - 1 texels around the point that the mesh does not
// shadow. A texel at the square's edge is weighted by its part inside, so the share changes
// continuously as the point moves. At the edges of the map there is no mesh.

// The part of texel i of `taps` that is inside along one axis; `share`: the point's fraction of the
// way to the next texel.
SHARED_FUNCTION float left_inside(int i, int taps, float share)
{
    return i == 0 ? 1.0f - share : i == taps - 1 ? share : 1.0f;
}

// The contribution of a texel with the depth `gap`. `depth`: the point's own depth, with its bias
// towards the light.
SHARED_FUNCTION float left_lit(float gap, float depth, float inside)
{
    return gap < depth ? 0.0f : inside;
}
