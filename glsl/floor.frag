// SPDX-License-Identifier: MIT
// A matt plane, lit as the mesh is, that fades away from its middle.
//   CATCHER 1: it is not seen, but the light that it lacks where there is shadow: black that covers so much
#include "draw.h"
#include "floor.glsl"
#define MESH_TAPS 6 // as soft as shadows of hair, whose maps are coarser
#include "lights.glsl"

layout(location = 2) uniform vec3 floor_color; // linear RGB
in vec3 world_position;
layout(location = 0) out vec4 color; // linear, premultiplied

const vec3 UP = vec3(0.0, 1.0, 0.0);

float luminance(vec3 light)
{
    return dot(light, vec3(0.2126, 0.7152, 0.0722));
}

void main()
{
    vec3 x = world_position, around = draw_params.mesh_color.a * light_around(UP, 1.0), light = around, sent = around;
#if SHADOW
    shadow_find(x);
#endif
    for (int i = 0; i < draw_params.light_count; ++i) {
        vec3 to_light, all_light = light_sent(i, x, to_light);
        all_light *= max(to_light.y, 0.0);
        sent += all_light;
        light += all_light * light_left(i);
    }
    float there = 1.0 - smoothstep(floor_reach.x, floor_reach.y, length(x.xz - floor_middle.xz));
#if CATCHER
    color = vec4(vec3(0.0), there * (1.0 - luminance(light) / max(luminance(sent), 1e-6)));
#else
    color = there * vec4(floor_color * light, 1.0);
#endif
}
