// SPDX-License-Identifier: MIT
// Writes the pixels of tiles without ribbons, one for each lane: they show what lies behind the
// hair.
//   DEPTH 1: they show the mesh's distance instead; needs SAMPLES 1
//   BASE, SAMPLES, KIND, TONE: see compute_pixels.glsl
#include "draw/draw.h"
#include "kernel/edge.h"
#include "draw/compute_pixels.glsl"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(location = 0) uniform int columns; // columns of tiles
layout(location = 1) uniform ivec3 rows;  // px: the picture's width; the band's first row; its end
layout(std430, binding = BIND_TILE_COUNTS_OUT) readonly buffer Counts { uint counts[]; };

void main()
{
    int pixel = lane_index();
    ivec2 p = ivec2(pixel % rows.x, rows.y + pixel / rows.x), tile = p * SAMPLES / TILE_SIDE;
    if (p.y >= rows.z || counts[tile.y * columns + tile.x] != 0u) return;
    vec4 sum = vec4(0.0);
    for (int k = 0; k < SAMPLES * SAMPLES; ++k)
        sum += light_behind(p * SAMPLES + ivec2(k % SAMPLES, k / SAMPLES));
#if DEPTH
    sum = vec4(vec3(depth_shown(inverse_distance_behind(p))), 1.0);
#endif
    store(p, sum * (1.0 / float(SAMPLES * SAMPLES)));
}
