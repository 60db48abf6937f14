// SPDX-License-Identifier: MIT
// The floor: a matt plane, lit like the mesh, that fades out away from its middle (needs
// lights.glsl, shadow_surface.glsl).
//   FLOOR 1: the plane is visible   2: only its shadow is visible, as black with an alpha
#include "kernel/floor.h"

layout(location = 0) uniform vec3 floor_middle; // m
layout(location = 1) uniform vec2 floor_reach;  // m: where fading begins and ends
layout(location = 2) uniform vec3 floor_color;  // linear RGB

const vec3 FLOOR_UP = vec3(0.0, 1.0, 0.0);

// Linear, premultiplied colour of the floor.
vec4 floor_shown(vec3 x, float there)
{
    vec3 around = draw_params.mesh_color.a * light_around(FLOOR_UP), light = around, sent = around;
#if SHADOW
    shadow_find_on(x, FLOOR_UP);
#endif
    for (int i = 0; i < light_count; ++i) {
        vec3 to_light, all_light = light_sent(i, x, to_light);
        all_light *= max(to_light.y, 0.0);
        sent += all_light;
        light += all_light * light_left(i);
    }
#if FLOOR == 2
    return vec4(vec3(0.0), there * floor_shadow(floor_luminance(light.r, light.g, light.b),
                                                floor_luminance(sent.r, sent.g, sent.b)));
#else
    return there * vec4(floor_color * light, 1.0);
#endif
}
