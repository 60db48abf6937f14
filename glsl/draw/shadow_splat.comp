// SPDX-License-Identifier: MIT
// Draws strands into a shadow map, as points along their segments and, if these are wide, across
// them.
//   DEEP 0: the map keeps first depths   1: mean numbers of fibres in layers
//   COARSE 1: first depths of a coarse map
//
// Each point carries a part of the ribbon's area times its opacity (own_layer_depth in
// shared_math.h says why). Sums are integers, so their order does not matter. The ribbons are the
// drawn ones: with curves, thickness, opacity and the share of strands (material.h).
#include "draw/shadow.h"
#include "draw/material.h"
#include "common/hair_address.glsl"
#include "common/hash.h"
#include "draw/curve.glsl"
#include "draw/paint.glsl"
#include "draw/shadow_cast.glsl"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
#if DEEP
layout(binding = BIND_DEPTHS) uniform samplerBuffer depths;
layout(std430, binding = BIND_SUMS_OUT) buffer Sums { uint sums[]; };
#else
layout(std430, binding = BIND_FIRST_OUT) buffer First { uint first[]; };
#endif

#if DEEP
const float DENSITY = CASTER_DEEP, WIDE_DENSITY = CASTER_DEEP_WIDE, SLACK = 0.0;
#elif COARSE
const float DENSITY = CASTER_COARSE, WIDE_DENSITY = CASTER_FIRST_WIDE, SLACK = CASTER_COARSE_SLACK;
#else
const float DENSITY = CASTER_FIRST, WIDE_DENSITY = CASTER_FIRST_WIDE, SLACK = 0.0;
#endif
// Limits the points of a segment: llvmpipe silently ends loops after 65,535 iterations of a lane.
const float MOST = 60000.0 / float(PART_SEGMENTS);

float point_radius(Painter painter, Curve curve, int k)
{
    float place = curve_place(curve, k);
    return paint_radius(painter, curve.root + int(place) * STRAND_TILE, place);
}

void main()
{
    int s = lane_index(), n = int(material.vertex_count);
    int root = particle_address(s, 0, n);
    Curve curve = curve_open(root, n);
    int begin = int(gl_WorkGroupID.z) * PART_SEGMENTS;
    int end = min(begin + PART_SEGMENTS, curve.segments * curve.parts);
    if (s >= int(material.drawn_strands) || begin >= end) return;
    Painter painter = paint_strand(0u, n); // the colour is not used
    if (s == int(material.last_strand)) painter.radius *= material.last_share;
    float opacity = material.shadow_opacity * paint_opacity_share(root);
    float texels = cast_params.texels, unit = cast_params.unit, edge = float(side) - 0.5;
    int map = cast_params.map * side * side;
    vec4 a = shadow_place(curve_point(curve, begin));
    float radius = point_radius(painter, curve, begin);
    for (int j = begin; j < end; ++j) {
        vec4 b = shadow_place(curve_point(curve, j + 1));
        float next_radius = point_radius(painter, curve, j + 1);
        vec2 way = b.xy - a.xy;
        float size = length(way), width = caster_width(texels, radius, next_radius, a.w, b.w);
        bool wide = width > CASTER_WIDE;
        float density = wide ? WIDE_DENSITY : DENSITY, along = caster_along(size, density, SLACK);
        float across = wide ? clamp(ceil(width * density), 1.0, floor(MOST / along)) : 1.0;
#if DEEP
        uint part = caster_part(fibre_depth(opacity, width), width, size, unit, along * across);
#endif
        vec2 beside = vec2(-way.y, way.x) * (width / max(size, 1e-9)) / across;
        vec3 step = vec3(way, b.z - a.z) / along, at = a.xyz + 0.5 * step;
        at.xy -= 0.5 * (across - 1.0) * beside;
        int count = int(along * across), column = 0, columns = int(across);
        for (int k = 0; k < count; ++k) {
            vec2 here = at.xy + float(column) * beside;
            ivec2 texel = ivec2(clamp(here, 0.0, edge));
            bool inside = here == clamp(here, 0.0, edge);
            int place = texel.y * side + texel.x;
#if DEEP
            int layer = int(layer_of(at.z - texelFetch(depths, map + place).x));
            if (inside) atomicAdd(sums[map * SHADOW_LAYERS + layer * side * side + place], part);
#else
            uint depth = uint(int(clamp(at.z, 0.0, 1.0) * float(SHADOW_DEPTHS)));
            // Reading first saves most atomics; a read costs a quarter of an atomic.
            if (inside && depth < first[map + place]) atomicMin(first[map + place], depth);
#endif
            ++column;
            if (column == columns) {
                column = 0;
                at += step;
            }
        }
        a = b;
        radius = next_radius;
    }
}
