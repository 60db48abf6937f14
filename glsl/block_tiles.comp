// SPDX-License-Identifier: MIT
// Which tiles of blocks must be composited: those with a list that is not empty, and those in the
// mesh's box. Their order is left to chance, and nothing depends on it.
#include "draw.h"

layout(local_size_x = GROUP_SIZE) in;
layout(location = 0) uniform ivec4 grid; // tiles across and down, first row of tiles, lists of a lane
layout(location = 1) uniform ivec4 box;  // first tile, last tile that must be composited anyway
layout(binding = BIND_LISTS) uniform usamplerBuffer lists;
layout(std430, binding = BIND_TILES_OUT) buffer Tiles { uint tiles[]; };

void main()
{
    int tile = int(gl_GlobalInvocationID.x), count = grid.x * grid.y;
    ivec2 at = ivec2(tile % grid.x, tile / grid.x + grid.z);
    int first = (tile / grid.x * TILE_DOWN * grid.x + tile % grid.x) * TILE_ACROSS, per_lane = grid.w;
    uint any = all(greaterThanEqual(at, box.xy)) && all(lessThanEqual(at, box.zw)) ? 1u : 0u;
    first = min(first, per_lane - (TILE_DOWN - 1) * grid.x * TILE_ACROSS - TILE_ACROSS);
    for (int lane = 0; lane < BIN_LANES; ++lane)
        for (int y = 0; y < TILE_DOWN; ++y)
            for (int x = 0; x < TILE_ACROSS; ++x)
                any |= texelFetch(lists, lane * per_lane + first + y * grid.x * TILE_ACROSS + x).x;
    if (tile < count && any != 0u) tiles[3u + atomicAdd(tiles[0], 1u)] = uint(tile);
}
