// SPDX-License-Identifier: MIT
// How skin reflects a light: diffuse light from below the surface, and over it a soft highlight.
// Cosines are of unit vectors.
#include "common/shared_math.h"
#ifdef __STDC__
#pragma once
#endif

// The greatest cosine below the horizon from which light still reaches a point, through the skin.
#define SKIN_WRAP 0.25
// Fresnel's reflectance square to the surface: an index of 1.4. GGX's alpha: a roughness of 0.53,
// of which it is the square.
#define SKIN_REFLECTANCE 0.028
#define SKIN_ALPHA       0.28

// The share of a light square to the surface that a point shows as diffuse light where the light
// comes in at the cosine c: ((c + w) / (1 + w))^(1 + 2 w), 1 for c = 1, whose integral over the
// sphere is that of Lambert's cosine, so that skin is as bright as a matt surface.
SHARED_FUNCTION float skin_diffuse(float c)
{
    float t = SHARED_MAX((c + FLOAT(SKIN_WRAP)) / FLOAT(1.0 + SKIN_WRAP), 0.0f);
    return t * SHARED_SQRT(t); // 1 + 2 w = 1.5
}

// Schlick's approximation; c: of the angle to the half vector.
SHARED_FUNCTION float skin_fresnel(float c)
{
    float away = 1.0f - c, square = away * away;
    return FLOAT(SKIN_REFLECTANCE) + FLOAT(1.0 - SKIN_REFLECTANCE) * square * square * away;
}

// The highlight, in the same unit: pi times GGX's lobe (Walter et al. 2007) with the correlated
// masking of Smith (Heitz 2014), times the cosine of the light. Cosines of the normal with the way
// to the light, to the eye and to the middle of both, and of the latter two.
SHARED_FUNCTION float skin_highlight(float to_light, float to_eye, float to_middle, float half_eye)
{
    float light = SHARED_MIN(SHARED_MAX(to_light, 0.0f), 1.0f),
          eye = SHARED_MIN(SHARED_MAX(to_eye, 1e-3f), 1.0f),
          middle = SHARED_MIN(SHARED_MAX(to_middle, 0.0f), 1.0f),
          square = FLOAT(SKIN_ALPHA * SKIN_ALPHA),
          spread = middle * middle * (square - 1.0f) + 1.0f,
          lobe = square / (spread * spread), // times 1 / pi, which the unit takes away
        masking = 0.5f / (light * SHARED_SQRT(eye * eye * (1.0f - square) + square) +
                          eye * SHARED_SQRT(light * light * (1.0f - square) + square));
    return light * lobe * masking * skin_fresnel(SHARED_MIN(SHARED_MAX(half_eye, 0.0f), 1.0f));
}
