// SPDX-License-Identifier: MIT
// The floor: a level plane that fades away from its middle.
#include "common/shared_math.h"
#ifdef __STDC__
#pragma once
#endif

// How much of it is left at a distance from its middle (m): all up to `whole`, nothing from `faded`
// on.
SHARED_FUNCTION float floor_there(float distance, float whole, float faded)
{
    float t = SHARED_MIN(SHARED_MAX((distance - whole) / (faded - whole), 0.0f), 1.0f);
    return 1.0f - t * t * (3.0f - 2.0f * t);
}

// What of a plane hides hair: as far as half of it is there.
SHARED_FUNCTION float floor_hides(float whole, float faded) { return 0.5f * (whole + faded); }

SHARED_FUNCTION float floor_luminance(float red, float green, float blue)
{
    return 0.2126f * red + 0.7152f * green + 0.0722f * blue;
}

// The opacity of black that takes as much away as there is of shadow, by the luminance of the light
// that comes and of what would without anything in its way.
SHARED_FUNCTION float floor_shadow(float light, float sent)
{
    return 1.0f - light / SHARED_MAX(sent, 1e-6f);
}
