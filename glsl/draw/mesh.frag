// SPDX-License-Identifier: MIT
// Lights the mesh, in linear light, for each pixel whose centre shows it. Surfaces that are seen
// from behind are lit like front faces.
//   SKIN 0: Lambert's matt surface   1: see kernel/skin.h
//   ONTO 1: hair sends light onto the skin
#include "draw/draw.h"
#define MESH_TAPS 4 // of its own shadow map, whose texels would show under grazing light
#include "draw/lights.glsl"
#if SKIN
#include "kernel/skin.h"
#define SHADOW_WRAP SKIN_WRAP
#endif
#include "draw/shadow_surface.glsl"
#include "draw/ray.glsl"
#if ONTO
#include "draw/onto.glsl"
#endif

layout(binding = BIND_SURFACE) uniform sampler2D surface;
layout(binding = BIND_TINT) uniform sampler2D tint;
layout(location = 0) out vec4 color; // linear

// The light that the mesh, of colour `own`, shows at x with the unit normal n, where it sees the
// share `open` of the sky, and the share `bare` without hair.
vec3 light_on(vec3 own, vec3 x, vec3 n, float open, float bare, vec3 to_eye)
{
    vec3 light = draw_params.mesh_color.a * light_around(n) * open, highlight = vec3(0.0);
#if SHADOW
    x += shadow_params.mesh_lift * n; // avoids self-shadowing
    shadow_find_on(x, n);
#endif
#if ONTO
    light += onto_light(x, n);
    open = bare;
#endif
    light *= vec3(lamp_between(open, own.r), lamp_between(open, own.g), lamp_between(open, own.b));
    for (int i = 0; i < light_count; ++i) {
        vec3 to_light, reaching = light_reaching(i, x, to_light);
#if SKIN
        light += reaching * skin_diffuse(dot(n, to_light));
        vec3 middle = to_light + to_eye;
        middle *= inversesqrt(max(dot(middle, middle), 1e-12));
        highlight += reaching * skin_highlight(dot(n, to_light), dot(n, to_eye), dot(n, middle),
                                               dot(to_eye, middle));
#else
        light += reaching * max(dot(n, to_light), 0.0);
#endif
    }
    return own * light + highlight;
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 seen = texelFetch(surface, pixel, 0);
    vec4 tinted = texelFetch(tint, pixel, 0);
    vec3 own = draw_params.mesh_color.rgb * tinted.rgb, way = ray_through(gl_FragCoord.xy),
         n = seen.xyz * inversesqrt(max(dot(seen.xyz, seen.xyz), 1e-20)),
         x = draw_params.eye.xyz + seen.w * way;
#if SKIN
    float open = min(length(seen.xyz), 1.0);
#else
    const float open = 1.0;
#endif
    color = vec4(
        light_on(own, x, dot(n, way) > 0.0 ? -n : n, open, min(tinted.a, 1.0), -normalize(way)),
        1.0);
}
