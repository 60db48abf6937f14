// SPDX-License-Identifier: MIT
// From light to what a screen is given, linear RGB to sRGB.
//   TONE 0: as it is, cut at white   1: reinhard   2: filmic
//   3: light stays light
#include "draw/srgb.glsl"

vec3 display_from_linear(vec3 c)
{
#if TONE == 1
    // Reinhard et al. 2002, equation 4, for each channel: light of 4 becomes white.
    c = max(c, 0.0);
    c = c * (1.0 + c / 16.0) / (1.0 + c);
#elif TONE == 2
    // K. Narkowicz's fit (2015) of the Academy's filmic curve.
    c = max(c, 0.0);
    c = c * (2.51 * c + 0.03) / (c * (2.43 * c + 0.59) + 0.14);
#endif
#if TONE == 3
    return c;
#else
    return srgb_from_linear(c);
#endif
}

// What --aov depth shows of a ribbon at the inverse distance `near`, 0: of nothing (needs draw.h).
float depth_shown(float near)
{
    float distance = 1.0 / max(near, 1e-20);
    vec2 range = draw_params.depth_range.xy;
    float share = range.y > range.x ? clamp((range.y - distance) / (range.y - range.x), 0.0, 1.0) : distance;
    return near > 0.0 ? share : 0.0;
}
