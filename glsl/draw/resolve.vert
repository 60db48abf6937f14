// SPDX-License-Identifier: MIT
// The hair's box on the screen as a strip of two triangles, extended to whole pixels of SAMPLES.
#include "draw/draw.h"

layout(binding = BIND_EXTENT) uniform isamplerBuffer extent; // x, y lowest, highest, px

void main()
{
    ivec2 corner = ivec2(gl_VertexID & 1, gl_VertexID >> 1) * 2;
    bool empty = texelFetch(extent, 0).x > texelFetch(extent, 2).x;
    vec2 px = vec2(texelFetch(extent, corner.x).x, texelFetch(extent, corner.y + 1).x);
    vec2 pixels = px / float(SAMPLES);
    px = float(SAMPLES) * vec2(corner.x == 0 ? floor(pixels.x) : ceil(pixels.x),
                               corner.y == 0 ? floor(pixels.y) : ceil(pixels.y));
    vec2 size = vec2(draw_params.width, draw_params.height);
    gl_Position = vec4(clamp(empty ? vec2(0.0) : px, vec2(0.0), size) / size * 2.0 - 1.0, 0.0, 1.0);
}
