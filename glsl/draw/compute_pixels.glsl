// SPDX-License-Identifier: MIT
// The light behind the hair, and the conversion from light to the picture's colours, as in
// src/lanes/pixels.c (needs draw.h, kernel/edge.h).
//   BASE 1: there is a mesh or a floor
//   SAMPLES: a pixel here is one of SAMPLES x SAMPLES samples, whose mean the picture has
//   KIND 0: 8 bits a channel are stored   1: 16   2: floats
//   TONE: see display.glsl
#include "draw/display.glsl"

layout(location = 2) uniform ivec4 base_box; // px: first column and row, end column and row
#if BASE
layout(binding = BIND_BASE) uniform sampler2D base;
layout(binding = BIND_MESH_DEPTH) uniform sampler2D mesh_depth;
#endif
#if KIND == 0
layout(binding = IMAGE_PICTURE, rgba8) writeonly uniform image2D picture;
const float LEVELS = 255.0;
#elif KIND == 1
layout(binding = IMAGE_PICTURE, rgba16) writeonly uniform image2D picture;
const float LEVELS = 65535.0;
#else
layout(binding = IMAGE_PICTURE, rgba32f) writeonly uniform image2D picture;
#endif

bool is_in_base(ivec2 p)
{
    return all(greaterThanEqual(p, base_box.xy)) && all(lessThan(p, base_box.zw));
}

vec4 light_behind(ivec2 p)
{
    vec4 light = draw_params.background;
#if BASE
    if (is_in_base(p)) light = texelFetch(base, p, 0);
#endif
    return light;
}

// The inverse distance of the mesh; 0 without mesh.
float inverse_distance_behind(ivec2 p)
{
    float z = EDGE_NOWHERE;
#if BASE
    if (is_in_base(p)) z = texelFetch(mesh_depth, p, 0).x;
#endif
    return edge_inverse_w(z, draw_params.depth.x, draw_params.depth.y);
}

// Rounds to levels here, because drivers may round differently.
void store(ivec2 p, vec4 light)
{
#if KIND < 2
    light = displayed(light);
    light = floor(clamp(light, 0.0, 1.0) * LEVELS + 0.5) * (1.0 / LEVELS);
#endif
    imageStore(picture, p, light);
}
