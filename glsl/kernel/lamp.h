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

// The light of an environment is a polynomial of the unit normal. Its terms of 1 and y are `sky`
// and `ground` of lamp_around. The next two functions add the other terms: x, z, xy, yz, zx, x^2 -
// z^2 and 3 y^2 - 1. This one has x and z.
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

// The factor by which reflected light brightens a surface of this colour. The surface sees the
// surroundings in the share `open` of its view. In the rest of its view it sees other surfaces,
// which are assumed to have its own colour and brightness. At most 100, because white surfaces that
// hide everything from each other would reflect their light for ever.
SHARED_FUNCTION float lamp_between(float open, float color)
{
    return 1.0f / SHARED_MAX(1.0f - color * (1.0f - open), 0.01f);
}
