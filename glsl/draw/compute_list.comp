// SPDX-License-Identifier: MIT
// Puts ribbons into the lists of the tiles that they touch, a slot for each lane: first counts
// them, then lists them. The order of a tile's pairs is not fixed; compute_sort.comp sorts them.
//   FILL 0: counts   1: lists
#include "draw/draw.h"
#include "draw/compute_strip.glsl"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(location = 0) uniform ivec3 band; // columns of tiles; first row; end row
layout(location = 1) uniform int slots;
layout(location = 2) uniform uint room; // pairs
layout(binding = BIND_RIBBONS) uniform usamplerBuffer ribbons;
layout(binding = BIND_KEYS) uniform usamplerBuffer keys;
#if FILL
layout(std430, binding = BIND_TILE_ENDS_OUT) buffer Ends { uint ends[]; };
layout(std430, binding = BIND_PAIRS_OUT) writeonly buffer Pairs { uvec2 pairs[]; };
#else
layout(std430, binding = BIND_TILE_COUNTS_OUT) buffer Counts { uint counts[]; };
#endif

void put(int tile, uvec2 pair)
{
#if FILL
    uint place = atomicAdd(ends[tile], 1u);
    if (place < room) pairs[place] = pair;
#else
    atomicAdd(counts[tile], 1u);
#endif
}

void main()
{
    int slot = lane_index();
    if (slot >= slots) return;
    uint depth = texelFetch(keys, slot).x;
    if (depth == 0u) return;
    uvec2 pair = uvec2(~depth, slot);
    Strip strip = make_strip(texelFetch(ribbons, slot * RIBBON_TEXELS).xy,
                             texelFetch(ribbons, slot * RIBBON_TEXELS + 3));
    int row = max(strip.rows.x / TILE_SIDE, band.y),
        last = min(strip.rows.y / TILE_SIDE, band.z - 1);
    for (; row <= last; ++row) {
        int top = row * TILE_SIDE, bottom = top + TILE_SIDE - 1;
        ivec2 columns = strip_columns(strip, max(top, strip.rows.x), min(bottom, strip.rows.y));
        if (columns.x > columns.y) continue;
        int end = columns.y / TILE_SIDE;
        for (int column = columns.x / TILE_SIDE; column <= end; ++column)
            put(row * band.x + column, pair);
    }
}
