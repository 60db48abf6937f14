// SPDX-License-Identifier: MIT
// Composites tiles that have ribbons, one for each work group. The ribbons of the tile's list are
// blended from near to far, each behind the ones before it, premultiplied and in linear light. The
// result lies over the base or background and is converted to colours. The arithmetic is that of
// src/lanes/composite.c and pixels.c.
//   PIXELS 1, 4: pixels of a lane, one above the other; GROUP_SIZE: lanes of a tile
//   STAGED 1: ribbons are unpacked once, to shared memory   0: each lane unpacks them itself
//   BASE 1: mesh or floor hide ribbons behind them; see also compute_pixels.glsl
//   RIMS 1: the base has rims; needs BASE 1, NEAREST 0
//   NEAREST 1: a ribbon that covers RIBBON_LEAST_COVERAGE of a pixel hides everything behind it
//   DEPTH 1: the pixel shows the nearest ribbon's distance
//   SAMPLES, KIND, TONE: see compute_pixels.glsl
//
// The work group takes BATCH ribbons at a time. Its lanes find the cells that each ribbon touches
// and set a bit for the ribbon in the cell's mask. Then each cell's lanes go through the mask from
// its lowest bit. So the order in which bits are set does not matter. A cell is skipped once less
// than RIBBON_LEAST_THROUGH is visible through each of its pixels.
#if PIXELS == 4
#define REAL vec4
#else
#define REAL float
#endif
#include "draw/draw.h"
#include "kernel/edge.h"
#include "draw/block.glsl"
#include "draw/compute_pixels.glsl"
#include "draw/compute_strip.glsl"

#define CELL_LANES (TILE_CELL_WIDTH * TILE_CELL_HEIGHT / PIXELS)

layout(local_size_x = GROUP_SIZE) in;
layout(location = 0) uniform int tile_columns;
layout(location = 1) uniform uint room; // pairs
layout(binding = BIND_RIBBONS) uniform usamplerBuffer ribbons;
layout(binding = BIND_SORTED) uniform usamplerBuffer sorted;
layout(std430, binding = BIND_TILE_COUNTS_OUT) readonly buffer Counts { uint counts[]; };
layout(std430, binding = BIND_TILE_ENDS_OUT) readonly buffer Ends { uint ends[]; };
layout(std430, binding = BIND_TILE_USE_OUT) readonly buffer Use { uint use[TILE_USE_WORDS]; };
layout(std430, binding = BIND_TILES_OUT) readonly buffer Tiles { uint tiles[]; };

// A number for each of a lane's pixels.
#define Numbers REAL
#if PIXELS == 4
#define OF(v, k)   v[k]
#define LARGEST(v) max(max(v.x, v.y), max(v.z, v.w))
#define ROWS       vec4(0.0, 1.0, 2.0, 3.0)
#else
#define OF(v, k)   v
#define LARGEST(v) v
#define ROWS       0.0
#endif

const int CELLS_ACROSS = TILE_SIDE / TILE_CELL_WIDTH, // 2
    CELLS = CELLS_ACROSS * (TILE_SIDE / TILE_CELL_HEIGHT), BATCH = 128, WORDS = BATCH / 32;

// Masks of this batch and of the next one, in turn.
shared uint masks[2 * CELLS * WORDS];
shared int open_from[CELLS]; // the batch for which the cell is open

uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
int tile = int(tiles[min(group, max(use[TILE_USE_TILES], 1u) - 1u)]);
ivec2 corner = ivec2(tile % tile_columns, tile / tile_columns) * TILE_SIDE;
// The centre of the first pixel of the block that contains the tile; src/lanes counts pixels from
// there.
ivec2 block = corner / ivec2(BLOCK_WIDTH, BLOCK_HEIGHT) * ivec2(BLOCK_WIDTH, BLOCK_HEIGHT);
vec2 origin = vec2(block) + 0.5;

// --- Ribbons.

struct Ribbon {
    // at, by_x, by_y: linear functions, at the block's first pixel and per column and row: distance
    // from the middle line, share of the length, share of a pixel that the first end and the last
    // end do not cut off.
    vec4 at, by_x, by_y;
    vec4 width; // px: half-width at the first end, its change to the last; inner, outer
    vec4 cover; // factor, curve (RibbonProfile); 1/w at the first end, its change to the last
    vec3 first, change; // colour
};

Ribbon unpack_ribbon(uvec4 line, uvec4 shape, uvec4 tint)
{
    vec2 a = origin - uintBitsToFloat(line.xy), b = origin - uintBitsToFloat(line.zw), way = a - b;
    float inverse = inversesqrt(max(way.x * way.x + way.y * way.y, 1e-20));
    vec2 d = way * inverse;
    RibbonBound first = unpack_shorts(shape.y), last = unpack_shorts(shape.z);
    RibbonProfile profile = ribbon_profile(d.x, d.y);
    float change_w = uintBitsToFloat(shape.w & 0xfffff000u), mean_w = uintBitsToFloat(tint.w);
#if NEAREST
    float opacity = 1.0;
#else
    float opacity = float(int(shape.w & 0xfffu)) * (1.0 / 4095.0);
#endif
    Ribbon r;
    r.at = vec4(a.y * d.x - a.x * d.y, (a.x * d.x + a.y * d.y) * inverse,
                a.x * first.x + a.y * first.y + first.offset,
                1.0 - b.x * last.x - b.y * last.y - last.offset);
    r.by_x = vec4(-d.y, d.x * inverse, first.x, -last.x);
    r.by_y = vec4(d.x, d.y * inverse, first.y, -last.y);
    float half_width = low_level(shape.x);
    r.width = vec4(half_width, high_level(shape.x) - half_width, profile.inner, profile.outer);
    r.cover = vec4(opacity * profile.factor, profile.curve, mean_w * (1.0 - 0.5 * change_w),
                   mean_w * change_w);
    r.first = vec3(low_level(tint.x), high_level(tint.x), low_level(tint.y));
    r.change = vec3(high_level(tint.y), low_level(tint.z), high_level(tint.z)) - r.first;
    return r;
}

#if STAGED
#define STAGED_WORDS 7
shared vec4 staged[BATCH * STAGED_WORDS];

void stage(int i, Ribbon r)
{
    int at = i * STAGED_WORDS;
    staged[at] = r.at;
    staged[at + 1] = r.by_x;
    staged[at + 2] = r.by_y;
    staged[at + 3] = r.width;
    staged[at + 4] = r.cover;
    staged[at + 5] = vec4(r.first, r.change.x);
    staged[at + 6] = vec4(r.change.yz, 0.0, 0.0);
}
#endif

// Ribbon i of the batch that begins at `begin`.
Ribbon fetch_ribbon(int begin, int i)
{
#if STAGED
    int at = i * STAGED_WORDS;
    vec4 color = staged[at + 5];
    return Ribbon(staged[at], staged[at + 1], staged[at + 2], staged[at + 3], staged[at + 4],
                  color.rgb, vec3(color.a, staged[at + 6].xy));
#else
    int at = int(texelFetch(sorted, begin + i).y) * RIBBON_TEXELS;
    return unpack_ribbon(texelFetch(ribbons, at), texelFetch(ribbons, at + 1),
                         texelFetch(ribbons, at + 2));
#endif
}

// The cells that the ribbon may touch, one bit each.
uint find_cells(Strip s)
{
    uint cells = 0u;
    for (int row = 0; row < CELLS / CELLS_ACROSS; ++row) {
        int top = corner.y + row * TILE_CELL_HEIGHT, first = max(top, s.rows.x),
            last = min(top + TILE_CELL_HEIGHT - 1, s.rows.y);
        // Columns from the tile's left side; the tile has two halves.
        ivec2 columns = strip_columns(s, first, last) - corner.x;
        uint left = uint(columns.x < TILE_CELL_WIDTH && columns.y >= 0),
             right = uint(columns.x < TILE_SIDE && columns.y >= TILE_CELL_WIDTH);
        cells |= (first <= last && columns.x <= columns.y ? left | (right << 1) : 0u)
                 << (row * CELLS_ACROSS);
    }
    return cells;
}

// Lane i of the group enters ribbons i, i + GROUP_SIZE, ... of the batch in the open cells.
void list_batch(int begin, int count, int batch, uint open)
{
    int lane = int(gl_LocalInvocationID.x);
    if (lane < CELLS * WORDS) masks[(~batch & 1) * CELLS * WORDS + lane] = 0u;
    for (int i = lane; i < min(count, BATCH); i += GROUP_SIZE) {
        int at = int(texelFetch(sorted, begin + i).y) * RIBBON_TEXELS;
        uvec4 line = texelFetch(ribbons, at);
        uint cells = open & find_cells(make_strip(line.xy, texelFetch(ribbons, at + 3)));
        for (int cell = 0; cell < CELLS; ++cell)
            if ((cells >> cell & 1u) != 0u)
                atomicOr(masks[((batch & 1) * CELLS + cell) * WORDS + (i >> 5)], 1u << (i & 31));
#if STAGED
        if (cells != 0u)
            stage(i, unpack_ribbon(line, texelFetch(ribbons, at + 1), texelFetch(ribbons, at + 2)));
#endif
    }
}

// --- Pixels.

ivec2 place = ivec2(0); // the lane's first pixel
Numbers red = Numbers(0.0), green = Numbers(0.0), blue = Numbers(0.0);
Numbers through = Numbers(1.0); // transmittance so far
Numbers hidden = Numbers(0.0);  // 1/w of the opaque surface; 0: none
#if RIMS
layout(binding = BIND_RIM) uniform sampler2D rim_light;
layout(binding = BIND_RIM_DEPTH) uniform sampler2D rim_depth;
// The rim's 1/w and share of the pixel; transmittance of the ribbons before it. See kernel/edge.h.
Numbers rim_near = Numbers(0.0), rim_share = Numbers(0.0), front = Numbers(1.0);
#endif

Numbers profile_area(Ribbon r, Numbers t)
{
    return ribbon_area(t, r.width.z, r.width.w, r.cover.y);
}

void draw(Ribbon r)
{
    vec2 px = vec2(place - block);
    Numbers y = px.y + ROWS;
    vec4 row = r.at + px.x * r.by_x;
    Numbers across = abs(row.x + y * r.by_y.x), along = clamp(row.y + y * r.by_y.y, 0.0, 1.0),
            first = row.z + y * r.by_y.z, last = row.w + y * r.by_y.w;
    Numbers half_width = r.width.x + along * r.width.y, beyond = across - half_width,
            covered =
                profile_area(r, across + half_width) - sign(beyond) * profile_area(r, abs(beyond)),
            alpha = r.cover.x * covered * clamp(min(first, last), 0.0, 1.0);
#if BASE || NEAREST
    Numbers near = r.cover.z + along * r.cover.w;
#endif
#if NEAREST
    Numbers seen = step(RIBBON_LEAST_COVERAGE, alpha) * (1.0 - step(near, hidden));
    hidden = mix(hidden, near, seen);
    through *= 1.0 - seen;
    red = mix(red, r.first.r + along * r.change.r, seen);
    green = mix(green, r.first.g + along * r.change.g, seen);
    blue = mix(blue, r.first.b + along * r.change.b, seen);
#else
#if BASE
    alpha *= step(hidden, near);
#endif
    alpha *= through;
    through -= alpha;
#if RIMS
    Numbers before = step(rim_near, near);
    front -= alpha * before;
    alpha -= alpha * (1.0 - before) * rim_share;
#endif
    red += alpha * (r.first.r + along * r.change.r);
    green += alpha * (r.first.g + along * r.change.g);
    blue += alpha * (r.first.b + along * r.change.b);
#endif
}

void draw_batch(int begin, int cell, int batch)
{
    int at = ((batch & 1) * CELLS + cell) * WORDS;
    for (int word = 0; word < WORDS; ++word)
        for (uint bits = masks[at + word]; bits != 0u; bits &= bits - 1u)
            draw(fetch_ribbon(begin, 32 * word + findLSB(bits)));
}

uint find_open(int batch)
{
    uint open = 0u;
    for (int cell = 0; cell < CELLS; ++cell) open |= uint(open_from[cell] == batch) << cell;
    return open;
}

void draw_list(int begin, int count)
{
    int lane = int(gl_LocalInvocationID.x), cell = lane / CELL_LANES;
    if (lane < CELLS * WORDS) masks[lane] = 0u;
    if (lane < CELLS) open_from[lane] = 0;
    barrier();
    uint open = ~0u;
    for (int batch = 0; batch * BATCH < count && open != 0u; ++batch) {
        int from = begin + batch * BATCH;
        list_batch(from, count - batch * BATCH, batch, open);
        barrier();
        draw_batch(from, cell, batch);
        if (NEAREST == 1 || LARGEST(through) > RIBBON_LEAST_THROUGH) open_from[cell] = batch + 1;
        barrier();
        open = find_open(batch + 1);
    }
}

// --- The base behind, and colours.

void hide()
{
#if BASE
    for (int k = 0; k < PIXELS; ++k) {
        ivec2 p = place + ivec2(0, k);
        float z = is_in_base(p) ? texelFetch(mesh_depth, p, 0).x : 1.0;
        OF(hidden, k) = edge_inverse_w(z, draw_params.depth.x, draw_params.depth.y);
#if RIMS
        OF(rim_share, k) = is_in_base(p) ? texelFetch(rim_light, p, 0).a : 0.0;
        OF(rim_near, k) = OF(rim_share, k) > 0.0
                              ? edge_inverse_w(texelFetch(rim_depth, p, 0).x, draw_params.depth.x,
                                               draw_params.depth.y)
                              : 0.0;
#endif
    }
#endif
}

vec4 light_of(int k)
{
#if DEPTH
    return vec4(vec3(depth_shown(OF(hidden, k))), 1.0);
#else
    vec4 light = vec4(OF(red, k), OF(green, k), OF(blue, k), 1.0 - OF(through, k)) +
                 OF(through, k) * light_behind(place + ivec2(0, k));
#if RIMS
    // What lies behind includes the rim as if all ribbons lay before it.
    if (OF(rim_share, k) > 0.0)
        light.rgb +=
            (OF(front, k) - OF(through, k)) * texelFetch(rim_light, place + ivec2(0, k), 0).rgb;
#endif
    return light;
#endif
}

#if SAMPLES > 1
shared vec4 lights[TILE_SIDE * TILE_SIDE];

void store_all()
{
    const int SIDE = TILE_SIDE / SAMPLES;
    ivec2 own = place - corner;
    for (int k = 0; k < PIXELS; ++k) lights[(own.y + k) * TILE_SIDE + own.x] = light_of(k);
    barrier();
    for (int i = int(gl_LocalInvocationID.x); i < SIDE * SIDE; i += GROUP_SIZE) {
        ivec2 p = ivec2(i % SIDE, i / SIDE);
        vec4 sum = vec4(0.0);
        for (int k = 0; k < SAMPLES * SAMPLES; ++k) {
            ivec2 s = p * SAMPLES + ivec2(k % SAMPLES, k / SAMPLES);
            sum += lights[s.y * TILE_SIDE + s.x];
        }
        store(corner / SAMPLES + p, sum * (1.0 / float(SAMPLES * SAMPLES)));
    }
}
#else
void store_all()
{
    for (int k = 0; k < PIXELS; ++k) store(place + ivec2(0, k), light_of(k));
}
#endif

void main()
{
    int lane = int(gl_LocalInvocationID.x), cell = lane / CELL_LANES, own = lane % CELL_LANES,
        count = int(counts[tile]);
    if (group >= use[TILE_USE_TILES]) return;
    place = corner + ivec2(cell % CELLS_ACROSS * TILE_CELL_WIDTH + own % TILE_CELL_WIDTH,
                           cell / CELLS_ACROSS * TILE_CELL_HEIGHT + own / TILE_CELL_WIDTH * PIXELS);
    uint end = ends[tile];
    hide();
    if (end <= room) draw_list(int(end) - count, count);
    store_all();
}
