// SPDX-License-Identifier: MIT
// Lambert's plain matt surface, in linear light, for each pixel whose middle shows the mesh.
// Surfaces seen from behind are lit as from in front.
#include "draw/draw.h"
#define MESH_TAPS 4 // of its own map, whose texels are seen where light grazes it
#include "draw/lights.glsl"
#include "draw/shadow_surface.glsl"
#include "draw/ray.glsl"

layout(binding = BIND_SURFACE) uniform sampler2D surface;
layout(location = 0) out vec4 color; // linear

vec3 light_on(vec3 x, vec3 n)
{
    vec3 light = draw_params.mesh_color.a * light_around(n, 1.0);
#if SHADOW
    x += shadow_params.mesh_lift * n; // so that the surface does not shadow itself
    shadow_find_on(x, n);
#endif
    for (int i = 0; i < light_count; ++i) {
        vec3 to_light, reaching = light_reaching(i, x, to_light);
        light += reaching * max(dot(n, to_light), 0.0);
    }
    return light;
}

void main()
{
    vec4 seen = texelFetch(surface, ivec2(gl_FragCoord.xy), 0);
    vec3 way = ray_through(gl_FragCoord.xy),
         n = seen.xyz * inversesqrt(max(dot(seen.xyz, seen.xyz), 1e-20));
    vec3 light = light_on(draw_params.eye.xyz + seen.w * way, dot(n, way) > 0.0 ? -n : n);
    color = vec4(draw_params.mesh_color.rgb * light, 1.0);
}
