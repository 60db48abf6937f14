// SPDX-License-Identifier: MIT
// The floor: a horizontal plane that fades out away from its middle.
#include "common/shared_math.h"
#ifdef __STDC__
#pragma once
#endif

// The opacity of the floor at a distance from its middle (m): 1 up to `whole`, 0 from `faded` on.
SHARED_FUNCTION float floor_there(float distance, float whole, float faded)
{
    float t = SHARED_MIN(SHARED_MAX((distance - whole) / (faded - whole), 0.0f), 1.0f);
    return 1.0f - t * t * (3.0f - 2.0f * t);
}

// The distance up to which the floor hides hair: where its opacity is one half.
SHARED_FUNCTION float floor_hides(float whole, float faded) { return 0.5f * (whole + faded); }

SHARED_FUNCTION float floor_luminance(float red, float green, float blue)
{
    return 0.2126f * red + 0.7152f * green + 0.0722f * blue;
}

// The opacity of black that darkens as much as the shadow does, from the luminance of the light
// that arrives and of the light that would arrive without occluders.
SHARED_FUNCTION float floor_shadow(float light, float sent)
{
    return 1.0f - light / SHARED_MAX(sent, 1e-6f);
}
