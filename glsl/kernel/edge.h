// SPDX-License-Identifier: MIT
// Depths 0 .. 1 of samples at edges of the mesh. EDGE_NOWHERE: the sample shows no mesh.
//
// Only the middles of pixels are lit. A sample whose depth differs from that of its pixel's middle
// lies at an edge. It takes the colour of the lit middle that is nearest to it in depth, of the
// nine around it.
//
// The stored depth hides hair. At an edge it is the farthest of the pixel's samples: where
// background, or something farther, shows between the samples, hair before it must cover it. (The
// nearest depth, or that of the middle, would leave a fringe of background between a silhouette and
// the hair behind it.)
#include "common/shared_math.h"
#ifdef __STDC__
#pragma once
#include <stdbool.h>
#endif

#define EDGE_NOWHERE 1.0f
// px of depth that neighbouring samples of one surface may differ by before they are looked at
// closely
#define EDGE_STEEP 4.0f

// The depth at a distance w before the eye's plane; clip z = x w + y.
SHARED_FUNCTION float edge_depth_at(float x, float y, float w) { return 0.5f + 0.5f * (x + y / w); }

// 1/w of a depth; 0 of EDGE_NOWHERE.
SHARED_FUNCTION float edge_inverse_w(float z, float x, float y)
{
    return z < EDGE_NOWHERE ? (2.0f * z - 1.0f - x) / y : 0.0f;
}

// What steps of EDGE_STEEP px away from the eye change of a depth; focal: px of a metre at a
// distance of one.
SHARED_FUNCTION float edge_steep(float z, float x, float focal)
{
    float step = 0.5f * (2.0f * z - 1.0f - x);
    return EDGE_STEEP * (step < 0.0f ? -step : step) / focal;
}

// Whether a sample is on another surface than the middle, as far as depths tell.
SHARED_FUNCTION bool edge_parts(float z, float middle, float steep)
{
    float off = z < middle ? middle - z : z - middle;
    return off > (z < EDGE_NOWHERE && middle < EDGE_NOWHERE ? steep : 0.0f);
}

// How far a sample is from what its own middle shows; other middles must be nearer.
SHARED_FUNCTION float edge_off(float z, float middle)
{
    float off = z < middle ? middle - z : z - middle;
    return z < EDGE_NOWHERE ? (middle < EDGE_NOWHERE ? off : EDGE_NOWHERE) : 0.0f;
}
