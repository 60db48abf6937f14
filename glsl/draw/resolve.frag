// SPDX-License-Identifier: MIT
// Blends a pixel's fragments: the LAYERS nearest in order, the rest behind them without order, and
// all over the base, premultiplied and in linear light.
//   BASE 0: only the background lies behind   1: the mesh, too
//   RIMS 1: the base has rims (kernel/edge.h); needs BASE 1, DEPTH 0
//   DEPTH 1: shows the distance of the nearest fragment, otherwise of the mesh
//   SAMPLES: a pixel of the picture is the mean of SAMPLES x SAMPLES pixels of the lists
//   MOST_TURNS: number of fragments that the driver's loops can visit
//
// The rest is summed up as integers, so the sum does not depend on the order: colour times alpha,
// alpha, and optical depth -log2(1 - alpha). Together the fragments have the same transmittance as
// in any order, and show their mean colour. The optical depth is capped where nothing is visible
// behind it.
#include "draw/draw.h"
#include "kernel/edge.h"
#include "draw/abuffer.glsl"
#include "draw/display.glsl"

layout(binding = BIND_NODES) uniform usamplerBuffer nodes;
layout(binding = BIND_HEADS) uniform usamplerBuffer heads;
#if BASE
layout(binding = BIND_BASE) uniform sampler2D base;
#if DEPTH
// The base has been drawn, so its texture unit is free.
layout(binding = BIND_SURFACE) uniform sampler2D mesh_depth;
#endif
#endif
#if RIMS
layout(binding = BIND_RIM) uniform sampler2D rim_light;
layout(binding = BIND_RIM_DEPTH) uniform sampler2D rim_depth;
#endif
layout(std430, binding = BIND_SHORTAGE_OUT) writeonly buffer Shortage { uint shortage; };
layout(location = 0) out vec4 pixel_out; // sRGB with straight alpha; or premultiplied light

const float COLOR_STEPS = 16384.0;
const float COLOR_MAX = 8.0;
const float DEPTH_STEPS = 4096.0;
const int DEPTH_MAX = 1 << 24;
// A colour is at most 2^17 steps, so the sum is carried to a second word before it overflows.
const int CARRY_EVERY = 8192;
const int CARRY_BITS = 16;

vec4 over(vec4 front, vec4 behind) { return front + (1.0 - front.a) * behind; }

void carry(inout ivec4 high, inout ivec4 low)
{
    high += low >> CARRY_BITS;
    low &= (1 << CARRY_BITS) - 1;
}

vec4 rest_color(ivec4 high, ivec4 low, int optical_depth)
{
    carry(high, low);
    vec4 sum = ldexp(vec4(high), ivec4(CARRY_BITS)) + vec4(low);
    float alpha = 1.0 - exp2(float(optical_depth) * (-1.0 / DEPTH_STEPS));
    vec3 mean = sum.rgb / max(sum.a, 1.0);
    return vec4(mean * alpha, alpha);
}

int count = 0; // fragments visited so far

// The light of a pixel of the lists, premultiplied: fragments that are at least as near as the 1/w
// whose bits are `farthest`, over `behind`.
vec4 blend(ivec2 pixel, int farthest, vec4 behind)
{
    int link = int(
        texelFetch(heads, (pixel.y - int(draw_params.band.y)) * int(draw_params.band.x) + pixel.x)
            .x);
#if LAYERS
    ivec3 layer[LAYERS];
    for (int i = 0; i < LAYERS; ++i) layer[i] = ivec3(0);
#endif
    ivec4 high = ivec4(0), low = ivec4(0);
    int optical_depth = 0;
    while (link != 0 && count < MOST_TURNS) {
        ivec4 node = ivec4(texelFetch(nodes, link - 1));
        link = node.x;
        ivec3 farther = node.y >= farthest ? node.yzw : ivec3(0);
#if LAYERS
        for (int i = 0; i < LAYERS; ++i) {
            bool nearer = abuffer_nearer(farther, layer[i]);
            ivec3 here = layer[i];
            layer[i] = nearer ? farther : here;
            farther = nearer ? here : farther;
        }
#endif
        vec4 c = min(abuffer_color(farther), COLOR_MAX);
        low += ivec4(c * COLOR_STEPS + 0.5);
        int depth = int(-log2(max(1.0 - c.a, 1.0 / 65536.0)) * DEPTH_STEPS + 0.5);
        optical_depth = min(optical_depth + depth, DEPTH_MAX);
        if (++count % CARRY_EVERY == 0) carry(high, low);
    }
    if (link != 0) shortage = 1u;
#if DEPTH
    float near = intBitsToFloat(layer[0].x);
#if BASE
    if (near == 0.0)
        near = edge_inverse_w(texelFetch(mesh_depth, pixel, 0).x, draw_params.depth.x,
                              draw_params.depth.y);
#endif
    return vec4(vec3(depth_shown(near)), 1.0);
#else
    vec4 color = over(rest_color(high, low, optical_depth), behind);
#if LAYERS
    for (int i = LAYERS - 1; i >= 0; --i) color = over(abuffer_color(layer[i]), color);
#endif
    return color;
#endif
}

vec4 light_of(ivec2 pixel)
{
#if BASE
    vec4 behind = texelFetch(base, pixel, 0);
#else
    vec4 behind = draw_params.background;
#endif
#if RIMS
    vec4 rim = texelFetch(rim_light, pixel, 0);
    if (rim.a > 0.0) { // a share of the pixel shows the rim, the rest what lies behind it
        float near = edge_inverse_w(texelFetch(rim_depth, pixel, 0).x, draw_params.depth.x,
                                    draw_params.depth.y),
              rest = 1.0 - rim.a;
        return rim.a * blend(pixel, floatBitsToInt(near), vec4(rim.rgb / rim.a, 1.0)) +
               rest * blend(pixel, 0, max(behind - rim, 0.0) / max(rest, 1e-6));
    }
#endif
    return blend(pixel, 0, behind);
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy) * SAMPLES;
    vec4 color = vec4(0.0);
    for (int i = 0; i < SAMPLES * SAMPLES; ++i)
        color += light_of(pixel + ivec2(i % SAMPLES, i / SAMPLES));
    color *= 1.0 / float(SAMPLES * SAMPLES);
#if TONE == 3
    pixel_out = color;
#else
    pixel_out = displayed(color);
#endif
}
