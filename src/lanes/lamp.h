// SPDX-License-Identifier: MIT
// The light of a lamp at 16 points of hair, mesh or floor.
#pragma once

#include "base/simd.h"

#include "glsl/draw/draw.h"
#include "glsl/kernel/lamp.h"

enum { LAMP_POINTS = STRAND_TILE };

// Light i at points x (m): the unit vectors towards the light, and the share of its colour that a
// surface which faces the light receives, without shadows.
SIMD_INLINE void lamp_find(const DrawParams *draw, int i, const float x[3][LAMP_POINTS],
                           float way[3][LAMP_POINTS], float share[LAMP_POINTS])
{
    const float *place = draw->light_place[i], *axis = draw->light_axis[i],
                *cone = draw->light_cone[i];
    for (int k = 0; k < LAMP_POINTS; ++k) {
        float p = place[0] - place[3] * x[0][k], q = place[1] - place[3] * x[1][k],
              r = place[2] - place[3] * x[2][k],
              square = simd_max(p * p + q * q + r * r, LAMP_NEAREST), inverse = 1 / sqrtf(square);
        p *= inverse, q *= inverse, r *= inverse;
        way[0][k] = p, way[1][k] = q, way[2][k] = r;
        share[k] = lamp_share(place[3], square, axis[3], cone[0], cone[1],
                              axis[0] * p + axis[1] * q + axis[2] * r);
    }
}
