// SPDX-License-Identifier: MIT
// The conversion from linear RGB light to sRGB.
//   TONE 0: clipped at white   1: reinhard   2: filmic
//   3: stays linear light
#include "common/shared_math.h"

float display_of(float c)
{
#if TONE == 1
    return srgb_from_linear(tone_reinhard(c));
#elif TONE == 2
    return srgb_from_linear(tone_filmic(c));
#elif TONE == 3
    return c;
#else
    return srgb_from_linear(c);
#endif
}

vec3 display_from_linear(vec3 c) { return vec3(display_of(c.r), display_of(c.g), display_of(c.b)); }

// The value that --aov depth shows for the inverse distance `near`; 0 if there is nothing (needs
// draw.h).
float depth_shown(float near)
{
    float distance = 1.0 / max(near, 1e-20);
    vec2 range = draw_params.depth_range.xy;
    float share =
        range.y > range.x ? clamp((range.y - distance) / (range.y - range.x), 0.0, 1.0) : distance;
    return near > 0.0 ? share : 0.0;
}
