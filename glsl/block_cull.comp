// SPDX-License-Identifier: MIT
// Lists the strands that may be in the picture, before anything is projected or shaded. A strand is left out if all
// of it lies beyond one of the picture's four sides, or before the near plane: between two of its particles
// it does, too, since the sides are planes in clip space. Their order in the list is left to chance: a strand's ribbons
// have places of their own.
#include "draw.h"
#include "material.h"
#include "hair_address.glsl"

layout(local_size_x = GROUP_SIZE) in;
layout(binding = BIND_POSITION) uniform samplerBuffer position;
layout(std430, binding = BIND_LISTED_OUT) buffer Listed { uint listed[]; }; // how many, then rows

// Beyond its middle line a ribbon reaches by its half-width and a pixel, times what a joint may have; off the
// picture's middle a cylinder's outline is wider than its radius (outline_half_width).
const float MITRE = 3.5, PIXEL = 1.5;

void main()
{
    int n = int(material.vertex_count), row = int(gl_GlobalInvocationID.x), s = int(material.first_strand) + row;
    if (row >= int(material.drawn_strands)) return;
    mat4 clip_from_world = draw_params.clip_from_world;
    vec2 size = vec2(draw_params.width, draw_params.height);
    float focal = draw_params.focal, near_distance = draw_params.near_distance;
    vec2 pad = 1.0 + 2.0 * MITRE * PIXEL / size;
    vec2 wide = 2.0 * MITRE * focal * material.radius * sqrt(1.0 + dot(size, size) / (focal * focal)) / size;
    int at = particle_address(s, 0, n), j = 0;
    vec4 least = vec4(1e30); // distance beyond: left, top, right, bottom
    float farthest = -1e30;
    do {
        vec4 clip = clip_from_world * vec4(texelFetch(position, at).xyz, 1.0);
        vec2 side = pad * clip.w + wide;
        least = min(least, vec4(-clip.xy - side, clip.xy - side));
        farthest = max(farthest, clip.w);
        at += STRAND_TILE;
    } while (++j < n);
    bool out_of_sight = any(greaterThan(least, vec4(0.0))) || farthest < near_distance;
    if (!out_of_sight) listed[1u + atomicAdd(listed[0], 1u)] = uint(row);
}
