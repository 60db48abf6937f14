// SPDX-License-Identifier: MIT
// Cuts segments into parts that lie in one cell each, and adds them up for each cell:
// light_grid_items.c, with sums instead of a sorted list. The sums are integers of two words, so
// the order of additions does not matter.
//   ITEMS 0: marks the cells
//   ITEMS 1: adds up areas divided by a side's square, by cell and class of tangent, and painted
//       hair's also by colour
//   ITEMS 2: adds up the parts of these areas that light `light` reaches
//   SHADOW 2: light `light` has a shadow map of hair; 0: it has none
#include "draw/light.h"
#include "draw/material.h"
#include "common/hair_address.glsl"
#include "common/hash.h"
#include "draw/curve.glsl"
#include "draw/paint.glsl"
#define LIGHTS         1
#define LIGHT_COUNT    0
#define SHADOW_BY_MESH 0
#include "draw/lights.glsl"
#include "draw/light.glsl"
#include "draw/light_class.glsl"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(std430, binding = BIND_LIGHT_SLOTS_OUT) buffer Slots { int slots[]; };
#if ITEMS
layout(location = 0) uniform int kind;
layout(location = 2) uniform ivec2 range; // slots: first, end
#if ITEMS == 2
layout(location = 1) uniform int light;
#endif
layout(std430, binding = BIND_LIGHT_CELLS_OUT) buffer Cells { LightCell cell[]; };
// [slot][class][1 + lights][2]: the area, and the area that each light reaches
layout(std430, binding = BIND_LIGHT_SUMS_OUT) buffer Sums { uint sums[]; };
#endif

// Segment j of a strand.
struct Segment {
    vec3 a, b;  // ends in the world, m
    float area; // 2 r length opacity / side^2, in steps
};

Segment find_segment(Curve curve, Painter painter, int j)
{
    vec3 a = particle(curve, j), b = particle(curve, j + 1);
    float far = length(b - a), share = 1.0 - painter.thinning * (float(j) + 0.5);
    if (!(far > 0.0 && far < 1e6)) return Segment(a, b, 0.0);
#if PAINT
    int at = curve.root + j * STRAND_TILE;
    share = 0.5 * (uintBitsToFloat(texelFetch(paint, at).z) +
                   uintBitsToFloat(texelFetch(paint, at + STRAND_TILE).z));
#endif
    float weight = float(material.drawn_strands) /
                   float(cell_strands(material.drawn_strands, light_params.step));
    return Segment(a, b,
                   2.0 * painter.radius * share * far * material.shadow_opacity *
                       paint_opacity_share(curve.root) * (weight * LIGHT_STEPS / (side * side)));
}

uint steps_of(float x) { return uint(clamp(x, 0.0, 4e9) + 0.5); }

#if ITEMS
void add(int at, uint value)
{
    uint before = atomicAdd(sums[at], value);
    if (before + value < before) atomicAdd(sums[at + 1], 1u);
}

int sums_address(int slot, Segment s)
{
    int which = kind * LIGHT_CLASSES + class_of(to_lattice(s.b - s.a));
    return 2 * ((slot - range.x) * int(light_params.classes) + which) *
           (1 + int(light_params.lights));
}
#endif

#if ITEMS == 1
// The albedo of a colour over the albedo of the mean colour.
vec3 tint_of(int at)
{
    vec3 albedo = material.mean_albedo.rgb;
#if PAINT
    uvec2 texel = texelFetch(paint, at).xy;
    vec3 color = vec3(unpackUnorm2x16(texel.x), unpackUnorm2x16(texel.y).x);
    albedo = material.albedo.x + (1.0 - material.albedo.x) * pow(color, vec3(material.albedo.y));
#endif
    return albedo / max(material.mean_albedo.rgb, 1e-6);
}

void put(Segment s, int slot, int at, float area)
{
    add(sums_address(slot, s), steps_of(area));
    if (light_params.tinted == 0u) return;
    vec3 tint = area * tint_of(at);
    for (int k = 0; k < 3; ++k) {
        uint value = steps_of(tint[k]), before = atomicAdd(cell[slot].tints[k], value);
        if (before + value < before) atomicAdd(cell[slot].carry[k], 1u);
    }
}
#elif ITEMS == 2
// The share of the light that hair lets through to particle j, at its place on the curve.
float find_left(Curve curve, Painter painter, int j)
{
#if SHADOW
    int map = int(light_params.way[light].w);
    shadow_fibre = vec2(2.0 * paint_radius(painter, curve.root + j * STRAND_TILE, float(j)),
                        material.shadow_opacity * paint_opacity_share(curve.root));
    return hair_leaves(map, curve_point(curve, j * curve.parts));
#else
    return 1.0;
#endif
}

// The share of a lamp's colour that arrives at x.
float find_lamp(vec3 x)
{
    vec3 to_light;
    return draw_params.light_place[light].w == 0.0
               ? 1.0
               : min(light_share(light, x, to_light), CELL_LAMP_MOST);
}
#endif

void main()
{
    uint lane = uint(lane_index());
    if (lane >= cell_strands(material.drawn_strands, light_params.step)) return;
    int s = int(cell_strand(lane, material.drawn_strands, light_params.step)),
        n = int(material.vertex_count), pieces = int(light_params.pieces);
    Curve curve = curve_open(particle_address(s, 0, n), n);
    Painter painter = paint_strand(0u, n);
    if (s == int(material.last_strand)) painter.radius *= material.last_share;
    int begin = int(gl_WorkGroupID.z) * PART_SEGMENTS, end = min(begin + PART_SEGMENTS, n - 1);
    if (begin >= end) return;
#if ITEMS == 2
    float before = find_left(curve, painter, begin);
#endif
    for (int j = begin; j < end; ++j) {
        Segment segment = find_segment(curve, painter, j);
#if ITEMS == 2
        float after = find_left(curve, painter, j + 1);
#endif
        vec3 way = segment.b - segment.a;
        float far = length(way);
        for (int piece = 0; piece < pieces && far > 0.0 && far < 1e6; ++piece) {
            float on = (float(piece) + 0.5) / float(pieces);
            vec3 x = segment.a + on * way;
            int at = cell_address(cell_around(to_lattice(x)));
#if ITEMS == 0
            slots[at] = 1;
#else
            int slot = slots[at];
            float area = segment.area / float(pieces);
            if (slot < range.x || slot >= range.y) continue;
#if ITEMS == 1
            put(segment, slot, curve.root + j * STRAND_TILE, area);
#else
            add(sums_address(slot, segment) + 2 * (1 + light),
                steps_of(mix(before, after, on) * area * find_lamp(x)));
#endif
#endif
        }
#if ITEMS == 2
        before = after;
#endif
    }
}
