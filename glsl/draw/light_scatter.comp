// SPDX-License-Identifier: MIT
// The light that hair in each cell of the light grid scatters from the last order, by its main
// tangent, and the light that the mesh reflects there. A work group for each cell, a lane for each
// ordinate.
#include "draw/light.h"
#include "draw/light.glsl"
#include "draw/light_walls.glsl"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(binding = BIND_LIGHT_SCATTER) uniform samplerBuffer scatter;
layout(std430, binding = BIND_LIGHT_CELLS_OUT) buffer Cells { LightCell cell[]; };
layout(std430, binding = BIND_LIGHT_STATE_OUT) readonly buffer State { LightState state; };
layout(std430, binding = BIND_LIGHT_SOURCE_OUT) buffer Source { float source[]; };
layout(std430, binding = BIND_LIGHT_ORDER_OUT) readonly buffer Order { float order[]; };
layout(std430, binding = BIND_LIGHT_SENT_OUT) buffer Sent { float sent[]; };

shared vec3 from[LIGHT_ORDINATES];

// The mesh in a cell reflects its colour's share of the light that it receives, equally in all
// directions.
void reflect_at(int slot)
{
    ivec3 place = cell_place(cell[slot].places.x);
    if (!is_beside_mesh(place)) return;
    vec3 n = mesh_normal(place), sum = vec3(0.0);
    float weights = 0.0;
    for (int i = 0; i < LIGHT_ORDINATES; ++i) {
        vec3 way = light_params.ordinate[i].xyz;
        float weight = cell_facing(n.x, n.y, n.z, -way.x, -way.y, -way.z);
        sum += weight * from[i];
        weights += weight;
    }
    cell[slot].glow.rgb = draw_params.mesh_color.rgb * sum / weights;
}

void main()
{
    const int square = LIGHT_ORDINATES * LIGHT_ORDINATES;
    int slot = group_index(), d = int(gl_LocalInvocationID.x);
    if (slot >= int(state.filled + state.beside) || state.done != 0u) return;
    int at = ordinate_address(min(d, LIGHT_ORDINATES - 1), slot);
    if (d < LIGHT_ORDINATES) from[d] = vec3(order[at], order[at + 1], order[at + 2]);
    memoryBarrierShared();
    barrier();
    if (d == 0 && light_params.walled != 0u) reflect_at(slot);
    if (d >= LIGHT_ORDINATES || slot >= int(state.filled)) return;
    int table = cell[slot].places.y * 3 * square + d;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < LIGHT_ORDINATES; ++i) {
        int row = table + i * LIGHT_ORDINATES;
        sum += from[i] * vec3(texelFetch(scatter, row).x, texelFetch(scatter, row + square).x,
                              texelFetch(scatter, row + 2 * square).x);
    }
    sum *= cell[slot].tint.rgb;
    for (int k = 0; k < 3; ++k) {
        if (light_params.walled == 2u) sent[at + k] += source[at + k];
        source[at + k] = sum[k];
    }
}
