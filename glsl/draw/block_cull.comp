// SPDX-License-Identifier: MIT
// Lists the strands that may be visible, before anything is projected or shaded. Their order in the
// list depends on chance; it does not matter, because a strand's ribbons have slots of their own.
//   HIDING 1: there are opaque surfaces, before or among the hair
//
// A strand is left out if all of its points lie beyond one of the picture's four sides, or before
// the near plane. Between two points it then lies there, too, since the sides are planes in clip
// space.
//
// It is also left out if it is hidden: each of its segments lies in a box of the picture, no part
// of the segment is nearer than its nearest end, and all opaque surfaces around the box are nearer
// than that. One texel of `hiding` tells: for tiles of HIDE_TILE px, and on each further level for
// tiles twice as wide, it has 1/w of the farthest opaque surface in the tile and the eight around
// it. These contain everything that is no farther from a point of the tile than the tile's width.
#include "draw/draw.h"
#include "draw/material.h"
#include "common/hair_address.glsl"
#include "common/hash.h"
#include "draw/curve.glsl"
#include "draw/paint.glsl"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
// How many, then rows; of the whole picture how many, how many hidden.
layout(std430, binding = BIND_LISTED_OUT) buffer Listed { uint listed[]; };
layout(std430, binding = BIND_TALLY_OUT) buffer Tally { uint tally[2]; };
#if HIDING
layout(location = 0) uniform ivec2 tiles; // of level 0: columns, rows
layout(binding = BIND_HIDING) uniform samplerBuffer hiding;
#endif

// Beyond its middle line a ribbon reaches by its half-width and half a pixel's diagonal, and so far
// times 3 along a joint (find_span of block_project.comp), together sqrt(10) times as far; off the
// picture's middle a cylinder's outline is wider than its radius (outline_half_width).
const float MITRE = 3.5, PIXEL = 0.75;

// Where a ribbon runs straight from a to b its 1/w is off by 1e-3 at most (bend of ribbon.glsl),
// and by 2^-10 for its half of a change (block.glsl): twice that.
const float NEARER = 1.0 + 1.0 / 256.0;

mat4 clip_from_world = draw_params.clip_from_world;
vec2 size = vec2(draw_params.width, draw_params.height);
float focal = draw_params.focal, near_distance = draw_params.near_distance;
vec2 pad = 1.0 + 2.0 * MITRE * PIXEL / size;
// A metre of radius.
vec2 reach =
    2.0 * max(draw_params.axis.xy, size - draw_params.axis.xy); // off the eye's axis, twice
vec2 wide = 2.0 * MITRE * focal * sqrt(1.0 + dot(reach, reach) / (focal * focal)) / size;

// What is known of a strand so far, in clip space.
vec4 least = vec4(1e30); // distance beyond: left, top, right, bottom
float farthest = -1e30;

// All that a point may be drawn on.
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
    // Nothing opaque is so near that it could hide what is nearer still.
    float near = 1.0 / max(clip.w, near_distance);
    vec2 at = (0.5 * clip.xy * near + 0.5) * size,
         reach = 0.5 * size * (pad - 1.0 + wide * radius * near);
    return Box(at - reach, at + reach, near);
#else
    return Box(vec2(0.0), vec2(0.0), 0.0);
#endif
}

Box both(Box a, Box b) { return Box(min(a.low, b.low), max(a.high, b.high), max(a.near, b.near)); }

// Whether all of it lies behind what is opaque.
bool is_hidden(Box box)
{
#if HIDING
    const float MOST = float(HIDE_TILE << (HIDE_LEVELS - 1));
    vec2 half_side = 0.5 * (box.high - box.low),
         middle = clamp(0.5 * (box.low + box.high), vec2(0.0), size - 1.0);
    float reach = max(half_side.x, half_side.y);
    // The exponent, and one more.
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
