// SPDX-License-Identifier: MIT
// How skin reflects light: diffuse light from below the surface, and a soft highlight on top.
// Cosines are between unit vectors.
#include "common/shared_math.h"
#ifdef __STDC__
#pragma once
#endif

// Light reaches a point through the skin up to this cosine below the horizon.
#define SKIN_WRAP 0.25
// Fresnel's reflectance at perpendicular incidence, for an index of 1.4. GGX's alpha, which is the
// square of the roughness 0.53.
#define SKIN_REFLECTANCE 0.028
#define SKIN_ALPHA       0.28

// The share of perpendicular light that a point shows as diffuse light if light arrives at the
// cosine c: ((c + w) / (1 + w))^(1 + 2 w), which is 1 for c = 1. Its integral over the sphere
// equals that of Lambert's cosine, so skin is as bright as a matt surface.
SHARED_FUNCTION float skin_diffuse(float c)
{
    float t = SHARED_MAX((c + FLOAT(SKIN_WRAP)) / FLOAT(1.0 + SKIN_WRAP), 0.0f);
    return t * SHARED_SQRT(t); // 1 + 2 w = 1.5
}

// Schlick's approximation; c: the cosine to the half vector.
SHARED_FUNCTION float skin_fresnel(float c)
{
    float away = 1.0f - c, square = away * away;
    return FLOAT(SKIN_REFLECTANCE) + FLOAT(1.0 - SKIN_REFLECTANCE) * square * square * away;
}

// The highlight in the same unit: pi times GGX's lobe (Walter et al. 2007) with the correlated
// Smith masking (Heitz 2014), times the cosine of the light. to_light, to_eye, to_middle: cosines
// of the normal with the light, the eye and the half vector; half_eye: of the half vector with the
// eye.
SHARED_FUNCTION float skin_highlight(float to_light, float to_eye, float to_middle, float half_eye)
{
    float light = SHARED_MIN(SHARED_MAX(to_light, 0.0f), 1.0f),
          eye = SHARED_MIN(SHARED_MAX(to_eye, 1e-3f), 1.0f),
          middle = SHARED_MIN(SHARED_MAX(to_middle, 0.0f), 1.0f),
          square = FLOAT(SKIN_ALPHA * SKIN_ALPHA),
          spread = middle * middle * (square - 1.0f) + 1.0f,
          lobe = square / (spread * spread), // the factor 1 / pi cancels with pi
        masking = 0.5f / (light * SHARED_SQRT(eye * eye * (1.0f - square) + square) +
                          eye * SHARED_SQRT(light * light * (1.0f - square) + square));
    return light * lobe * masking * skin_fresnel(SHARED_MIN(SHARED_MAX(half_eye, 0.0f), 1.0f));
}
