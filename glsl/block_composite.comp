// SPDX-License-Identifier: MIT
// A block of pixels a lane: its list's ribbons near to far, each under what stands before it,
// premultiplied and in linear light, over the background, then sRGB. The pixels stay in registers.
//   BASE 1: the mesh stands behind, and hides what is behind it
//   SAMPLES: what is a pixel here is one of SAMPLES x SAMPLES that the picture has the mean of
//   NEAREST 1: a ribbon hides all behind it where it covers LEAST_COVERAGE of the pixel   DEPTH 1: and shows its distance
//   KIND 0: 8 bits a channel are stored   1: 16   2: floats
//
// A ribbon's width is that at the middle of its part beside the block, its depth, its coverage and its
// colour are found for each pixel (coverage.glsl). Where less than LEAST shines through a whole block the rest is left.
#include "draw.h"
#include "block.glsl"
#include "coverage.glsl"
#include "display.glsl"

// Pixels of the picture in a row of the block; how one is stored, and how many at once.
#define ACROSS (BLOCK_WIDTH / SAMPLES)
#if KIND == 0 && SAMPLES == 1
#define STORED 4
#define PACKED uint
#define WORDS uvec4
#define STORED_WORDS uvec4(word[0], word[1], word[2], word[3])
#elif KIND == 0
#define STORED 2
#define PACKED uint
#define WORDS uvec2
#define STORED_WORDS uvec2(word[0], word[1])
#elif KIND == 1
#define STORED 2
#define PACKED uvec2
#define WORDS uvec4
#define STORED_WORDS uvec4(word[0], word[1])
#else
#define STORED 1
#define PACKED uvec4
#define WORDS uvec4
#define STORED_WORDS word[0]
#endif

layout(local_size_x = BLOCK_GROUP) in;
layout(location = 0) uniform int columns; // of blocks
layout(binding = BIND_RIBBONS) uniform usamplerBuffer ribbons;
layout(binding = BIND_JOBS) uniform usamplerBuffer jobs;
layout(binding = BIND_LISTS) uniform usamplerBuffer lists;
#if BASE
layout(binding = BIND_BASE) uniform sampler2D base;
layout(binding = BIND_MESH_DEPTH) uniform sampler2D mesh_depth;
#endif
layout(std430, binding = BIND_BLOCK_COUNTS_OUT) writeonly buffer Counts { uint counts[]; };
layout(std430, binding = BIND_PIXELS_OUT) writeonly buffer Pixels { WORDS pixels[]; };

#define PIXELS (BLOCK_WIDTH * BLOCK_HEIGHT)

const int MOST_TURNS = 61000, MOST_TOUCHED = 4000; // CPU drivers end loops silently after 65,535 turns in all
const float LEAST = 1.0 / 1024.0;
const float LEAST_COVERAGE = 1.0 / 16.0; // as in hair.frag

// Not a loop: compilers leave one with so long a body rolled, and then keep the pixels in memory.
#define ROW_IN_TURN(DO, y) DO((y) * BLOCK_WIDTH) DO((y) * BLOCK_WIDTH + 1) DO((y) * BLOCK_WIDTH + 2) DO((y) * BLOCK_WIDTH + 3)
#define FOUR_ROWS_IN_TURN(DO, NEXT_ROW, y)                                                           \
    ROW_IN_TURN(DO, y) NEXT_ROW; ROW_IN_TURN(DO, y + 1) NEXT_ROW; ROW_IN_TURN(DO, y + 2) NEXT_ROW; ROW_IN_TURN(DO, y + 3)
#define PIXELS_IN_TURN(DO, NEXT_ROW) FOUR_ROWS_IN_TURN(DO, NEXT_ROW, 0) NEXT_ROW; FOUR_ROWS_IN_TURN(DO, NEXT_ROW, 4)

#if BASE
#define HIDE(alpha, along, k) alpha = inverse_w.x + inverse_w.y * (along) >= hidden[k] ? alpha : 0.0
#else
#define HIDE(alpha, along, k)
#endif
// `row` has four quantities at the row's first pixel: distance across, both ends' shares, and how far along the ribbon.
#if NEAREST
#define ADD(k)                                                                                               \
    {                                                                                                        \
        vec4 here = row + float((k) % BLOCK_WIDTH) * by_x;                                                   \
        float coverage = profile_coverage(profile, here.x) * clamp(min(here.y, here.z), 0.0, 1.0);           \
        float along = clamp(here.w, 0.0, 1.0), near = inverse_w.x + inverse_w.y * along;                     \
        bool seen = coverage >= LEAST_COVERAGE && near > hidden[k];                                            \
        hidden[k] = seen ? near : hidden[k];                                                                     \
        through[k] = seen ? 0.0 : through[k];                                                                \
        color[k] = seen ? first + along * change : color[k];                                                 \
        most = 1.0;                                                                                          \
    }
#else
#define ADD(k)                                                                                               \
    {                                                                                                        \
        vec4 here = row + float((k) % BLOCK_WIDTH) * by_x;                                                   \
        float alpha = profile_coverage(profile, here.x) * clamp(min(here.y, here.z), 0.0, 1.0);              \
        float along = clamp(here.w, 0.0, 1.0);                                                               \
        HIDE(alpha, along, k);                                                                               \
        alpha *= through[k];                                                                                 \
        through[k] -= alpha;                                                                                 \
        color[k] += alpha * (first + along * change);                                                        \
        most = max(most, through[k]);                                                                        \
    }
#endif

PACKED pack_pixel(vec4 c)
{
#if KIND < 2
    c = vec4(display_from_linear(c.rgb / max(c.a, 1e-6)), c.a);
#if TONE == 3 || KIND == 1
    c = clamp(c, 0.0, 1.0); // srgb.glsl goes beyond by less than half a level of 8 bits, but not of 16
#endif
    uvec4 level = uvec4(ivec4(c * (KIND == 0 ? 255.0 : 65535.0) + 0.5));
#endif
#if KIND == 0
    return level.r | (level.g << 8) | (level.b << 16) | (level.a << 24);
#elif KIND == 1
    return level.rb | (level.ga << 16);
#else
    return floatBitsToUint(c);
#endif
}

void main()
{
    uvec4 job = texelFetch(jobs, int(gl_GlobalInvocationID.x));
    int block = int(job.x), stride = columns;
    ivec2 corner = ivec2(block % stride, block / stride) * ivec2(BLOCK_WIDTH, BLOCK_HEIGHT);
    vec2 origin = vec2(corner) + 0.5;
    vec3 color[PIXELS];
    float through[PIXELS];
    for (int k = 0; k < PIXELS; ++k) {
        color[k] = vec3(0.0);
        through[k] = 1.0;
    }
#if BASE || NEAREST
    float hidden[PIXELS]; // what lies behind it, 1/w
    for (int k = 0; k < PIXELS; ++k) hidden[k] = 0.0;
#endif
#if BASE
    ivec2 edge = ivec2(draw_params.width, draw_params.height) - 1;
    for (int k = 0; k < PIXELS; ++k) {
        float z = texelFetch(mesh_depth, min(corner + ivec2((k) % BLOCK_WIDTH, (k) / BLOCK_WIDTH), edge), 0).x;
        hidden[k] = z < 1.0 ? (2.0 * z - 1.0 - draw_params.depth.x) / draw_params.depth.y : 0.0;
    }
#endif
    int at = int(job.y), last = at + int(job.z) - 1, end = min(last, at + MOST_TURNS - 1);
    // Records lie far apart: a CPU waits for each turn's, but for many at once where there is nothing else to do.
    // So all are touched before; a sign of what is never negative keeps compilers from leaving it out.
    int touched = at, most_touched = min(last, at + MOST_TOUCHED - 1);
    uint signs = 0u;
    if (touched <= most_touched) do {
        signs |= texelFetch(ribbons, int(texelFetch(lists, touched).x) * RIBBON_TEXELS + 2).w;
    } while (++touched <= most_touched);
    last -= int(signs >> 31);
    int ribbon = int(texelFetch(lists, max(min(at, last), 0)).x) * RIBBON_TEXELS;
    int next_ribbon = int(texelFetch(lists, max(min(at + 1, last), 0)).x) * RIBBON_TEXELS;
    uvec4 next_ends = texelFetch(ribbons, ribbon), next_shape = texelFetch(ribbons, ribbon + 1),
          next_shade = texelFetch(ribbons, ribbon + 2);
    float most = 1.0; // that shines through any of the pixels
    if (at <= last) do {
        uvec4 shape = next_shape, shade = next_shade;
        Ribbon r = unpack_ribbon(next_ends, shape);
        next_ends = texelFetch(ribbons, next_ribbon);
        next_shape = texelFetch(ribbons, next_ribbon + 1);
        next_shade = texelFetch(ribbons, next_ribbon + 2);
        next_ribbon = int(texelFetch(lists, min(at + 2, last)).x) * RIBBON_TEXELS;
        vec2 way = r.b - r.a;
        float inverse_length = inversesqrt(max(dot(way, way), 1e-20));
        vec2 d = way * inverse_length, q = origin - r.a;
        const vec2 HALF = 0.5 * vec2(BLOCK_WIDTH - 1, BLOCK_HEIGHT - 1);
        float middle = dot(q + HALF, d) * inverse_length, side = dot(HALF, abs(d)) * inverse_length;
        float t = 0.5 * (clamp(middle - side, 0.0, 1.0) + clamp(middle + side, 0.0, 1.0));
        Profile profile = ribbon_profile(d, mix(r.half_width.x, r.half_width.y, t), NEAREST == 1 ? 1.0 : unpack_opacity(shape.w));
        vec2 rg = unpack_levels(shade.x), br = unpack_levels(shade.y), gb = unpack_levels(shade.z);
        vec3 first = vec3(rg, br.x), change = vec3(br.y, gb) - first;
        // Linear in the pixel: by column and by row.
        vec4 by_x = vec4(-d.y, r.bound_a.x, -r.bound_b.x, d.x * inverse_length),
             by_y = vec4(d.x, r.bound_a.y, -r.bound_b.y, d.y * inverse_length);
        vec4 row = vec4(q.y * d.x - q.x * d.y, dot(q, r.bound_a) + bound_offset(r.bound_a),
                        1.0 - dot(origin - r.b, r.bound_b) - bound_offset(r.bound_b), dot(q, d) * inverse_length);
#if BASE || NEAREST
        float change_w = unpack_change(shape.w); // 1/w is linear in the picture
        vec2 inverse_w = uintBitsToFloat(shade.w) * vec2(1.0 - 0.5 * change_w, change_w);
#endif
        most = 0.0;
        PIXELS_IN_TURN(ADD, row += by_y)
        ++at;
    } while (at <= end && most > LEAST);
    if (at <= last && most > LEAST) counts[BLOCK_COUNT_SHORT] = 1u;
#if BASE
#define BEHIND(k) texelFetch(base, min(corner + ivec2((k) % BLOCK_WIDTH, (k) / BLOCK_WIDTH), edge), 0)
#else
    vec4 background = draw_params.background;
#define BEHIND(k) background
#endif
#if DEPTH
#define LIT(k) vec4(vec3(depth_shown(through[k] == 0.0 ? hidden[k] : 0.0)), 1.0)
#else
#define LIT(k) (vec4(color[k], 1.0 - through[k]) + through[k] * BEHIND(k))
#endif
#if SAMPLES == 1
#define PIXEL(p) LIT(p)
#else
#define FIRST_SAMPLE(p) ((p) / ACROSS * 2 * BLOCK_WIDTH + (p) % ACROSS * 2)
#define PIXEL(p) 0.25 * (LIT(FIRST_SAMPLE(p)) + LIT(FIRST_SAMPLE(p) + 1) + \
                         LIT(FIRST_SAMPLE(p) + BLOCK_WIDTH) + LIT(FIRST_SAMPLE(p) + BLOCK_WIDTH + 1))
#endif
    int pitch = stride * ACROSS / STORED, place = corner.y / SAMPLES * pitch + corner.x / SAMPLES / STORED;
    PACKED word[STORED];
#define STORE(p)                                 \
    word[(p) % STORED] = pack_pixel(PIXEL(p)); \
    if ((p) % STORED == STORED - 1) pixels[place + (p) % ACROSS / STORED] = STORED_WORDS;
#if SAMPLES == 1
    PIXELS_IN_TURN(STORE, place += pitch)
#else
    STORE(0) STORE(1) place += pitch; STORE(2) STORE(3) place += pitch; STORE(4) STORE(5) place += pitch; STORE(6) STORE(7)
#endif
}
