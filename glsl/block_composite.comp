// SPDX-License-Identifier: MIT
// A 4x4-pixel block a lane: its lists' ribbons far to near, each 'over' what stands behind,
// premultiplied and in linear light, then sRGB. The pixels' colours stay in registers.
//   BASE 1: the mesh stands behind, and hides what is behind it   OPAQUE 1: alpha is 1 everywhere
//
// A ribbon's colour and depth are those beside the block's middle, its coverage is exact for each
// pixel (coverage.glsl).
#include "draw.h"
#include "block.glsl"
#include "srgb.glsl"

layout(local_size_x = GROUP_SIZE) in;
layout(location = 0) uniform ivec2 band; // first block row and end
layout(binding = BIND_RECORDS) uniform usamplerBuffer records;
layout(binding = BIND_LISTS) uniform usamplerBuffer lists;
layout(binding = BIND_LINKS) uniform usamplerBuffer links;
#if BASE
layout(binding = BIND_BASE) uniform sampler2D base;
layout(binding = BIND_MESH_DEPTH) uniform sampler2D mesh_depth;
#endif
layout(std430, binding = BIND_BLOCK_COUNTS_OUT) writeonly buffer Counts { uint counts[]; };
layout(std430, binding = BIND_PIXELS_OUT) writeonly buffer Pixels { uvec4 pixels[]; };

#if OPAQUE
#define COLOR vec3
#else
#define COLOR vec4
#endif
#define PIXELS (BLOCK * BLOCK)

const int MOST_TURNS = 65000; // CPU drivers end loops silently after 65,535, lists' heads included

int blocks = (int(draw_params.width) + BLOCK - 1) / BLOCK;

uint pack_pixel(COLOR c)
{
#if OPAQUE
    vec4 straight = vec4(srgb_from_linear(c), 1.0);
#else
    vec4 straight = vec4(srgb_from_linear(c.rgb / max(c.a, 1e-6)), c.a);
#endif
    ivec4 level = ivec4(straight * 255.0 + 0.5);
    return uint(level.r | (level.g << 8) | (level.b << 16) | (level.a << 24));
}

uint list_of(int lane, int block)
{
    return texelFetch(lists, lane * blocks * (band.y - band.x) + block).x;
}

void main()
{
    // A CPU driver gives each thread one half of the groups: dealing rows out in turn evens them.
    int groups = int(gl_NumWorkGroups.x), group = int(gl_WorkGroupID.x), half_of = (groups + 1) / 2;
    group = group < half_of ? 2 * group : 2 * (group - half_of) + 1;
    int block = group * GROUP_SIZE + int(gl_LocalInvocationID.x);
    if (block >= blocks * (band.y - band.x)) return;
    ivec2 corner = ivec2(block % blocks, block / blocks + band.x) * BLOCK;
    vec2 origin = vec2(corner) + 0.5;
    COLOR color[PIXELS];
#if BASE
    float mesh[PIXELS]; // 1/w
#endif
    for (int k = 0; k < PIXELS; ++k) {
#if BASE
        ivec2 pixel = min(corner + ivec2(k % BLOCK, k / BLOCK), ivec2(draw_params.width, draw_params.height) - 1);
        color[k] = COLOR(texelFetch(base, pixel, 0));
        float z = texelFetch(mesh_depth, pixel, 0).x;
        mesh[k] = z < 1.0 ? (2.0 * z - 1.0 - draw_params.depth.x) / draw_params.depth.y : 0.0;
#else
        color[k] = COLOR(draw_params.background);
#endif
    }
    int lane = BIN_LANES;
    uint link = 0u;
    do {
        link = list_of(--lane, block);
    } while (link == 0u && lane > 0);
    // What the next turn needs is fetched a turn ahead: its latency hides behind this one's sums.
    uvec2 node = texelFetch(links, max(int(link), 1) - 1).xy;
    int record = RECORD_TEXELS * int(link == 0u ? 0u : node.x), turns = 0;
    uvec4 next_ends = texelFetch(records, record), next_shape = texelFetch(records, record + 1),
          next_shade = texelFetch(records, record + 2);
    if (link != 0u) do {
        uvec4 shape = next_shape, shade = next_shade;
        Ribbon r = unpack_ribbon(next_ends, shape);
        link = node.y;
        if (link == 0u && lane > 0) do {
            link = list_of(--lane, block);
        } while (link == 0u && lane > 0);
        node = texelFetch(links, max(int(link), 1) - 1).xy;
        record = RECORD_TEXELS * int(link == 0u ? 0u : node.x);
        next_ends = texelFetch(records, record);
        next_shape = texelFetch(records, record + 1);
        next_shade = texelFetch(records, record + 2);
        vec2 way = r.b - r.a;
        float inverse_length = inversesqrt(max(dot(way, way), 1e-20));
        vec2 d = way * inverse_length, q = origin - r.a;
        // Coverage: share_above of coverage.glsl, with all that is the same for the block's pixels
        // taken out.
        float a = max(abs(d.x), abs(d.y)), b = max(min(abs(d.x), abs(d.y)), 1e-3 * a);
        float scale = unpackHalf2x16(shape.w).x * 0.5 / (a * b), outer = 0.5 * (a + b), inner = 0.5 * (a - b);
        float whole = 2.0 * a * b;
        float t = clamp(dot(q + 0.5 * float(BLOCK - 1), d) * inverse_length, 0.0, 1.0);
        float half_width = mix(r.half_width.x, r.half_width.y, t);
        vec2 rg = unpackHalf2x16(shade.x), br = unpackHalf2x16(shade.y), gb = unpackHalf2x16(shade.z);
        vec3 rgb = mix(vec3(rg, br.x), vec3(br.y, gb), t);
#if OPAQUE
        vec3 c = rgb;
#else
        vec4 c = vec4(rgb, 1.0);
#endif
        float across = q.y * d.x - q.x * d.y;
        float side_a = dot(q, r.bound_a), side_b = dot(origin - r.b, r.bound_b);
#if BASE
        float inverse_w = uintBitsToFloat(shade.w) * (1.0 + unpackHalf2x16(shape.w).y * (t - 0.5));
#endif
        for (int k = 0; k < PIXELS; ++k) {
            float x = float(k % BLOCK), y = float(k / BLOCK);
            float off = abs(across - d.y * x + d.x * y), near = off - half_width, far = off + half_width, near_size = abs(near);
            float near_ramp = clamp(outer - near_size, 0.0, b), far_ramp = clamp(outer - far, 0.0, b);
            float near_share = near_ramp * near_ramp + 2.0 * b * max(inner - near_size, 0.0);
            float far_share = far_ramp * far_ramp + 2.0 * b * max(inner - far, 0.0);
            float alpha = scale * ((near < 0.0 ? whole - near_share : near_share) - far_share);
            bool hit = side_a + r.bound_a.x * x + r.bound_a.y * y >= 0.0 && side_b + r.bound_b.x * x + r.bound_b.y * y < 0.0;
#if BASE
            hit = hit && inverse_w >= mesh[k];
#endif
            alpha = hit ? alpha : 0.0;
            color[k] += alpha * (c - color[k]);
        }
    } while (link != 0u && ++turns < MOST_TURNS);
    if (link != 0u) counts[BLOCK_COUNT_SHORT] = 1u;
    int at = (corner.y * blocks * BLOCK + corner.x) / 4;
    for (int k = 0; k < PIXELS; k += 4, at += blocks * BLOCK / 4)
        pixels[at] = uvec4(pack_pixel(color[k]), pack_pixel(color[k + 1]), pack_pixel(color[k + 2]), pack_pixel(color[k + 3]));
}
