// SPDX-License-Identifier: MIT
// The hair's ribbons: two vertices for each particle, shared by the segments that meet there;
// hair_project.comp has computed them. No division by w is left, because all values are linear on
// the screen, and because Mesa's clipping loses parts of triangles that leave the picture at a
// corner if their w differ.
#include "draw/draw.h"

// px: middle; as halves: half of the vector across, distances from both ends.
layout(binding = BIND_EDGES) uniform usamplerBuffer edges;
// 1/w, half-width, four halves: linear RGB, opacity.
layout(binding = BIND_SHADES) uniform usamplerBuffer shades;

noperspective out float across;     // px from the ribbon's middle, signed
noperspective out float half_width; // px
noperspective out vec2 ends;        // px: distances from the strand's ends, negative beyond them
noperspective out vec4 color;       // linear RGB, opacity
noperspective out float inverse_w;

const float PAD = 0.71; // as in hair_project.comp
const vec4 OUTSIDE = vec4(0.0, 0.0, -1e6, 1.0);

void main()
{
    float side = float((gl_VertexID & 1) * 2 - 1);
    uvec4 edge = texelFetch(edges, gl_VertexID >> 1);
    uvec4 shade = texelFetch(shades, gl_VertexID >> 1);
    half_width = uintBitsToFloat(shade.y);
    across = side * (half_width + PAD);
    inverse_w = uintBitsToFloat(shade.x);
    vec2 px = uintBitsToFloat(edge.xy) + side * unpackHalf2x16(edge.z);
    vec2 corner = px * (2.0 / vec2(draw_params.width, draw_params.height)) - 1.0;
    ends = unpackHalf2x16(edge.w);
    gl_Position = shade.x == 0u
                      ? OUTSIDE
                      : vec4(corner, draw_params.depth.x + draw_params.depth.y * inverse_w, 1.0);
    color = vec4(unpackHalf2x16(shade.z), unpackHalf2x16(shade.w));
}
