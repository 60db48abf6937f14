// SPDX-License-Identifier: MIT
// Finds the cells of the light grid that lie so deep in hair that they are hardly visible, and
// their mean light.
#include "draw/light.h"
#include "draw/light.glsl"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(binding = BIND_LIGHT_ALL) uniform samplerBuffer all_light;
layout(std430, binding = BIND_LIGHT_SLOTS_OUT) readonly buffer Slots { int slots[]; };
layout(std430, binding = BIND_LIGHT_CELLS_OUT) buffer Cells { LightCell cell[]; };
layout(std430, binding = BIND_LIGHT_STATE_OUT) readonly buffer State { LightState state; };
layout(std430, binding = BIND_LIGHT_DEPTH_OUT) readonly buffer Depth { float depth[]; };

#include "draw/light_behind.glsl"

bool is_hidden(ivec3 place)
{
    vec3 way = (light_params.eye.xyz - light_params.low.xyz) / side - vec3(place) - 0.5;
    float most = CELL_HIDDEN_BEHIND / light_params.eye.w;
    return behind(place, way, int(light_params.eye_axis.w), 2, most) > most;
}

void main()
{
    int slot = lane_index();
    if (slot >= int(state.filled + state.beside)) return;
    bool hidden = is_hidden(cell_place(cell[slot].places.x));
    vec3 sum = vec3(0.0);
    for (int d = 0; d < LIGHT_ORDINATES && hidden; ++d)
        sum += texelFetch(all_light, slot * LIGHT_ORDINATES + d).rgb;
    cell[slot].mean = vec4(sum / float(LIGHT_ORDINATES), hidden ? 1.0 : 0.0);
}
