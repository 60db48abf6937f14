// SPDX-License-Identifier: MIT
// A matt plane, lit as the mesh is, that fades away from its middle (needs lights.glsl,
// shadow_surface.glsl, sky.glsl).
//   FLOOR 1: it is seen   2: only the light that it lacks where there is shadow: black that covers
//       so much
#include "draw/floor.glsl"

layout(location = 2) uniform vec3 floor_color; // linear RGB

const vec3 FLOOR_UP = vec3(0.0, 1.0, 0.0);

float luminance(vec3 light) { return dot(light, vec3(0.2126, 0.7152, 0.0722)); }

// How much of the floor is left at x.
float floor_there(vec3 x)
{
    return 1.0 - smoothstep(floor_reach.x, floor_reach.y, length(x.xz - floor_middle.xz));
}

// Linear, premultiplied.
vec4 floor_shown(vec3 x, float there)
{
    vec3 around = sky_reaching(FLOOR_UP), light = around, sent = around;
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
    return vec4(vec3(0.0), there * (1.0 - luminance(light) / max(luminance(sent), 1e-6)));
#else
    return there * vec4(floor_color * light, 1.0);
#endif
}
