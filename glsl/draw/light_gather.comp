// SPDX-License-Identifier: MIT
// The light among hair that every particle sends to the eye: light_grid_gather.c. It is the
// radiance of the eight cells around the particle (trilinear), weighted by the share that a fibre
// with the particle's tangent scatters from each ordinate to the eye. These weights are tabulated
// for one direction to the eye, by tangents on an octahedron (bilinear). A particle's tangent is
// turned by the rotation from its own direction to the eye to the table's.
#include "draw/light.h"
#include "draw/material.h"
#include "common/hair_address.glsl"
#include "draw/curve.glsl"
#include "draw/light.glsl"
#include "kernel/cone.h"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(location = 0) uniform int kind;
layout(binding = BIND_LIGHT_ALL) uniform samplerBuffer all_light;
layout(binding = BIND_LIGHT_GATHER) uniform samplerBuffer gather;
layout(binding = BIND_LIGHT_CONE) uniform samplerBuffer cone;
layout(std430, binding = BIND_LIGHT_SLOTS_OUT) readonly buffer Slots { int slots[]; };
layout(std430, binding = BIND_LIGHT_CELLS_OUT) readonly buffer Cells { LightCell cell[]; };
layout(std430, binding = BIND_LIGHT_STATE_OUT) readonly buffer State { LightState state; };
layout(std430, binding = BIND_LIGHT_SEEN_OUT) writeonly buffer Seen { float seen[]; };

// The weight of an ordinate's light towards the eye, interpolated between the four nodes around a
// tangent.
vec3 weight_of(CellTangent at, int d)
{
    int row = (kind * CELL_PATCHES + at.in_patch) * LIGHT_WIDE + wide_address(d, 0);
    vec3 weight;
    for (int c = 0; c < 3; ++c) {
        int node = (row + c * LIGHT_LANES) * CELL_PATCH_NODES + at.node,
            next = node + CELL_PATCH_ROW;
        weight[c] =
            mix(mix(texelFetch(gather, node).x, texelFetch(gather, node + 1).x, at.u),
                mix(texelFetch(gather, next).x, texelFetch(gather, next + 1).x, at.u), at.v);
    }
    return weight;
}

// The slot of the cell at a place, clamped to the lattice. Cells without a slot have the ambient
// light.
int slot_near(ivec3 at) { return slots[cell_address(clamp(at, ivec3(0), cells - 1))]; }

vec3 light_at(int slot, int d)
{
    return slot < 0 ? light_params.around[d].rgb
                    : texelFetch(all_light, slot * LIGHT_ORDINATES + d).rgb;
}

// A row of the cone's table at a tangent.
vec3 cone_row(CellTangent at, int light, int row)
{
    int nodes = (kind * MAX_LIGHTS + light) * CELL_NODES + cell_node(at.in_patch, at.node),
        here = nodes * CONE_ROWS + row, below = here + CELL_NODES_ROW * CONE_ROWS;
    return mix(mix(texelFetch(cone, here).rgb, texelFetch(cone, here + CONE_ROWS).rgb, at.u),
               mix(texelFetch(cone, below).rgb, texelFetch(cone, below + CONE_ROWS).rgb, at.u),
               at.v);
}

// What brings the light of a place back to the cone of its lamps' light (kernel/cone.h). The slots
// and weights of the cells around it.
vec3 narrowing(ivec4 near, ivec4 far, vec4 plane, vec2 along, CellTangent at)
{
    float spread = 0.0, area = 0.0, lit[MAX_LIGHTS];
    vec3 around = vec3(0.0);
    for (int l = 0; l < MAX_LIGHTS; ++l) lit[l] = 0.0;
    for (int q = 0; q < 8; ++q) {
        int slot = q < 4 ? near[q] : far[q - 4];
        if (slot < 0 || slot >= int(state.filled)) continue;
        float weight = plane[q % 4] * along[q / 4];
        area += weight * cell[slot].tint.w;
        spread += weight * cell[slot].tint.w * cell[slot].around.w;
        around += weight * cell[slot].around.rgb;
        for (int l = 0; l < int(light_params.lights); ++l) lit[l] += weight * cell[slot].lit[l];
    }
    float place = cone_place(spread / max(area, 1e-12));
    if (!(place < float(CONE_LAST)) || light_params.lights == 0u) return vec3(1.0);
    int row = int(place);
    vec3 exact = around, grid = around, ratio;
    for (int l = 0; l < int(light_params.lights); ++l) {
        exact += lit[l] * mix(cone_row(at, l, row), cone_row(at, l, row + 1), place - float(row));
        grid += lit[l] * cone_row(at, l, CONE_LAST);
    }
    for (int c = 0; c < 3; ++c) ratio[c] = grid[c] > 0.0 ? cone_ratio(exact[c], grid[c]) : 1.0;
    return ratio;
}

vec3 show(vec3 x, vec3 t)
{
    int own = slots[cell_address(cell_around(x))];
    if (own >= 0 && cell[own].mean.w > 0.0)
        return cell[own].mean.rgb * light_params.albedo[kind].rgb;
    vec3 from = clamp((x - light_params.low.xyz) / side - 0.5, vec3(-0.5), vec3(cells) - 0.5),
         whole = floor(from), high = from - whole, low = 1.0 - high;
    ivec3 at = ivec3(whole);
    ivec4 near = ivec4(slot_near(at), slot_near(at + ivec3(1, 0, 0)),
                       slot_near(at + ivec3(0, 1, 0)), slot_near(at + ivec3(1, 1, 0))),
          far = ivec4(slot_near(at + ivec3(0, 0, 1)), slot_near(at + ivec3(1, 0, 1)),
                      slot_near(at + ivec3(0, 1, 1)), slot_near(at + 1));
    vec4 plane = vec4(low.x * low.y, high.x * low.y, low.x * high.y, high.x * high.y);
    vec3 way = light_params.eye.xyz - x, axis = light_params.eye_axis.xyz;
    CellVector turned = cell_turn(CellVector(t.x, t.y, t.z), CellVector(way.x, way.y, way.z),
                                  CellVector(axis.x, axis.y, axis.z));
    CellTangent tangent = cell_tangent(turned.x, turned.y, turned.z);
    vec3 sum = vec3(0.0);
    for (int d = 0; d < LIGHT_ORDINATES; ++d) {
        vec3 light = low.z * (plane.x * light_at(near.x, d) + plane.y * light_at(near.y, d) +
                              plane.z * light_at(near.z, d) + plane.w * light_at(near.w, d)) +
                     high.z * (plane.x * light_at(far.x, d) + plane.y * light_at(far.y, d) +
                               plane.z * light_at(far.z, d) + plane.w * light_at(far.w, d));
        sum += light * weight_of(tangent, d);
    }
    return sum * narrowing(near, far, plane, vec2(low.z, high.z), tangent);
}

void put(int s, int point, int points, vec3 light)
{
    int at = 3 * particle_address(s, point, points);
    for (int k = 0; k < 3; ++k) seen[at + k] = light[k];
}

// Light at curve points between two particles is interpolated.
void main()
{
    int s = lane_index(), n = int(material.vertex_count), parts = int(material.smooth_parts),
        points = (n - 1) * parts + 1;
    if (s >= int(material.drawn_strands)) return;
    Curve curve = curve_open(particle_address(s, 0, n), n);
    int begin = int(gl_WorkGroupID.z) * PART_SEGMENTS, end = min(begin + PART_SEGMENTS, n - 1);
    if (begin > end) return;
    vec3 here = particle(curve, begin), before = particle(curve, max(begin - 1, 0)),
         last = vec3(0.0);
    for (int j = begin; j <= end; ++j) {
        vec3 after = particle(curve, min(j + 1, n - 1)),
             light = show(to_lattice(here), to_lattice(after - before));
        for (int k = 1; k < parts && j > begin; ++k)
            put(s, (j - 1) * parts + k, points, mix(last, light, float(k) / float(parts)));
        if (j < end || j == n - 1) put(s, j * parts, points, light);
        last = light;
        before = here;
        here = after;
    }
}
