// SPDX-License-Identifier: MIT
// Projects and shades strands, one for each lane. Writes records of ribbons with their spans
// (block.glsl), and their depths as keys. Particles are left out where the ribbon is straight;
// ribbons outside the picture are left out. A strand determines the slots of its ribbons, so
// nothing depends on the order of lanes. Slots without a ribbon keep the key 0.
#define WALK_BEYOND 2 // additional turns, which end the tip's ribbon
#include "draw/ribbon_walk.glsl"
#include "draw/block.glsl"

const float SLANT = 0.004; // a ribbon's ends may differ by this share of 1/w

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
// The first slot of this part of a batch, in the bound range of the buffers.
layout(location = 0) uniform int first_slot;
// The number of strands; y = 1: strands of the list (block_cull.comp)
layout(location = 1) uniform ivec2 strands;
layout(binding = BIND_LISTED) uniform usamplerBuffer listed;
layout(binding = BIND_STRAND_ID) uniform usamplerBuffer strand_id;
layout(std430, binding = BIND_RIBBONS_OUT) writeonly buffer Ribbons { uvec4 ribbons[]; };
// The bits of each ribbon's depth; 0: no ribbon.
layout(std430, binding = BIND_KEYS_OUT) writeonly buffer Keys { uint keys[]; };
layout(std430, binding = BIND_BLOCK_COUNTS_OUT) buffer Counts { uint counts[]; };

// A ribbon's end, as its record stores it.
struct End {
    vec2 at;
    float inverse_w, half_width;
    RibbonBound bound, bound_before; // of the ribbon that begins here; of the one that ends here
    vec3 color;
};

End make_end(Particle p, vec2 d0, vec2 d1)
{
    vec2 sum = d0 + d1;
    return End(vec2(p.at.x, p.at.y), p.at.inverse_w, outline_half_width(p, vec2(-sum.y, sum.x)),
               ribbon_bound(d1.x, d1.y, d0.x, d0.y), ribbon_bound(d0.x, d0.y, d1.x, d1.y), p.color);
}

// The pixels whose centres the ribbon can reach.
Span find_span(End a, End b, vec2 d, float reach, out bool seen)
{
    vec2 p = a.at - d * ribbon_overhang(a.bound, d.x, d.y, reach),
         q = b.at + d * ribbon_overhang(b.bound_before, d.x, d.y, reach);
    vec2 across = reach * abs(d.yx);
    vec2 low = max(ceil(min(p, q) - across - 0.5), 0.0),
         high = min(floor(max(p, q) + across - 0.5), size - 1.0);
    seen = all(lessThanEqual(low, high));
    float rows = 1.0 / max(abs(d.y), 1e-5);
    return Span(d.x * (d.y < 0.0 ? -rows : rows), reach * rows, ivec4(low, max(high, 0.0)));
}

// Stores a ribbon. False if it misses the picture.
bool store(int slot, End a, End b, float opacity)
{
    vec2 way = b.at - a.at;
    vec2 d = way * inversesqrt(max(dot(way, way), 1e-20));
    bool seen;
    Span span =
        find_span(a, b, d, max(a.half_width, b.half_width) + 0.5 * (abs(d.x) + abs(d.y)), seen);
    seen = seen && opacity >= RIBBON_LEAST_OPACITY && a.inverse_w > 0.0 && b.inverse_w > 0.0 &&
           a.at != b.at;
    if (seen) {
        float depth = 0.5 * (a.inverse_w + b.inverse_w);
        int at = slot * RIBBON_TEXELS;
        ribbons[at] = uvec4(floatBitsToUint(a.at), floatBitsToUint(b.at));
        ribbons[at + 1] = uvec4(pack_levels(vec2(a.half_width, b.half_width)), pack_shorts(a.bound),
                                pack_shorts(b.bound_before),
                                pack_depth(opacity, (b.inverse_w - a.inverse_w) / depth));
        ribbons[at + 2] = uvec4(pack_levels(a.color.rg), pack_levels(vec2(a.color.b, b.color.r)),
                                pack_levels(b.color.gb), floatBitsToUint(depth));
        ribbons[at + 3] = pack_span(span);
        keys[slot] = floatBitsToUint(depth);
    }
    return seen;
}

int slot = 0;  // slot of the strand's first ribbon
int count = 0; // its ribbons so far
// The first end of the ribbon that is not stored yet.
End end =
    End(vec2(0.0), 0.0, 0.0, RibbonBound(0.0, 0.0, 0.0), RibbonBound(0.0, 0.0, 0.0), vec3(0.0));
bool begun = false;

void see_point(Particle p) {}

// A ribbon is sorted by the depth of its middle. A ribbon that reaches far into the hair would
// cover hair that is in front of its far end, so ribbons end early if their depth changes.
bool ends_ribbon(Walk w, int j, Particle p)
{
    bool slants = abs(p.at.inverse_w - w.kept.at.inverse_w) > SLANT * p.at.inverse_w;
    return w.bent > 1.0 || slants || j >= w.points;
}

void put_joint(Walk w, int j, vec2 next)
{
    End b = make_end(w.kept, w.way, next);
    if (begun && store(slot + count, end, b, w.opacity)) ++count;
    end = b;
    begun = j > 1;
}

void main()
{
    int row = lane_index();
    if (row >= (strands.y != 0 ? int(texelFetch(listed, 0).x) : strands.x)) return;
    if (strands.y != 0) row = int(texelFetch(listed, row + 1).x);
    int s = int(material.first_strand) + row;
    slot = first_slot + row * (count_points() - 1);
    walk_strand(s, texelFetch(strand_id, s).x);
    uint group = uint(group_index()) % 64u * 16u;
    atomicAdd(counts[group], uint(count));
    if (count == 0) atomicAdd(counts[group + 1u], 1u);
}
