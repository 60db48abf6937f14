// SPDX-License-Identifier: MIT
// Deals the ribbons out to the blocks of pixels that they touch. A lane has a range of the ribbons,
// which are sorted and taken far to near, and for each block a list of its own, so that no lane waits
// for another and every list has its order by construction: last in, first out, near to far.
//
// The loop is one state machine, in which each turn adds at most one node: lanes of a group run
// the same turns, and nested loops would make each wait for the longest. CPU drivers end loops
// silently after 65,535 turns of an invocation: so it stops before, with its state stored, and goes
// on in the next dispatch.
#include "draw.h"
#include "block.glsl"

layout(local_size_x = BIN_GROUP) in;
layout(location = 0) uniform ivec4 pool;   // ribbons, nodes a lane, first block row and end
layout(location = 1) uniform int blocks;   // of a row, in whole tiles
layout(binding = BIND_SPANS) uniform usamplerBuffer spans;
layout(binding = BIND_ORDER) uniform usamplerBuffer order; // ribbons, near to far
layout(std430, binding = BIND_LISTS_OUT) buffer Lists { uint lists[]; };                 // a node's number + 1, 0: empty
layout(std430, binding = BIND_LINKS_OUT) writeonly buffer Links { uvec2 links[]; };      // ribbon, next node's number + 1
layout(std430, binding = BIND_BIN_STATE_OUT) buffer States { ivec4 states[]; };          // two a lane

const int MOST_TURNS = 60000;

void main()
{
    int lane = int(gl_GlobalInvocationID.x);
    ivec4 limits = pool; // read once: a uniform costs a load wherever it is named
    int stride = blocks;
    int share = (limits.x + BIN_LANES - 1) / BIN_LANES;
    int end = min((lane + 1) * share, limits.x);
    ivec4 from = states[2 * lane], inside = states[2 * lane + 1];
    int i = lane * share + from.x, node = lane * limits.y + from.y, column = inside.x, last = inside.y, row = inside.z;
    int last_node = (lane + 1) * limits.y;
    // Of the lists: those before this lane's, and before the band.
    int list = (lane * (limits.w - limits.z) - limits.z) * stride;
    bool resumed = from.z != 0, load = true;
    int ribbon = 0, row_end = 0, turn = 0;
    Span s = Span(0.0, 0.0, 0.0, 0, 0, 0, 0);
    // The next ribbon is fetched ahead, on every turn: its latency hides behind the others' work.
    int farthest = limits.x - 1, next = int(texelFetch(order, max(farthest - i, 0)).x);
    uvec4 next_span = texelFetch(spans, next);
    if (i < end) do {
        if (load) {
            ribbon = next;
            s = unpack_span(next_span);
            next = int(texelFetch(order, max(farthest - i - 1, 0)).x);
            row_end = min(s.last_row, limits.w - 1);
            if (!resumed) {
                row = max(s.row, limits.z) - 1;
                column = 1;
                last = 0;
            }
            resumed = false;
        }
        next_span = texelFetch(spans, next);
        if (column > last && row < row_end) {
            ++row;
            float x = s.middle + float(row - s.row) * s.slope;
            column = max(int(ceil(x - s.reach)), s.column);
            last = min(int(floor(x + s.reach)), s.last_column);
        }
        if (column <= last) {
            int at = list + row * stride + column;
            uint behind = lists[at];
            links[node] = uvec2(uint(ribbon), behind);
            lists[at] = uint(++node);
            ++column;
        }
        load = column > last && row >= row_end;
        i += load ? 1 : 0;
        ++turn;
    } while (i < end && turn < MOST_TURNS && node < last_node);
    states[2 * lane] = ivec4(i - lane * share, node - lane * limits.y, load ? 0 : 1,
                             i < end ? (node < last_node ? 1 : 2) : 0);
    states[2 * lane + 1] = ivec4(column, last, row, 0);
}
