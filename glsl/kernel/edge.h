// SPDX-License-Identifier: MIT
// Depths 0 .. 1 of samples at edges of the mesh. EDGE_NOWHERE: the sample shows no mesh.
//
// Only the centres of pixels are lit. A sample whose depth differs from that of its pixel's centre
// lies at an edge. It takes the colour of one of the nine lit centres around it: the one that is
// nearest to it in depth.
//
// The stored depth hides hair. At an edge it is the farthest depth of the pixel's samples: where
// the background or a farther surface shows between the samples, hair in front of it must cover it.
//
// The samples that show a nearer surface are the pixel's rim: their share of the pixel, their
// light, and the farthest of their depths. Hair behind the rim is visible in the rest of the pixel
// only. So an edge is smooth before hair, too.
#include "common/shared_math.h"
#ifdef __STDC__
#pragma once
#include <stdbool.h>
#endif

#define EDGE_NOWHERE 1.0f
// px: neighbouring samples of one surface may differ in depth by this much without further checks
#define EDGE_STEEP 4.0f

// The depth at a distance w from the eye's plane; clip-space z = x w + y.
SHARED_FUNCTION float edge_depth_at(float x, float y, float w) { return 0.5f + 0.5f * (x + y / w); }

// 1/w of a depth; 0 for EDGE_NOWHERE.
SHARED_FUNCTION float edge_inverse_w(float z, float x, float y)
{
    return z < EDGE_NOWHERE ? (2.0f * z - 1.0f - x) / y : 0.0f;
}

// The change of depth over a step of EDGE_STEEP px away from the eye. focal: px of one metre at a
// distance of one metre.
SHARED_FUNCTION float edge_steep(float z, float x, float focal)
{
    float step = 0.5f * (2.0f * z - 1.0f - x);
    return EDGE_STEEP * (step < 0.0f ? -step : step) / focal;
}

// Whether the depths of a sample and of its pixel's centre belong to different surfaces.
SHARED_FUNCTION bool edge_parts(float z, float middle, float steep)
{
    float off = z < middle ? middle - z : z - middle;
    return off > (z < EDGE_NOWHERE && middle < EDGE_NOWHERE ? steep : 0.0f);
}

// Whether a sample belongs to the rim of its pixel. farthest: depth of the pixel's samples;
// steep: at the sample's depth.
SHARED_FUNCTION bool edge_rims(float z, float farthest, float steep)
{
    return z < farthest && edge_parts(farthest, z, steep);
}

// The distance in depth between a sample and its own pixel's centre. Another centre is used only if
// it is nearer than that.
SHARED_FUNCTION float edge_off(float z, float middle)
{
    float off = z < middle ? middle - z : z - middle;
    return z < EDGE_NOWHERE ? (middle < EDGE_NOWHERE ? off : EDGE_NOWHERE) : 0.0f;
}
