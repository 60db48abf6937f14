// SPDX-License-Identifier: MIT
// The optical depth of a cell for each ordinate, and the light of the lamps after one scattering in
// the cell: light_grid_cells.c. A work group for each cell, a lane for each ordinate. Each lane
// computes the values that are common to all ordinates itself.
#include "draw/light.h"
#include "draw/light.glsl"
#include "draw/light_class.glsl"
#include "draw/light_walls.glsl"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(location = 2) uniform ivec2 range; // slots: first, end
layout(binding = BIND_LIGHT_FIRST) uniform samplerBuffer first;
layout(std430, binding = BIND_LIGHT_CELLS_OUT) buffer Cells { LightCell cell[]; };
layout(std430, binding = BIND_LIGHT_SUMS_OUT) readonly buffer Sums { uint sums[]; };
layout(std430, binding = BIND_LIGHT_DEPTH_OUT) writeonly buffer Depth { float depth[]; };
layout(std430, binding = BIND_LIGHT_SOURCE_OUT) writeonly buffer Source { float source[]; };

// A sum of a class over LIGHT_STEPS: number 0 is its area, 1 + l the area that light l reaches.
float sum_of(int slot, int which, int number)
{
    int at = 2 * ((slot - range.x) * int(light_params.classes) + which) *
                 (1 + int(light_params.lights)) +
             2 * number;
    return (float(sums[at + 1]) * 4294967296.0 + float(sums[at])) * (1.0 / LIGHT_STEPS);
}

// The main tangent, by power iteration on the sum of t t^T, with the sign of the mean tangent.
struct Tangents {
    mat3 tensor;
    vec3 mean, main;
    vec4 kinds; // areas of the kinds
    float most, area;
};

void add_tangent(inout Tangents all, int which, float area)
{
    vec3 t = class_tangent(which % LIGHT_CLASSES);
    all.main = area > all.most ? t : all.main;
    all.most = max(area, all.most);
    all.area += area;
    all.mean += area * t;
    all.kinds += area * vec4(equal(ivec4(which / LIGHT_CLASSES), ivec4(0, 1, 2, 3)));
    all.tensor += area * outerProduct(t, t);
}

int main_class(Tangents all)
{
    vec3 main = all.main;
    for (int turn = 0; turn < 8; ++turn) {
        vec3 next = all.tensor * main;
        float square = dot(next, next);
        main = square > 0.0 ? next * inversesqrt(square) : main;
    }
    main = dot(all.mean, main) < 0.0 ? -main : main;
    float most = max(max(all.kinds.x, all.kinds.y), max(all.kinds.z, all.kinds.w));
    int kind = all.kinds.x == most ? 0 : all.kinds.y == most ? 1 : all.kinds.z == most ? 2 : 3;
    return kind * LIGHT_CLASSES + class_of(main);
}

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

vec3 first_of(int which, int light, int d)
{
    int kind = which / LIGHT_CLASSES,
        row = (kind * int(light_params.lights) + light) * LIGHT_CLASSES + which % LIGHT_CLASSES,
        at = row * LIGHT_WIDE + wide_address(d, 0);
    return vec3(texelFetch(first, at).x, texelFetch(first, at + LIGHT_LANES).x,
                texelFetch(first, at + 2 * LIGHT_LANES).x);
}

vec3 painted_areas(LightCell of)
{
    return vec3(of.carry[0], of.carry[1], of.carry[2]) * 4294967296.0 +
           vec3(of.tints[0], of.tints[1], of.tints[2]);
}

void main()
{
    int slot = range.x + group_index(), d = min(int(gl_LocalInvocationID.x), LIGHT_ORDINATES - 1),
        classes = int(light_params.classes);
    if (slot >= range.y) return;
    ivec3 place = cell_place(cell[slot].places.x);
    Tangents tangents = Tangents(mat3(0.0), vec3(0.0), vec3(0.577), vec4(0.0), 0.0, 0.0);
    float tau = 0.0;
    for (int which = 0; which < classes; ++which) {
        float area = sum_of(slot, which, 0);
        if (area == 0.0) continue;
        tau += area * class_sine(which % LIGHT_CLASSES, d);
        add_tangent(tangents, which, area);
    }
    vec3 painted = painted_areas(cell[slot]),
         tint = light_params.tinted != 0u && tangents.area > 0.0
                    ? painted / (LIGHT_STEPS * tangents.area)
                    : vec3(1.0);
    vec3 sent = vec3(0.0), glow = vec3(0.0);
    for (int light = 0; light < int(light_params.lights); ++light) {
        float passed = find_passed(place, light), lit = 0.0;
        vec3 part = vec3(0.0);
        for (int which = 0; which < classes && passed > 0.0; ++which) {
            float met = sum_of(slot, which, 1 + light);
            if (met == 0.0) continue;
            lit += met;
            part += met * passed * first_of(which, light, d);
        }
        vec3 color = draw_params.light_color[light].rgb;
        sent += part * color * tint / max(tau, 1e-12);
        // A matt surface perpendicular to light of 1 shows its colour. Surfaces in a cell have all
        // orientations towards the light, so they are half as bright on average.
        glow += 0.5 * lit / max(tangents.area, 1e-12) * passed * color * draw_params.mesh_color.rgb;
    }
    if (int(gl_LocalInvocationID.x) >= LIGHT_ORDINATES) return;
    depth[slot * LIGHT_ORDINATES + d] = tau;
    int at = ordinate_address(d, slot);
    for (int k = 0; k < 3; ++k) source[at + k] = sent[k];
    if (d > 0) return;
    cell[slot].glow = vec4(light_params.walled != 0u ? glow : vec3(0.0), 0.0);
    cell[slot].tint = vec4(tint, 0.0);
    cell[slot].places.y = main_class(tangents);
}
