// SPDX-License-Identifier: MIT
// Deals the ribbons out to the 4x4-pixel blocks that they touch. A lane has a range of the ribbons,
// which are sorted near to far, and for each block a list of its own, so that no lane waits for
// another and every list has its order by construction: last in, first out, far to near.
//
// The loop is one state machine, in which each turn adds at most one node: lanes of a group run
// the same turns, and nested loops would make each wait for the longest. CPU drivers end loops
// silently after 65,535 turns of an invocation: so it stops before, with its state stored, and goes
// on in the next dispatch.
//
// In a row of blocks a ribbon's columns are those of the strip beside its middle line between the
// middles of the row's first and last pixels, cut by the ribbon's box.
#include "draw.h"
#include "block.glsl"

layout(local_size_x = BIN_GROUP) in;
layout(location = 0) uniform ivec4 pool; // ribbons, nodes a lane, first block row and end
layout(binding = BIND_RECORDS) uniform usamplerBuffer records;
layout(binding = BIND_ORDER) uniform usamplerBuffer order; // records, near to far
layout(std430, binding = BIND_LISTS_OUT) buffer Lists { uint lists[]; };                 // a node's number + 1, 0: empty
layout(std430, binding = BIND_LINKS_OUT) writeonly buffer Links { uvec2 links[]; };      // record, next node's number + 1
layout(std430, binding = BIND_BIN_STATE_OUT) buffer States { ivec4 states[]; };          // two a lane

const int MOST_TURNS = 60000;

void main()
{
    int lane = int(gl_GlobalInvocationID.x);
    int width = int(draw_params.width), blocks = (width + BLOCK - 1) / BLOCK, rows = pool.w - pool.z;
    vec2 edge = vec2(draw_params.width, min(draw_params.height, float(pool.w * BLOCK)));
    float top = float(pool.z * BLOCK);
    int share = (pool.x + BIN_LANES - 1) / BIN_LANES;
    int end = min((lane + 1) * share, pool.x);
    ivec4 from = states[2 * lane], inside = states[2 * lane + 1];
    int i = lane * share + from.x, node = from.y, column = inside.x, last = inside.y, row = inside.z;
    int first_node = lane * pool.y, list = lane * blocks * rows;
    bool fresh = from.z == 0, load = true;
    int record = 0, row_end = 0;
    float ax = 0.0, ay = 0.0, slope = 0.0, beside = 0.0, low_x = 0.0, high_x = 0.0;
    int turn = 0;
    // The next ribbon is fetched ahead, on every turn: its latency hides behind the others' work.
    int next = int(texelFetch(order, min(i, pool.x - 1)).x);
    uvec4 next_ends = texelFetch(records, RECORD_TEXELS * next), next_shape = texelFetch(records, RECORD_TEXELS * next + 1);
    if (i < end) do {
        if (load) {
            record = next;
            Ribbon r = unpack_ribbon(next_ends, next_shape);
            next = int(texelFetch(order, min(i + 1, pool.x - 1)).x);
            vec2 d = r.b - r.a;
            d *= inversesqrt(max(dot(d, d), 1e-20));
            float reach = max(r.half_width.x, r.half_width.y) + 0.5 * (abs(d.x) + abs(d.y));
            // How far the mitres go beyond the ends: tangents of the bounds' turns.
            vec2 turned = abs(vec2(r.bound_a.x * d.y - r.bound_a.y * d.x, r.bound_b.x * d.y - r.bound_b.y * d.x)) /
                          max(vec2(dot(r.bound_a, d), dot(r.bound_b, d)), 0.1);
            vec2 a = r.a - d * (min(turned.x, 3.0) * reach + 0.01), b = r.b + d * (min(turned.y, 3.0) * reach + 0.01);
            vec2 across = reach * abs(d.yx);
            vec2 low = max(min(a, b) - across, vec2(0.0, top)), high = min(max(a, b) + across, edge - 0.01);
            low_x = low.x;
            high_x = high.x;
            ax = r.a.x;
            ay = r.a.y;
            float inverse = 1.0 / (abs(d.y) > 1e-4 ? d.y : 1e-4);
            slope = d.x * inverse;
            beside = reach * abs(inverse);
            bool seen = all(lessThanEqual(low, high));
            row_end = seen ? int(floor(high.y - 0.5)) / BLOCK : -1;
            if (fresh) {
                row = seen ? int(ceil(low.y - 0.5)) / BLOCK - 1 : -1;
                column = 1;
                last = 0;
            }
            fresh = false;
        }
        next_ends = texelFetch(records, RECORD_TEXELS * next);
        next_shape = texelFetch(records, RECORD_TEXELS * next + 1);
        if (column > last && row < row_end) {
            ++row;
            float y0 = float(row * BLOCK) + 0.5 - ay, x0 = ax + y0 * slope, x1 = x0 + float(BLOCK - 1) * slope;
            float low = max(min(x0, x1) - beside, low_x), high = min(max(x0, x1) + beside, high_x);
            column = int(ceil(low - 0.5)) / BLOCK;
            last = low <= high ? int(floor(high - 0.5)) / BLOCK : -1;
        }
        if (column <= last) {
            int at = list + (row - pool.z) * blocks + column;
            uint behind = lists[at];
            lists[at] = uint(first_node + node + 1);
            links[first_node + node] = uvec2(uint(record), behind);
            ++node;
            ++column;
        }
        load = column > last && row >= row_end;
        if (load) {
            ++i;
            fresh = true;
        }
        ++turn;
    } while (i < end && turn < MOST_TURNS && node < pool.y);
    states[2 * lane] = ivec4(i - lane * share, node, fresh ? 0 : 1, i < end ? (node < pool.y ? 1 : 2) : 0);
    states[2 * lane + 1] = ivec4(column, last, row, 0);
}
