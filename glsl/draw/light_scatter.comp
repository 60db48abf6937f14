// SPDX-License-Identifier: MIT
// The light that hair in each cell of the light grid scatters from the last order, by its main
// tangent. A work group for each cell, a lane for each ordinate.
#include "draw/light.h"
#include "draw/light.glsl"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(binding = BIND_LIGHT_SCATTER) uniform samplerBuffer scatter;
layout(std430, binding = BIND_LIGHT_CELLS_OUT) buffer Cells { LightCell cell[]; };
layout(std430, binding = BIND_LIGHT_STATE_OUT) readonly buffer State { LightState state; };
layout(std430, binding = BIND_LIGHT_SOURCE_OUT) buffer Source { float source[]; };
layout(std430, binding = BIND_LIGHT_ORDER_OUT) readonly buffer Order { float order[]; };
layout(std430, binding = BIND_LIGHT_SENT_OUT) buffer Sent { float sent[]; };

shared vec3 from[LIGHT_ORDINATES];

void main()
{
    const int square = LIGHT_ORDINATES * LIGHT_ORDINATES;
    int slot = group_index(), d = int(gl_LocalInvocationID.x);
    if (slot >= int(state.filled) || state.done != 0u) return;
    int at = ordinate_address(min(d, LIGHT_ORDINATES - 1), slot);
    if (d < LIGHT_ORDINATES) from[d] = vec3(order[at], order[at + 1], order[at + 2]);
    memoryBarrierShared();
    barrier();
    if (d >= LIGHT_ORDINATES) return;
    int table = cell[slot].places.y * 3 * square + d;
    vec3 sum = vec3(0.0), mean = vec3(0.0);
    for (int i = 0; i < LIGHT_ORDINATES; ++i) {
        int row = table + i * LIGHT_ORDINATES;
        sum += from[i] * vec3(texelFetch(scatter, row).x, texelFetch(scatter, row + square).x,
                              texelFetch(scatter, row + 2 * square).x);
        mean += from[i];
    }
    sum *= cell[slot].tint.rgb;
    for (int k = 0; k < 3; ++k) {
        if (light_params.walled == 2u) sent[at + k] += source[at + k];
        source[at + k] = sum[k];
    }
    // The mesh reflects its colour's share of the light equally in all directions.
    if (d == 0) cell[slot].glow.rgb = draw_params.mesh_color.rgb * mean / float(LIGHT_ORDINATES);
}
