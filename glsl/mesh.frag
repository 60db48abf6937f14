// SPDX-License-Identifier: MIT
// Lambert's plain matt surface, in linear light. Surfaces seen from behind are lit as from in front.
#include "draw.h"
#define MESH_TAPS 4 // of its own map, whose texels are seen where light grazes it
#include "lights.glsl"

in vec3 world_position;
in vec3 world_normal;
layout(location = 0) out vec4 color; // linear

void main()
{
    vec3 n = world_normal * inversesqrt(max(dot(world_normal, world_normal), 1e-20));
    if (dot(n, draw_params.eye.xyz - world_position) < 0.0) n = -n;
    vec3 light = draw_params.mesh_color.a * light_around(n, 1.0);
    vec3 x = world_position;
#if SHADOW
    x += shadow_params.mesh_lift * n; // so that the surface does not shadow itself
    shadow_find(x);
#endif
    for (int i = 0; i < draw_params.light_count; ++i) {
        vec3 to_light, reaching = light_reaching(i, x, to_light);
        light += reaching * max(dot(n, to_light), 0.0);
    }
    color = vec4(draw_params.mesh_color.rgb * light, 1.0);
}
