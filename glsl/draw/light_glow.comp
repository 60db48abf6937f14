// SPDX-License-Identifier: MIT
// The light of all lights that the mesh reflects in cells next to it, before any is scattered:
// light_grid_cells.c. A lane for each slot.
#define LIGHTS         1
#define LIGHT_COUNT    0
#define SHADOW         0
#define SHADOW_BY_MESH 0
#include "draw/light.h"
#include "draw/lights.glsl"
#include "draw/light.glsl"
#include "draw/light_march.glsl"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(std430, binding = BIND_LIGHT_SLOTS_OUT) readonly buffer Slots { int slots[]; };
layout(std430, binding = BIND_LIGHT_CELLS_OUT) buffer Cells { LightCell cell[]; };
layout(std430, binding = BIND_LIGHT_STATE_OUT) readonly buffer State { LightState state; };
layout(std430, binding = BIND_LIGHT_DEPTH_OUT) readonly buffer Depth { float depth[]; };
#include "draw/light_behind.glsl"

int nearest_ordinate(vec3 way)
{
    float most = -2.0;
    int best = 0;
    for (int d = 0; d < LIGHT_ORDINATES; ++d) {
        float cosine = dot(light_params.ordinate[d].xyz, way);
        best = cosine > most ? d : best;
        most = max(cosine, most);
    }
    return best;
}

// The share of a light's colour that the mesh in a cell receives from it.
float received(ivec3 place, int light)
{
    vec3 at = light_params.low.xyz + (vec3(place) + 0.5) * side,
         x = at.x * light_params.turn[0].xyz + at.y * light_params.turn[1].xyz +
             at.z * light_params.turn[2].xyz,
         to_light;
    float share = min(light_share(light, x, to_light), CELL_LAMP_MOST),
          reach = draw_params.light_place[light].w == 0.0
                      ? 1e6
                      : length(light_params.way[light].xyz - at) / side;
    vec3 way = to_lattice(to_light), n = mesh_normal(place);
    share *= cell_facing(n.x, n.y, n.z, way.x, way.y, way.z);
    if (share > 0.0) share *= find_passed(place, light);
    if (share <= 0.0) return 0.0;
    return share * cell_left(behind(place, reach * way, nearest_ordinate(way), 0, 40.0));
}

void main()
{
    int slot = lane_index();
    if (slot >= int(state.filled + state.beside)) return;
    ivec3 place = cell_place(cell[slot].places.x);
    vec3 glow = vec3(0.0);
    int lights = is_beside_mesh(place) ? int(light_params.lights) : 0;
    for (int light = 0; light < lights; ++light)
        glow += received(place, light) * draw_params.light_color[light].rgb;
    cell[slot].glow = vec4(glow * draw_params.mesh_color.rgb, 0.0);
}
