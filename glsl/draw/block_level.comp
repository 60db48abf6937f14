// SPDX-License-Identifier: MIT
// For each tile of one level, the depth behind which hair is hidden: the least value of
// block_hide.comp in the tile and in the eight tiles around it. At level k a tile covers 2^k x 2^k
// tiles of the first level. Also stores the least value of the tile itself, for the next level.
#include "draw/draw.h"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(location = 0) uniform ivec2 tiles; // columns, rows of level 0
layout(location = 1) uniform int level;
layout(std430, binding = BIND_HIDING_OUT) buffer Nearest { float nearest[]; }; // level by level
layout(std430, binding = BIND_LEVELS_OUT) writeonly buffer Levels { float levels[]; };

int address(int of_level, ivec2 tile) { return (of_level * tiles.y + tile.y) * tiles.x + tile.x; }

// The least value of the tiles from `low` to `high`. Tiles outside the picture are left out.
float least(ivec2 low, ivec2 high, ivec2 count)
{
    low = max(low, ivec2(0)), high = min(high, count - 1);
    float found = nearest[address(level, low)];
    for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x)
            found = min(found, nearest[address(level, ivec2(x, y))]);
    return found;
}

void main()
{
    ivec2 count = (tiles + (1 << level) - 1) >> level;
    int lane = lane_index();
    if (lane >= count.x * count.y) return;
    ivec2 tile = ivec2(lane % count.x, lane / count.x);
    levels[address(level, tile)] = least(tile - 1, tile + 1, count);
    if (tile == (tile & ~1) && level + 1 < HIDE_LEVELS)
        nearest[address(level + 1, tile >> 1)] = least(tile, tile + 1, count);
}
