// SPDX-License-Identifier: MIT
// Sends light through the cells of the light grid: light_grid_sweep.c. A work group has one
// ordinate and goes slice by slice along its main axis. The light that enters a cell is
// interpolated between cells of the slice before (bilinear).
//   WALLED 1: a mesh blocks light between cells
//   ONTO 1: the light of all orders that hair sends, alone, into all cells, for skin
#include "draw/light.h"
#include "draw/light.glsl"
#include "draw/light_walls.glsl"

layout(local_size_x = GROUP_SIZE) in;
layout(location = 0) uniform ivec2 sweep; // number of this sweep; 1: with ambient light
layout(std430, binding = BIND_LIGHT_SLOTS_OUT) readonly buffer Slots { int slots[]; };
layout(std430, binding = BIND_LIGHT_CELLS_OUT) readonly buffer Cells { LightCell cell[]; };
layout(std430, binding = BIND_LIGHT_STATE_OUT) buffer State
{
    LightState state;
    vec4 met[];
};
// [ordinate][2]: light that leaves the cells of a slice, with a border of one cell
layout(std430, binding = BIND_LIGHT_PLANES_OUT) coherent buffer Planes { vec4 plane[]; };
layout(std430, binding = BIND_LIGHT_DEPTH_OUT) readonly buffer Depth { float depth[]; };
layout(std430, binding = BIND_LIGHT_SOURCE_OUT) readonly buffer Source { float source[]; };
#if ONTO
layout(std430, binding = BIND_LIGHT_ONTO_OUT) writeonly buffer Onto { uvec2 onto[]; };
layout(std430, binding = BIND_LIGHT_SENT_OUT) readonly buffer Sent { float sent[]; };
#else
layout(std430, binding = BIND_LIGHT_ORDER_OUT) writeonly buffer Order { float order[]; };
layout(std430, binding = BIND_LIGHT_TOTAL_OUT) buffer Total { float total[]; };
#endif

int d = int(gl_WorkGroupID.x), group = d / LIGHT_LANES, axis = group / 2;
bool forward = group % 2 == 1;
vec3 way = turned(light_params.ordinate[d].xyz, axis);
ivec3 count = turned(cells, axis), stride = turned(ivec3(1, cells.x, cells.x *cells.y), axis);
float longer = 1.0 / abs(way.x); // length of the way through a cell over the cell's side
// Weights of three cells of the slice before, along one axis across.
vec3 weights(float shift) { return vec3(max(shift, 0.0), 1.0 - abs(shift), max(-shift, 0.0)); }
vec3 column_weights = weights(way.y * longer), row_weights = weights(way.z * longer);

#if WALLED
ivec3 wall_stride = turned(wall_step, axis);
ivec3 wall_first =
    ivec3(wall_origin(axis), wall_origin((axis + 1) % 3), wall_origin((axis + 2) % 3));
// The wall of axis k (0: along) at a slice, column and row.
float wall(int first, ivec3 at)
{
    ivec3 from = at * wall_stride;
    return wall_at(first + from.x + from.y + from.z);
}

// The light that the mesh reflects in a cell (slice, column, row), which stands next to the mesh.
vec3 glow_at(ivec3 at)
{
    ivec3 from = at * stride;
    int slot = slots[from.x + from.y + from.z];
    return ONTO == 0 && slot >= 0 ? cell[slot].glow.rgb : vec3(0.0);
}

// Takes the light that the mesh blocks from the weights of three cells next to each other, and
// returns the light that it reflects instead into the middle cell `at`.
vec3 meet_mesh(inout vec3 weight, float low, float high, ivec3 at)
{
    float blocked = (1.0 - low) * weight.x + (1.0 - high) * weight.z;
    weight.xz *= vec2(low, high);
    return blocked > 0.0 ? blocked * glow_at(at) : vec3(0.0);
}
#endif

int plane_address(int parity, int x, int y)
{
    return (2 * d + parity) * int(light_params.plane) + (y + 1) * (count.y + 2) + x + 1;
}

// The light of row y of the slice before, blended along the columns.
vec3 row_light(int parity, int slice, int x, int y)
{
    vec3 weight = column_weights, glow = vec3(0.0);
#if WALLED
    ivec3 at = ivec3(slice, x, y);
    glow = meet_mesh(weight, wall(wall_first.y, at), wall(wall_first.y, at + ivec3(0, 1, 0)), at);
#endif
    return glow + weight.x * plane[plane_address(parity, x - 1, y)].rgb +
           weight.y * plane[plane_address(parity, x, y)].rgb +
           weight.z * plane[plane_address(parity, x + 1, y)].rgb;
}

vec3 incoming(int parity, int slice, int x, int y)
{
    int before = forward ? slice - 1 : slice + 1;
    vec3 weight = row_weights, glow = vec3(0.0);
#if WALLED
    ivec3 at = ivec3(slice, x, y);
    glow = meet_mesh(weight, wall(wall_first.z, at), wall(wall_first.z, at + ivec3(0, 0, 1)), at);
#endif
    vec3 light = glow + weight.x * row_light(parity, before, x, y - 1) +
                 weight.y * row_light(parity, before, x, y) +
                 weight.z * row_light(parity, before, x, y + 1);
#if WALLED
    float passed = wall(wall_first.x, ivec3(forward ? slice : slice + 1, x, y));
    if (passed < 1.0) light = passed * light + (1.0 - passed) * glow_at(at);
#endif
    return light;
}

#if ONTO
void cross_onto(int at_cell, inout vec3 light, int slot)
{
    vec3 mean = light;
    if (slot >= 0 && slot < int(state.filled)) {
        int at = ordinate_address(d, slot);
        float tau = depth[slot * LIGHT_ORDINATES + d] * longer, left = cell_left(tau);
        vec3 last = vec3(source[at], source[at + 1], source[at + 2]),
             all = vec3(sent[at], sent[at + 1], sent[at + 2]) + last + state.more.rgb * last;
        mean = all + (light - all) * cell_mean_share(tau, left);
        light = all + (light - all) * left;
    }
    mean = min(mean, vec3(65504.0)); // the largest half
    onto[d * int(light_params.count.w) + at_cell] =
        uvec2(packHalf2x16(mean.rg), packHalf2x16(vec2(mean.b, 0.0)));
}
#else
void keep(int at, vec3 mean)
{
    for (int k = 0; k < 3; ++k) {
        order[at + k] = mean[k];
        total[at + k] = mean[k] + (sweep.x > 0 ? total[at + k] : 0.0);
    }
}

// The light that leaves the cell (kernel/cell.h). Adds the light that the cell's hair meets to
// `sum`.
vec3 cross_cell(vec3 light, int slot, inout vec3 sum)
{
    if (slot < 0) return light;
    int at = ordinate_address(d, slot);
    if (slot >= int(state.filled)) {
        keep(at, light);
        return light;
    }
    float across = depth[slot * LIGHT_ORDINATES + d], tau = across * longer, left = cell_left(tau),
          share = cell_mean_share(tau, left);
    vec3 sent = vec3(source[at], source[at + 1], source[at + 2]),
         mean = sent + (light - sent) * share;
    keep(at, mean);
    sum += mean * across;
    return sent + (light - sent) * left;
}

#endif

shared vec3 sums[GROUP_SIZE];

void main()
{
    int lane = int(gl_LocalInvocationID.x), wide = count.y, tall = count.z;
    if (ONTO == 0 && state.done != 0u) return;
    vec4 around = vec4(sweep.y == 0 ? vec3(0.0) : light_params.around[d].rgb, 0.0);
    for (int i = lane; i < 2 * int(light_params.plane); i += GROUP_SIZE)
        plane[2 * d * int(light_params.plane) + i] = around;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < count.x; ++i) {
        memoryBarrierBuffer();
        barrier();
        int slice = forward ? i : count.x - 1 - i;
        for (int c = lane; c < wide * tall; c += GROUP_SIZE) {
            int x = c % wide, y = c / wide,
                at_cell = slice * stride.x + x * stride.y + y * stride.z, slot = slots[at_cell];
            vec3 light = incoming(i & 1, slice, x, y);
#if ONTO
            cross_onto(at_cell, light, slot);
#else
            light = cross_cell(light, slot, sum);
#endif
            plane[plane_address(~i & 1, x, y)] = vec4(light, 0.0);
        }
    }
#if !ONTO
    sums[lane] = sum;
    for (int half_of = GROUP_SIZE / 2; half_of > 0; half_of /= 2) {
        memoryBarrierShared();
        barrier();
        if (lane < half_of) sums[lane] += sums[lane + half_of];
    }
    if (lane == 0) met[sweep.x * LIGHT_ORDINATES + d] = vec4(sums[0], 0.0);
#endif
}
