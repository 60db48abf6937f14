// SPDX-License-Identifier: MIT
// The conversion from linear RGB light to sRGB, over the backing if there is one (needs draw.h).
//   TONE 0: clipped at white; has no backing   1: reinhard   2: filmic
//   3: stays linear light
#include "common/shared_math.h"

// `behind`: the backing's colour in this channel, of which `share` is seen.
float display_of(float c, float behind, float share)
{
#if TONE == 1
    return srgb_from_linear(tone_over(tone_reinhard(c), behind, share));
#elif TONE == 2
    return srgb_from_linear(tone_over(tone_filmic(c), behind, share));
#elif TONE == 3
    return c;
#else
    return srgb_from_linear(c);
#endif
}

// `light`: premultiplied. Returns the colour with straight alpha.
vec4 displayed(vec4 light)
{
    vec4 backing = draw_params.backing;
    vec3 c = light.rgb * (1.0 / max(light.a, 1e-6));
    float share = backing.a * (1.0 - light.a);
    return vec4(display_of(c.r, backing.r, share), display_of(c.g, backing.g, share),
                display_of(c.b, backing.b, share), light.a + share);
}

// The value that --aov depth shows for the inverse distance `near`; 0 if there is nothing.
float depth_shown(float near)
{
    float distance = 1.0 / max(near, 1e-20);
    vec2 range = draw_params.depth_range.xy;
    float share =
        range.y > range.x ? clamp((range.y - distance) / (range.y - range.x), 0.0, 1.0) : distance;
    return near > 0.0 ? share : 0.0;
}
