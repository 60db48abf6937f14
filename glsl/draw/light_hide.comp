// SPDX-License-Identifier: MIT
// Finds the cells of the light grid that lie so deep in hair that they are hardly visible, and
// their mean light, and the ambient part of each cell's light beside the lamps'.
#include "draw/light.h"
#include "draw/light.glsl"
#include "kernel/cone.h"

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

// `mean`: the cell's mean light.
vec3 find_around(LightCell of, vec3 mean, vec3 around)
{
    vec3 lamps = vec3(0.0), albedo = light_params.albedo[of.places.y / LIGHT_CLASSES].rgb, sum;
    for (int l = 0; l < int(light_params.lights); ++l)
        lamps += of.lit[l] * draw_params.light_color[l].rgb;
    for (int c = 0; c < 3; ++c)
        sum[c] = cone_around(mean[c], lamps[c], around[c], of.tint.w, albedo[c]);
    return sum;
}

void main()
{
    int slot = lane_index();
    if (slot >= int(state.filled + state.beside)) return;
    bool hidden = is_hidden(cell_place(cell[slot].places.x));
    vec3 mean = vec3(0.0), around = vec3(0.0);
    for (int d = 0; d < LIGHT_ORDINATES; ++d) {
        mean += texelFetch(all_light, slot * LIGHT_ORDINATES + d).rgb / float(LIGHT_ORDINATES);
        around += light_params.around[d].rgb / float(LIGHT_ORDINATES);
    }
    cell[slot].mean = vec4(mean, hidden ? 1.0 : 0.0);
    if (slot < int(state.filled)) cell[slot].around.rgb = find_around(cell[slot], mean, around);
}
