// SPDX-License-Identifier: MIT
// Projects and shades every particle once, a strand a lane, and leaves out what cannot be seen:
// strands off the screen, and particles where the ribbon is straight. Vertices are worked on one by
// one and, by CPU drivers, on one thread: fewer of them is what makes drawing fast.
//
// On the screen a ribbon's edges run at the half-width h beside its middle line; here both are
// pushed out to h + PAD, so that every pixel that the ribbon touches gets a fragment. At a joint
// the edges of both segments meet on the mitre, at m (h + PAD) with m = (n0 + n1) / (1 + n0.n1), n
// the segments' unit normals: no gap, no double coverage, and the distance to either middle line
// is h + PAD exactly, so that interpolating it is exact, too. At both ends of the strand the ribbon
// is PAD longer, and the distance beyond its end is interpolated like that. Where a strand folds back, m is kept
// from growing.
#include "draw/draw.h"
#include "draw/material.h"
#include "common/hair_address.glsl"
#include "common/hash.glsl"
#include "draw/curve.glsl"
#include "draw/paint.glsl"
#include "draw/shade.glsl"
#include "draw/ribbon.glsl"

layout(local_size_x = GROUP_SIZE) in;
layout(location = 0) uniform ivec2 strands; // how many; 1: they are those of the list (block_cull.comp)
layout(binding = BIND_LISTED) uniform usamplerBuffer listed;
layout(binding = BIND_STRAND_ID) uniform usamplerBuffer strand_id;
layout(std430, binding = BIND_EDGES_OUT) writeonly buffer Edges { uvec4 edges[]; };
layout(std430, binding = BIND_SHADES_OUT) writeonly buffer Shades { uvec4 shades[]; };
layout(std430, binding = BIND_INDICES_OUT) writeonly buffer Indices { uint indices[]; };
layout(std430, binding = BIND_COMMAND_OUT) buffer Command { uint command[]; };
layout(std430, binding = BIND_COUNTERS_OUT) buffer Counters { uint counters[]; };
layout(std430, binding = BIND_EXTENT_OUT) buffer Extent { int extent[4]; }; // x, y lowest, highest

// px. Edges reach PAD beyond the ribbon: of segments that are much shorter and turn, as of hair that points at the eye,
// many cover the same pixel each by itself, and hide more than there is.
const float LEAST_WAY = 0.5;
const float FAR = 3e4; // px: ends farther off than the picture is long; a half still holds it

// Stores the particle for the vertex shader: d0 and d1 the directions of the ribbon before and after it, `beyond` the
// ends' distances along the strand, both -PAD at its own end.
void store(int index, Particle p, vec2 d0, vec2 d1, vec2 beyond, float opacity)
{
    if (d0 == vec2(0.0)) d0 = d1;
    if (d1 == vec2(0.0)) d1 = d0;
    vec2 normal = vec2(-d0.y - d1.y, d0.x + d1.x);
    float half_width = outline_half_width(p, normal);
    vec2 edge = normal * ((half_width + PAD) / max(1.0 + dot(d0, d1), LEAST_COSINE));
    vec2 middle = p.at.xy + min(beyond.x, 0.0) * d1 - min(beyond.y, 0.0) * d0;
    edges[index] = uvec4(floatBitsToUint(middle), packHalf2x16(edge), packHalf2x16(beyond));
    shades[index] = uvec4(floatBitsToUint(p.at.z), floatBitsToUint(half_width), packHalf2x16(p.color.rg),
                          packHalf2x16(vec2(p.color.b, opacity)));
}

// Two triangles for each of the `count` - 1 segments from the particle `first` on.
void emit_segments(int first, int count)
{
    int at = int(atomicAdd(command[COMMAND_INDEX_COUNT], uint(6 * (count - 1))));
    atomicAdd(counters[COUNTER_SEGMENTS], uint(count - 1));
    for (int k = 0; k < count - 1; ++k, at += 6) {
        uint v = uint(2 * (first + k));
        indices[at] = v;
        indices[at + 1] = v + 1u;
        indices[at + 2] = v + 2u;
        indices[at + 3] = v + 2u;
        indices[at + 4] = v + 1u;
        indices[at + 5] = v + 3u;
    }
}

void main()
{
    int n = int(material.vertex_count);
    int row = int(gl_GlobalInvocationID.x);
    if (row >= strands.x) return;
    int s = int(material.first_strand) + (strands.y != 0 ? int(texelFetch(listed, row + 2).x) : row);
#if SMOOTH
    int first = row * ((n - 1) * int(material.smooth_parts) + 1); // place of the root
#else
    int first = row * n;
#endif
    int root = particle_address(s, 0, n);
    Painter painter = paint_strand(texelFetch(strand_id, s).x, n);
    if (s == int(material.last_strand)) painter.radius *= material.last_share;
    float opacity = paint_opacity(root);
    vec3 eye = draw_params.eye.xyz;
    Fibre fibre = fibre_material();
#if SHADOW
    float shadow_opacity = material.shadow_opacity * paint_opacity_share(root);
#endif

    Curve curve = curve_open(root, n);
    int points = curve.segments * curve.parts + 1;
#if SHADOW
    int lit = particle_address(s, 0, points); // where light at the strand's points has been found
#endif
    vec3 here = curve_point(curve, 0), before = here;
    vec4 here_clip = clip_from_world * vec4(here, 1.0), before_clip = here_clip;
    vec4 box = vec4(1e6);
    Particle kept = Particle(vec4(0.0), vec3(0.0)), last = kept; // the last one not left out; the one before this one
    vec2 way = vec2(0.0); // the ribbon's direction before `kept`
    float bent = 0.0;     // of all that was left out since `kept`
    float from_root = -PAD; // of `kept`, px
    int count = 0;
    for (int j = 0; j < points; ++j) {
        float place = curve_place(curve, j);
        int at = root + int(place) * STRAND_TILE;
        vec3 after = curve_point(curve, j + 1);
        vec4 after_clip = clip_from_world * vec4(after, 1.0);
        Particle p;
        float radius = paint_radius(painter, at, place);
        p.at = project(clip_near(here_clip, before_clip, after_clip), radius);
#if SHADOW
        shadow_fibre = vec2(2.0 * radius, shadow_opacity);
        shadow_find(lit + j * STRAND_TILE, here);
#endif
        p.color = shade_particle(fibre, painter, at, here, unit(after - before), unit(eye - here));
        float reach = MITRE_MAX * (p.at.w + 1.0);
        if (p.at.z > 0.0) box = min(box, vec4(p.at.xy, -p.at.xy) - reach);
        if (j > 1) bent += bend(kept, last, p);
        if (j == 1 || (bent > 1.0 && distance(kept.at.xy, last.at.xy) > LEAST_WAY)) {
            vec2 next = direction(kept, last);
            if (j > 1) {
                store(first + count++, kept, way, next, vec2(from_root, FAR), opacity);
                from_root = min(max(from_root, 0.0) + distance(kept.at.xy, last.at.xy), FAR);
            }
            way = next;
            kept = last;
            bent = 0.0;
        }
        last = p;
        before = here;
        before_clip = here_clip;
        here = after;
        here_clip = after_clip;
    }
    vec2 next = direction(kept, last);
    float left = min(distance(kept.at.xy, last.at.xy), FAR);
    store(first + count++, kept, way, next, vec2(from_root, left), opacity);
    store(first + count++, last, next, next, vec2(min(max(from_root, 0.0) + left, FAR), -PAD), opacity);

    ivec4 whole = ivec4(floor(clamp(box, -1e6, 1e6)));
    bool in_picture = whole.x < int(size.x) && -whole.z > 0 && whole.y < int(size.y) && -whole.w > 0;
    bool in_band = whole.y < int(draw_params.band.z) && -whole.w > int(draw_params.band.y);
    if (!in_picture && draw_params.band.y == 0u) atomicAdd(counters[COUNTER_CULLED], 1u);
    if (!in_picture || !in_band) return;
    emit_segments(first, count);
    atomicMin(extent[0], whole.x);
    atomicMin(extent[1], whole.y);
    atomicMax(extent[2], -whole.z);
    atomicMax(extent[3], -whole.w);
}
