// SPDX-License-Identifier: MIT
// Projects and shades every particle once, a strand for each lane. Strands outside the picture are
// left out, as are particles where the ribbon is straight. CPU drivers process vertices one by one
// in one thread, so fewer vertices make drawing faster.
//
// On the screen a ribbon's edges run at the half-width h beside its middle line. Here both are
// moved outwards to h + PAD, so that every pixel that the ribbon touches gets a fragment. At a
// joint the edges of both segments meet on the mitre, at m (h + PAD) with m = (n0 + n1) / (1 +
// n0.n1), where n0 and n1 are the segments' unit normals. So there is no gap and no double
// coverage, and the distance to either middle line is exactly h + PAD, so that its interpolation is
// exact. At both ends of the strand the ribbon is PAD longer, and the distance beyond its end is
// interpolated in the same way.
// Where a strand folds back, |m| is limited.
#define WALK_BEYOND 0
#include "draw/ribbon_walk.glsl"

const float PAD = 0.71;      // px; the corner of a pixel is sqrt(1/2) from its middle
const float MITRE_MAX = 2.9; // limit of |m|: the maximum of sqrt(2 x) / max(x, RIBBON_FOLD) over x

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
// The number of strands; y = 1: strands of the list (block_cull.comp)
layout(location = 0) uniform ivec2 strands;
layout(binding = BIND_LISTED) uniform usamplerBuffer listed;
layout(binding = BIND_STRAND_ID) uniform usamplerBuffer strand_id;
layout(std430, binding = BIND_EDGES_OUT) writeonly buffer Edges { uvec4 edges[]; };
layout(std430, binding = BIND_SHADES_OUT) writeonly buffer Shades { uvec4 shades[]; };
layout(std430, binding = BIND_INDICES_OUT) writeonly buffer Indices { uint indices[]; };
layout(std430, binding = BIND_COMMAND_OUT) buffer Command { uint command[]; };
layout(std430, binding = BIND_COUNTERS_OUT) buffer Counters { uint counters[]; };
layout(std430, binding = BIND_EXTENT_OUT) buffer Extent { int extent[4]; }; // x, y lowest, highest

// px: the shortest segment. Edges reach PAD beyond the ribbon. Where hair points at the eye, many
// much shorter segments with changing directions would each cover the same pixel, and together hide
// too much.
const float LEAST_WAY = 0.5;
const float FAR = 3e4; // px: stands for "far outside the picture"; fits into a half float

// Stores the particle for the vertex shader. d0 and d1: directions of the ribbon before and after
// it; `beyond`: distances along the strand beyond its two ends, -PAD at the respective end.
void store(int index, Particle p, vec2 d0, vec2 d1, vec2 beyond, float opacity)
{
    if (d0 == vec2(0.0)) d0 = d1;
    if (d1 == vec2(0.0)) d1 = d0;
    vec2 normal = vec2(-d0.y - d1.y, d0.x + d1.x);
    float half_width = outline_half_width(p, normal);
    vec2 edge = normal * ((half_width + PAD) / max(1.0 + dot(d0, d1), RIBBON_FOLD));
    vec2 middle = vec2(p.at.x, p.at.y) + min(beyond.x, 0.0) * d1 - min(beyond.y, 0.0) * d0;
    edges[index] = uvec4(floatBitsToUint(middle), packHalf2x16(edge), packHalf2x16(beyond));
    shades[index] = uvec4(floatBitsToUint(p.at.inverse_w), floatBitsToUint(half_width),
                          packHalf2x16(p.color.rg), packHalf2x16(vec2(p.color.b, opacity)));
}

// Two triangles for each of the `count` - 1 segments that begin at the particle `first`.
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

int first = 0;          // index of the strand's root
int count = 0;          // its kept points
float from_root = -PAD; // px: distance of the walk's `kept` from the root
vec4 box = vec4(1e6);   // px: least x, y, -x, -y

void see_point(Particle p)
{
    float reach = MITRE_MAX * (p.at.half_width + 1.0);
    vec2 at = vec2(p.at.x, p.at.y);
    if (p.at.inverse_w > 0.0) box = min(box, vec4(at, -at) - reach);
}

bool ends_ribbon(Walk w, int j, Particle p)
{
    return w.bent > 1.0 && length(way_from(w.kept, w.last)) > LEAST_WAY;
}

void put_joint(Walk w, int j, vec2 next)
{
    if (j > 1) {
        store(first + count++, w.kept, w.way, next, vec2(from_root, FAR), w.opacity);
        from_root = min(max(from_root, 0.0) + length(way_from(w.kept, w.last)), FAR);
    }
}

void main()
{
    int row = lane_index();
    if (row >= (strands.y != 0 ? int(texelFetch(listed, 0).x) : strands.x)) return;
    int s =
        int(material.first_strand) + (strands.y != 0 ? int(texelFetch(listed, row + 1).x) : row);
    first = row * count_points();
    Walk w = walk_strand(s, texelFetch(strand_id, s).x);
    vec2 next = direction(w.kept, w.last);
    float left = min(length(way_from(w.kept, w.last)), FAR);
    store(first + count++, w.kept, w.way, next, vec2(from_root, left), w.opacity);
    store(first + count++, w.last, next, next, vec2(min(max(from_root, 0.0) + left, FAR), -PAD),
          w.opacity);

    ivec4 whole = ivec4(floor(clamp(box, -1e6, 1e6)));
    bool in_picture =
        whole.x < int(size.x) && -whole.z > 0 && whole.y < int(size.y) && -whole.w > 0;
    bool in_band = whole.y < int(draw_params.band.z) && -whole.w > int(draw_params.band.y);
    if (!in_picture && draw_params.band.y == 0u) atomicAdd(counters[COUNTER_CULLED], 1u);
    if (!in_picture || !in_band) return;
    emit_segments(first, count);
    atomicMin(extent[0], whole.x);
    atomicMin(extent[1], whole.y);
    atomicMax(extent[2], -whole.z);
    atomicMax(extent[3], -whole.w);
}
