// SPDX-License-Identifier: MIT
// Light at a point of a surface: from a lamp, from a directional light, and from everywhere. Each
// function takes one channel or all.
#include "common/shared_math.h"
#ifdef __STDC__
#pragma once
#endif

#define LAMP_NEAREST 1e-12f // m2: squares of distances are at least so large

// The share of a light's colour that a surface square to it is given. `far`: 0 for a sun, which has
// no distance; 1: `square` is its distance's (m2), `reference` that of the distance where the
// light has its intensity; a cap keeps the share finite. The cone's edge as glTF's
// KHR_lights_punctual has it: cone_from - cone_by * cosine, of the spot's axis and the way to the
// light, cut to 0 .. 1.
SHARED_FUNCTION float lamp_share(float far, float square, float reference, float cone_from,
                                 float cone_by, float cosine)
{
    float inside = SHARED_MIN(SHARED_MAX(cone_from - cone_by * cosine, 0.0f), 1.0f),
          falloff = far * SHARED_MIN(reference / square, 1e6f) + (1.0f - far);
    return falloff * inside * inside;
}

// The mean light from everywhere, `sky` above and `ground` below, on a surface whose unit normal
// has this y.
SHARED_FUNCTION float lamp_around(float sky, float ground, float up)
{
    return ground + (0.5f + 0.5f * up) * (sky - ground);
}

// What a surface of a colour shows of the light from everywhere, over what it would if it were
// white and open, where it sees the share `open` of the sky, the rest of it being of about the same
// colour and as bright: what that reflects comes in, too.
SHARED_FUNCTION float lamp_around_into(float open, float color)
{
    return open / (1.0f - color * (1.0f - open));
}
