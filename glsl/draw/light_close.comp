// SPDX-License-Identifier: MIT
// The sum of the light of all orders, including those after the last swept one. A work group for
// each cell, a lane for each ordinate.
#include "draw/light.h"
#include "draw/light.glsl"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(std430, binding = BIND_LIGHT_STATE_OUT) readonly buffer State { LightState state; };
layout(std430, binding = BIND_LIGHT_ALL_OUT) writeonly buffer All { vec4 all_light[]; };
layout(std430, binding = BIND_LIGHT_ORDER_OUT) readonly buffer Order { float order[]; };
layout(std430, binding = BIND_LIGHT_TOTAL_OUT) readonly buffer Total { float total[]; };

void main()
{
    int slot = group_index(), d = int(gl_LocalInvocationID.x);
    if (slot >= int(state.filled + state.beside) || d >= LIGHT_ORDINATES) return;
    int at = ordinate_address(d, slot);
    vec3 light = vec3(total[at], total[at + 1], total[at + 2]) +
                 state.more.rgb * vec3(order[at], order[at + 1], order[at + 2]);
    all_light[slot * LIGHT_ORDINATES + d] = vec4(light, 0.0);
}
