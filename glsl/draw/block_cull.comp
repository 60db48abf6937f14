// SPDX-License-Identifier: MIT
// Lists the strands that may be visible, before anything is projected or shaded. Their order in the
// list depends on chance; it does not matter, because a strand's ribbons have slots of their own.
//   HIDING 1: there are opaque surfaces, before or among the hair
//
// A strand is left out if all of its points lie outside the same side of the picture, or in front
// of the near plane. The sides are planes in clip space, so everything between two such points lies
// outside, too.
//
// A strand is also left out if it is hidden. It is hidden if this is true of each segment: no part
// of the segment is nearer than its nearer end, and all opaque surfaces around the segment's box in
// the picture are nearer than that. One texel of `hiding` gives the answer: it has 1/w of the
// farthest opaque surface in a tile and the eight tiles around it. Tiles have HIDE_TILE px, on each
// further level twice as much. The nine tiles contain everything that is no farther from a point of
// the tile than the tile's width.
#include "draw/draw.h"
#include "draw/material.h"
#include "common/hair_address.glsl"
#include "common/hash.h"
#include "draw/curve.glsl"
#include "draw/paint.glsl"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
// listed: their number, then rows. tally: of the whole picture, the number of listed strands and of
// hidden strands.
layout(std430, binding = BIND_LISTED_OUT) buffer Listed { uint listed[]; };
layout(std430, binding = BIND_TALLY_OUT) buffer Tally { uint tally[2]; };
#if HIDING
layout(location = 0) uniform ivec2 tiles; // columns, rows of level 0
layout(binding = BIND_HIDING) uniform samplerBuffer hiding;
#endif

// A ribbon reaches beyond its middle line by its half-width plus half a pixel's diagonal, and along
// a joint by 3 times as much (find_span in block_project.comp), together by sqrt(10) times as much.
// Off the picture's middle a cylinder's outline is wider than its radius (outline_half_width).
const float MITRE = 3.5, PIXEL = 0.75;

// Where a ribbon runs straight from a to b, the error of its 1/w is at most 1e-3 (bend in
// ribbon.glsl), plus 2^-10 from storing a change in half precision (block.glsl). This factor is
// twice that.
const float NEARER = 1.0 + 1.0 / 256.0;

mat4 clip_from_world = draw_params.clip_from_world;
vec2 size = vec2(draw_params.width, draw_params.height);
float focal = draw_params.focal, near_distance = draw_params.near_distance;
vec2 pad = 1.0 + 2.0 * MITRE * PIXEL / size;
// px of a metre of radius.
vec2 reach =
    2.0 * max(draw_params.axis.xy, size - draw_params.axis.xy); // off the eye's axis, twice
vec2 wide = 2.0 * MITRE * focal * sqrt(1.0 + dot(reach, reach) / (focal * focal)) / size;

// Properties of a strand that are found point by point, in clip space.
vec4 least = vec4(1e30); // distance beyond: left, top, right, bottom
float farthest = -1e30;

// All pixels that a point may be drawn to.
struct Box {
    vec2 low, high; // px
    float near;     // 1/w
};

Box see(vec3 x, float radius)
{
    vec4 clip = clip_from_world * vec4(x, 1.0);
    vec2 side = pad * clip.w + wide * radius;
    least = min(least, vec4(-clip.xy - side, clip.xy - side));
    farthest = max(farthest, clip.w);
#if HIDING
    // Nothing nearer can be hidden by opaque surfaces.
    float near = 1.0 / max(clip.w, near_distance);
    vec2 at = (0.5 * clip.xy * near + 0.5) * size,
         reach = 0.5 * size * (pad - 1.0 + wide * radius * near);
    return Box(at - reach, at + reach, near);
#else
    return Box(vec2(0.0), vec2(0.0), 0.0);
#endif
}

Box both(Box a, Box b) { return Box(min(a.low, b.low), max(a.high, b.high), max(a.near, b.near)); }

// Whether the whole box lies behind opaque surfaces.
bool is_hidden(Box box)
{
#if HIDING
    const float MOST = float(HIDE_TILE << (HIDE_LEVELS - 1));
    vec2 half_side = 0.5 * (box.high - box.low),
         middle = clamp(0.5 * (box.low + box.high), vec2(0.0), size - 1.0);
    float reach = max(half_side.x, half_side.y);
    // The exponent of the size, plus one.
    int level = clamp((floatBitsToInt(reach / float(HIDE_TILE)) >> 23) - 126, 0, HIDE_LEVELS - 1);
    ivec2 tile = ivec2(middle) / HIDE_TILE >> level;
    float farthest_opaque = texelFetch(hiding, (level * tiles.y + tile.y) * tiles.x + tile.x).x;
    return box.near * NEARER < farthest_opaque && reach < MOST;
#else
    return false;
#endif
}

void main()
{
    int n = int(material.vertex_count), row = lane_index(), s = int(material.first_strand) + row;
    if (row >= int(material.drawn_strands)) return;
    int root = particle_address(s, 0, n), j = 1;
    Painter painter = paint_strand(0u, n);
    Curve curve = curve_open(root, n);
    bool hidden = true;
    float radius = paint_radius(painter, root, 0.0);
#if !SMOOTH
    Box before = see(particle(curve, 0), radius);
#endif
    do {
        float own = paint_radius(painter, root + j * STRAND_TILE, float(j));
#if SMOOTH
        vec3 hull[4] = curve_hull(curve, j - 1);
        float widest = max(radius, own);
        Box box = both(both(see(hull[0], widest), see(hull[1], widest)),
                       both(see(hull[2], widest), see(hull[3], widest)));
#else
        Box here = see(particle(curve, j), own), box = both(before, here);
        before = here;
#endif
        radius = own;
        hidden = is_hidden(box) && hidden;
    } while (++j < n);
    bool outside = any(greaterThan(least, vec4(0.0))) || farthest < near_distance;
    hidden = hidden && !outside;
    if (hidden) atomicAdd(tally[1], 1u);
    if (outside || hidden) return;
    atomicAdd(tally[0], 1u);
    listed[1u + atomicAdd(listed[0], 1u)] = uint(row);
}
