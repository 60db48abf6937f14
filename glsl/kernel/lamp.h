// SPDX-License-Identifier: MIT
// The light at a point of a surface: from a lamp, from a directional light, and ambient light. Each
// function takes one channel or all.
#include "common/shared_math.h"
#ifdef __STDC__
#pragma once
#endif

#define LAMP_NEAREST 1e-12f // m2: lower limit of squared distances

// The share of a light's colour that a surface perpendicular to it receives. `far`: 0 for a
// directional light, 1 for a lamp. `square` is the squared distance to the lamp (m2), `reference`
// the squared distance at which it has its intensity; the share is capped. The edge of a spot's
// cone is as in glTF's KHR_lights_punctual: cone_from - cone_by * cosine, clamped to 0 .. 1, where
// `cosine` is between the spot's axis and the direction to the light.
SHARED_FUNCTION float lamp_share(float far, float square, float reference, float cone_from,
                                 float cone_by, float cosine)
{
    float inside = SHARED_MIN(SHARED_MAX(cone_from - cone_by * cosine, 0.0f), 1.0f),
          falloff = far * SHARED_MIN(reference / square, 1e6f) + (1.0f - far);
    return falloff * inside * inside;
}

// The mean ambient light, from `sky` above to `ground` below, on a surface whose unit normal has
// this y.
SHARED_FUNCTION float lamp_around(float sky, float ground, float up)
{
    return ground + (0.5f + 0.5f * up) * (sky - ground);
}

// What an environment adds to the light between its sky and ground, which are its terms of 1 and y:
// the terms of x, z, xy, yz, zx, x^2 - z^2 and 3 y^2 - 1 of the unit normal. First x and z.
SHARED_FUNCTION float lamp_aside(float by_x, float by_z, float x, float z)
{
    return by_x * x + by_z * z;
}

// The others.
SHARED_FUNCTION float lamp_bent(float xy, float yz, float zx, float level, float upright, float x,
                                float y, float z)
{
    return xy * (x * y) + yz * (y * z) + zx * (z * x) + level * (x * x - z * z) +
           upright * (3.0f * y * y - 1.0f);
}

// The factor by which light on a surface of this colour grows because surfaces like it, which hide
// all but the share `open` of its view and have its colour and brightness, reflect light on it. At
// most 100: white surfaces that hide everything from each other would keep their light for ever.
SHARED_FUNCTION float lamp_between(float open, float color)
{
    return 1.0f / SHARED_MAX(1.0f - color * (1.0f - open), 0.01f);
}
