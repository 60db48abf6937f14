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

// --- Wide lights. A point looks along LEFT_RAYS rays to parts of the light, each with the place in
// the map moved by up to half a texel, so that their mean is continuous. Rays leave the point's own
// column the farther the nearer they come to the light. Hair: the depths between the first fibre
// and the point are cut into LEFT_SLABS slabs; in each a ray adds the fibres of the column in which
// its middle lies. Mesh: rays look, in LEFT_STEPS steps that get longer away from the point, which
// surfaces stand before them. The mean depth of these says how far the rays are apart there; each
// ray then is blocked or not, in LEFT_TURNS turns.
#define LEFT_RAYS     8
#define LEFT_SLABS    4
#define LEFT_STEPS    6
#define LEFT_TURNS    3 // of the rays, by 24 degrees, so that edges of the mesh have no steps
#define LEFT_TURN_COS 0.9135455f
#define LEFT_TURN_SIN 0.4067366f

// The share of the way from the point to the first fibre at the middle of slab i, and from the
// first fibre to the point at its end.
SHARED_FUNCTION float left_slab_middle(int i)
{
    return 1.0f - (FLOAT(i) + 0.5f) * (1.0f / FLOAT(LEFT_SLABS));
}

SHARED_FUNCTION float left_slab_end(int i)
{
    return (FLOAT(i) + 1.0f) * (1.0f / FLOAT(LEFT_SLABS));
}

// The share of the way from the point to the light at the end of step i.
SHARED_FUNCTION float left_step(int i)
{
    float share = (FLOAT(i) + 1.0f) * (1.0f / FLOAT(LEFT_STEPS));
    return share * share;
}

// Whether the mesh stands between the point and the light where step i of a ray ends. `gap`: the
// depth of its surface there, 1 where there is none. `off`: how far the ray goes from the middle of
// the light, over its radius. (A surface aslant that all of the light shines on is not in the way.)
SHARED_FUNCTION bool left_in_way(int i, float gap, float depth, float off)
{
    return gap < 1.0f && gap < depth - off * left_step(i) * depth;
}

// The depth before which a surface blocks light: half-way to the nearest one that any ray met.
SHARED_FUNCTION float left_limit(float depth, float nearest)
{
    return SHARED_MIN(0.5f * (depth + nearest), 1.0f);
}

// The texel, along one axis, of a place in a map of `side` texels.
SHARED_FUNCTION int left_texel(float place, int side)
{
    return INT(SHARED_MIN(SHARED_MAX(place, 0.0f), FLOAT(side) - 1.0f));
}

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
