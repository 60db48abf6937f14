// SPDX-License-Identifier: MIT
// The hair's ribbons: two vertices a particle, shared by the segments that meet there, as
// hair_project.comp has found them.
#include "draw.h"

layout(binding = BIND_EDGES) uniform samplerBuffer edges;   // middle, half of the way across, clip space / w
layout(binding = BIND_SHADES) uniform usamplerBuffer shades; // 1/w, half-width, four halves: linear RGB, opacity

noperspective out float across;     // px from the ribbon's middle, signed
noperspective out float half_width; // px
noperspective out vec4 color;       // linear RGB, opacity

const float PAD = 0.71; // as in hair_project.comp
const vec4 OUTSIDE = vec4(0.0, 0.0, -1e6, 1.0);

void main()
{
    float side = float((gl_VertexID & 1) * 2 - 1);
    vec4 edge = texelFetch(edges, gl_VertexID >> 1);
    uvec4 shade = texelFetch(shades, gl_VertexID >> 1);
    half_width = uintBitsToFloat(shade.y);
    across = side * (half_width + PAD);
    float w = 1.0 / uintBitsToFloat(shade.x);
    vec2 middle = edge.xy + side * edge.zw;
    gl_Position = shade.x == 0u ? OUTSIDE : vec4(middle * w, draw_params.depth.x * w + draw_params.depth.y, w);
    color = vec4(unpackHalf2x16(shade.z), unpackHalf2x16(shade.w));
}
