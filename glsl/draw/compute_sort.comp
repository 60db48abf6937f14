// SPDX-License-Identifier: MIT
// Sorts the pairs of tiles with ribbons, a tile for each work group: near ribbons first, ribbons of
// equal depth by their slots. The key (depth, slot) is unique, so the order is the same in every
// run.
//
// Runs of GROUP_SIZE pairs are sorted in shared memory, where each lane counts the pairs that come
// before its own. Then pairs of runs are merged: a pair's place is its place in its own run plus
// the number of pairs of the other run that come before it, found by binary search. Lists may have
// any length.
#include "draw/draw.h"

layout(local_size_x = GROUP_SIZE) in;
layout(location = 0) uniform uint room; // pairs
layout(std430, binding = BIND_TILE_COUNTS_OUT) readonly buffer Counts { uint counts[]; };
layout(std430, binding = BIND_TILE_ENDS_OUT) readonly buffer Ends { uint ends[]; };
layout(std430, binding = BIND_TILE_USE_OUT) readonly buffer Use { uint use[TILE_USE_WORDS]; };
layout(std430, binding = BIND_TILES_OUT) readonly buffer Tiles { uint tiles[]; };
// Lanes read what other lanes of their group write. Images are used instead of storage buffers,
// which CPU drivers read word by word.
layout(binding = IMAGE_PAIRS, rg32ui) coherent uniform uimageBuffer pairs;
layout(binding = IMAGE_SORTED, rg32ui) coherent uniform uimageBuffer sorted;
#if STAGED
shared uvec2 run[GROUP_SIZE];
#endif

const uint LENGTH = uint(GROUP_SIZE);

bool comes_before(uvec2 a, uvec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); }

uvec2 get(bool in_sorted, uint at)
{
    if (in_sorted) return imageLoad(sorted, int(at)).xy;
    return imageLoad(pairs, int(at)).xy;
}

void put(bool in_sorted, uint at, uvec2 pair)
{
    if (in_sorted)
        imageStore(sorted, int(at), uvec4(pair, 0u, 0u));
    else
        imageStore(pairs, int(at), uvec4(pair, 0u, 0u));
}

void sort_run(uint at, uint count, bool to_sorted)
{
    uint lane = gl_LocalInvocationID.x;
    uvec2 own = get(false, at + lane);
    uint place = 0u;
#if STAGED
    run[lane] = own;
    barrier();
    for (uint i = 0u; i < count; ++i) place += uint(comes_before(run[i], own));
#else
    for (uint i = 0u; i < count; ++i) place += uint(comes_before(get(false, at + i), own));
#endif
    barrier(); // all lanes have read
    if (lane < count) put(to_sorted, at + place, own);
}

// The place after merging of pair number i, in a list that begins at `begin` and consists of sorted
// runs of `length`.
uint find_place(bool in_sorted, uvec2 pair, uint begin, uint count, uint length, uint i)
{
    uint both = i / (2u * length) * 2u * length;
    bool is_first = i - both < length;
    uint low = min(is_first ? both + length : both, count),
         high = min(is_first ? both + 2u * length : both + length, count), other = low;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (comes_before(get(in_sorted, begin + middle), pair))
            low = middle + 1u;
        else
            high = middle;
    }
    return begin + i + low - other - (is_first ? 0u : length);
}

void main()
{
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (group >= use[TILE_USE_TILES]) return;
    uint tile = tiles[group], count = counts[tile], end = ends[tile], begin = end - count;
    if (end > room) return;
    bool in_sorted = true; // the last merge must write to `sorted`; each merge changes sides
    for (uint length = LENGTH; length < count; length *= 2u) in_sorted = !in_sorted;
    for (uint i = 0u; i < count; i += LENGTH)
        sort_run(begin + i, min(count - i, LENGTH), in_sorted);
    for (uint length = LENGTH; length < count; length *= 2u) {
        memoryBarrierImage();
        barrier();
        for (uint i = gl_LocalInvocationID.x; i < count; i += LENGTH) {
            uvec2 pair = get(in_sorted, begin + i);
            put(!in_sorted, find_place(in_sorted, pair, begin, count, length, i), pair);
        }
        in_sorted = !in_sorted;
    }
}
