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

// --- Wide lights. From each point, LEFT_RAYS rays go to different parts of the light. Each ray's
// start is shifted by up to half a texel, so that the mean over rays is continuous. The nearer a
// ray comes to the light, the farther it is from the point's own column of texels. Hair: the depths
// between the first fibre and the point are divided into LEFT_SLABS slabs; in each slab, a ray
// counts the fibres of the column that contains its middle. The last slab's column is nearer to the
// point, because the fibres there mostly belong to the thin sheet of hair that contains the point.
// From a surface, where the edges of eight shadows would show, LEFT_SPREAD rays go, and they meet
// nothing beyond the map. Mesh: in LEFT_STEPS steps, whose length grows with the distance from the
// point, rays look for surfaces in front of them. The mean depth of these surfaces determines how
// far apart the rays are there; then each ray is tested in LEFT_TURNS rotated positions and is
// either blocked or not.
#define LEFT_RAYS     8
#define LEFT_SPREAD   24
#define LEFT_SLABS    4
#define LEFT_STEPS    6
#define LEFT_TURNS    3 // rotations by 24 degrees, so that shadows of mesh edges have no steps
#define LEFT_TURN_COS 0.9135455f
#define LEFT_TURN_SIN 0.4067366f

// Depths as shares of the distance: where the column of slab i is taken, from the point to the
// first fibre; and the end of slab i, from the first fibre to the point.
SHARED_FUNCTION float left_slab_place(int i)
{
    float middle = i + 1 < LEFT_SLABS ? 0.5f : 0.75f;
    return 1.0f - (FLOAT(i) + middle) * (1.0f / FLOAT(LEFT_SLABS));
}

SHARED_FUNCTION float left_slab_end(int i)
{
    return (FLOAT(i) + 1.0f) * (1.0f / FLOAT(LEFT_SLABS));
}

// The end of step i, as a share of the distance from the point to the light.
SHARED_FUNCTION float left_step(int i)
{
    float share = (FLOAT(i) + 1.0f) * (1.0f / FLOAT(LEFT_STEPS));
    return share * share;
}

// Whether the mesh blocks a ray at the end of its step i. `gap`: the mesh's depth there, 1 if there
// is none. `off`: the distance of the ray's target from the light's middle, relative to the light's
// radius. (A slanted surface that the whole light shines on must not block.)
SHARED_FUNCTION bool left_in_way(int i, float gap, float depth, float off)
{
    return gap < 1.0f && gap < depth - off * left_step(i) * depth;
}

// Surfaces in front of this depth block light: half-way to the nearest surface that any ray found.
SHARED_FUNCTION float left_limit(float depth, float nearest)
{
    return SHARED_MIN(0.5f * (depth + nearest), 1.0f);
}

// 1 for a position in a map of `side` texels, else 0.
SHARED_FUNCTION float left_on_map(float u, float v, float side)
{
    return SHARED_MIN(SHARED_MIN(u, v), SHARED_MIN(side - u, side - v)) >= 0.0f ? 1.0f : 0.0f;
}

// The texel along one axis at a position in a map of `side` texels.
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
