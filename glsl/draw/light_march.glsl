// SPDX-License-Identifier: MIT
// How much light the mesh lets through on straight ways through the light grid (needs light.glsl).
#include "draw/light_walls.glsl"

// A step of a straight path through cells: it crosses a wall along one axis.
struct March {
    ivec3 at; // cell; x is along the path's main axis
    float passed;
    bool inside;
};

void step_to(inout March march, int next, int k, ivec3 origin, ivec3 stride, ivec3 count)
{
    ivec3 on = ivec3(equal(ivec3(k), ivec3(0, 1, 2)));
    int at = on.x * march.at.x + on.y * march.at.y + on.z * march.at.z;
    if (next == at || !march.inside) return;
    march.inside = next >= 0 && next < on.x * count.x + on.y * count.y + on.z * count.z;
    if (!march.inside) return;
    ivec3 face = march.at + on * (max(next, at) - at);
    march.at += on * (next - at);
    int first = on.x * origin.x + on.y * origin.y + on.z * origin.z;
    ivec3 from = face * stride;
    march.passed *= wall_at(first + from.x + from.y + from.z);
}

// The share of light that the mesh lets through from the centre of a cell along the unit vector
// `way`, up to the distance `reach` (m): light_blocks_march.
float pass_mesh(ivec3 place, vec3 way, float reach)
{
    int axis = longest_axis(way);
    vec3 along = turned(way, axis);
    ivec3 start = turned(place, axis), stride = turned(wall_step, axis),
          count = turned(cells, axis);
    ivec3 origin =
        ivec3(wall_origin(axis), wall_origin((axis + 1) % 3), wall_origin((axis + 2) % 3));
    float main = abs(along.x), most = reach * main / side + 0.5;
    March march = March(start, 1.0, true);
    for (int k = 1; float(k) <= most && march.inside && march.passed > 0.0; ++k) {
        vec3 off = float(k) * along / main;
        ivec3 next = start + ivec3(sign(off) * floor(abs(off) + 0.5));
        step_to(march, next.y, 1, origin, stride, count); // the other axes before the main axis
        step_to(march, next.z, 2, origin, stride, count);
        step_to(march, next.x, 0, origin, stride, count);
    }
    return march.passed;
}

float find_passed(ivec3 place, int light)
{
    vec3 way = light_params.way[light].xyz;
    if (light_params.walled == 0u) return 1.0;
    if (draw_params.light_place[light].w == 0.0) return pass_mesh(place, way, 1e30);
    vec3 off = way - light_params.low.xyz - (vec3(place) + 0.5) * side;
    float reach = max(length(off), 1e-6);
    return pass_mesh(place, off / reach, reach);
}
