// SPDX-License-Identifier: MIT
// Gives each tile with ribbons a place for its list, in an order that is left to chance.
#include "draw/draw.h"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(location = 0) uniform ivec2 tiles; // of the band: the first, the end
layout(std430, binding = BIND_TILE_COUNTS_OUT) readonly buffer Counts { uint counts[]; };
layout(std430, binding = BIND_TILE_ENDS_OUT) writeonly buffer Ends { uint ends[]; };
layout(std430, binding = BIND_TILE_USE_OUT) buffer Use { uint use[TILE_USE_WORDS]; };

void main()
{
    int tile = tiles.x + lane_index();
    if (tile >= tiles.y) return;
    uint count = counts[tile];
    if (count == 0u) return;
    ends[tile] = atomicAdd(use[TILE_USE_PAIRS], count);
    atomicMax(use[TILE_USE_LONGEST], count);
    if (count >= 1024u) atomicAdd(use[TILE_USE_COARSE], count >> 10);
}
