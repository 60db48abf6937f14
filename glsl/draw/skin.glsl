// SPDX-License-Identifier: MIT
// What a surface of skin makes of a light (needs shared_math.h): diffuse light that comes from
// below the surface, and over it a soft highlight.

// The greatest cosine below the horizon from which light still reaches a point, through the skin.
const float SKIN_WRAP = 0.25;
// Fresnel's reflectance square to the surface: an index of 1.4. GGX's alpha: a
// roughness of 0.53, of which it is the square.
const float SKIN_REFLECTANCE = 0.028;
const float SKIN_ALPHA = 0.28;

// The share of a light square to the surface that a point shows as diffuse light where the light
// comes in at this cosine: ((c + w) / (1 + w))^(1 + 2 w), 1 for c = 1, whose integral over the
// sphere is that of Lambert's cosine, so that skin is as bright as a matt surface.
float skin_diffuse(float c)
{
    float t = max((c + SKIN_WRAP) / (1.0 + SKIN_WRAP), 0.0);
    return t * sqrt(t); // 1 + 2 w = 1.5
}

// Schlick's approximation; c: of the angle to the half vector.
float skin_fresnel(float c)
{
    float away = 1.0 - c, square = away * away;
    return SKIN_REFLECTANCE + (1.0 - SKIN_REFLECTANCE) * square * square * away;
}

// The highlight, in the same unit: pi times GGX's lobe (Walter et al. 2007) with the correlated
// masking of Smith (Heitz 2014), times the cosine of the light.
float skin_highlight(vec3 n, vec3 to_light, vec3 to_eye)
{
    vec3 middle = to_light + to_eye;
    middle *= inversesqrt(max(dot(middle, middle), 1e-12));
    float light = clamp(dot(n, to_light), 0.0, 1.0), eye = clamp(dot(n, to_eye), 1e-3, 1.0),
          half_cos = clamp(dot(n, middle), 0.0, 1.0), square = SKIN_ALPHA * SKIN_ALPHA,
          spread = half_cos * half_cos * (square - 1.0) + 1.0,
          lobe = square / (spread * spread), // times 1 / pi, which the unit takes away
        masking = 0.5 / (light * sqrt(eye * eye * (1.0 - square) + square) +
                         eye * sqrt(light * light * (1.0 - square) + square));
    return light * lobe * masking * skin_fresnel(clamp(dot(to_eye, middle), 0.0, 1.0));
}
