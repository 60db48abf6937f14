// SPDX-License-Identifier: MIT
// Lists the tiles with ribbons and gives each a range for its list. The order of tiles and ranges
// is not fixed.
#include "draw/draw.h"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(location = 0) uniform ivec2 band; // first tile, end
layout(std430, binding = BIND_TILE_COUNTS_OUT) readonly buffer Counts { uint counts[]; };
layout(std430, binding = BIND_TILE_ENDS_OUT) writeonly buffer Ends { uint ends[]; };
layout(std430, binding = BIND_TILES_OUT) writeonly buffer Tiles { uint tiles[]; };
layout(std430, binding = BIND_TILE_USE_OUT) buffer Use { uint use[TILE_USE_WORDS]; };

void main()
{
    int tile = band.x + lane_index();
    if (tile >= band.y) return;
    uint count = counts[tile];
    if (count == 0u) return;
    uint number = atomicAdd(use[TILE_USE_TILES], 1u);
    tiles[number] = uint(tile);
    if (number == 0u) { // other lanes add to the word in between
        use[TILE_USE_GROUPS] = uint(TILE_ROW);
        use[TILE_USE_GROUPS + 2] = 1u;
    }
    if (number % uint(TILE_ROW) == 0u) atomicAdd(use[TILE_USE_GROUPS + 1], 1u);
    ends[tile] = atomicAdd(use[TILE_USE_PAIRS], count);
    atomicMax(use[TILE_USE_LONGEST], count);
    if (count >= 1024u) atomicAdd(use[TILE_USE_COARSE], count >> 10);
}
