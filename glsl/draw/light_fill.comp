// SPDX-License-Identifier: MIT
// The optical depth of a cell for each ordinate, and the light of the lamps after one scattering in
// the cell: light_grid_cells.c. A work group for each cell, a lane for each ordinate. Each lane
// computes the values that are common to all ordinates itself.
#include "draw/light.h"
#include "draw/light.glsl"
#include "draw/light_class.glsl"
#include "draw/light_march.glsl"
#include "kernel/cone.h"

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

// `spread`: of the tangents around it (kernel/cone.h).
int main_class(Tangents all, out float spread)
{
    vec3 main = all.main;
    for (int turn = 0; turn < 8; ++turn) {
        vec3 next = all.tensor * main;
        float square = dot(next, next);
        main = square > 0.0 ? next * inversesqrt(square) : main;
    }
    spread = cone_spread(dot(main, all.tensor * main) / max(all.area, 1e-12), all.area,
                         light_params.turn[0].w);
    main = dot(all.mean, main) < 0.0 ? -main : main;
    float most = max(max(all.kinds.x, all.kinds.y), max(all.kinds.z, all.kinds.w));
    int kind = all.kinds.x == most ? 0 : all.kinds.y == most ? 1 : all.kinds.z == most ? 2 : 3;
    return kind * LIGHT_CLASSES + class_of(main);
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
    vec3 sent = vec3(0.0);
    for (int light = 0; light < int(light_params.lights); ++light) {
        float passed = find_passed(place, light);
        float lit = 0.0;
        vec3 part = vec3(0.0);
        for (int which = 0; which < classes && passed > 0.0; ++which) {
            float met = sum_of(slot, which, 1 + light);
            if (met == 0.0) continue;
            lit += met;
            part += met * passed * first_of(which, light, d);
        }
        if (gl_LocalInvocationID.x == 0u) cell[slot].lit[light] = lit * passed;
        vec3 color = draw_params.light_color[light].rgb;
        sent += part * color * tint / max(tau, 1e-12);
    }
    if (int(gl_LocalInvocationID.x) >= LIGHT_ORDINATES) return;
    depth[slot * LIGHT_ORDINATES + d] = tau;
    int at = ordinate_address(d, slot);
    for (int k = 0; k < 3; ++k) source[at + k] = sent[k];
    if (d > 0) return;
    cell[slot].tint = vec4(tint, tangents.area);
    float spread;
    cell[slot].places.y = main_class(tangents, spread);
    cell[slot].around = vec4(0.0, 0.0, 0.0, spread);
}
