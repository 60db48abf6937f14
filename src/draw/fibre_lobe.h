// SPDX-License-Identifier: MIT
// One lobe of a fibre, for loops over lanes.
#pragma once

#include "base/simd.h"

#include "glsl/common/shared_math.h"

// acos(x) / pi within 2e-5 (Abramowitz and Stegun 4.4.45).
SIMD_INLINE float fibre_turn(float x)
{
    float a = fabsf(x), root = sqrtf(simd_positive(1 - a)) *
                               (1.5707288f + a * (-0.2121144f + a * (0.0742610f - 0.0187293f * a)));
    return (x < 0 ? (float)PI - root : root) * (float)(1 / PI);
}

// exp(-x) I0(x) for x >= 0, as in shade_marschner.glsl.
SIMD_INLINE float fibre_bessel_i0_scaled(float x)
{
    float square = x * x;
    return (0.5f + 0.5f * simd_exp2(simd_max(-2 * (float)LOG2E * x, -60))) /
           sqrtf(sqrtf(1 + 0.25f * square)) * (1 + 0.24273f * square) / (1 + 0.43023f * square);
}

// d'Eon et al.'s lobe (2011) of the variance v about the cone that mirrors theta_i; `sine` and
// `cosine` are those of the tilted theta_r (see shade_marschner.glsl).
SIMD_INLINE float fibre_lobe(float v, float sin_i, float cos_i, float sine, float cosine)
{
    float sharpness = 1 / v,
          scale = sharpness / (1 - simd_exp2(simd_max(-2 * (float)LOG2E * sharpness, -60)));
    float c = fabsf(cos_i * cosine), power = (float)LOG2E * (c - sin_i * sine - 1) * sharpness;
    return scale * simd_exp2(simd_max(simd_min(power, 0), -60)) *
           fibre_bessel_i0_scaled(c * sharpness);
}
