// SPDX-License-Identifier: MIT
// A pixel's fragments become its colour: the LAYERS nearest in order, the rest blended out of order
// under them, all over what stands behind, premultiplied and in linear light.
//   BASE 0: the background alone stands behind   1: the mesh does
//
// The rest is summed in whole numbers, which give the same sum in every order: colour times alpha,
// alpha, and optical depth -log2(1 - alpha). Together they let through what they would in any
// order, and show their mean colour. The sums hold 8,192 opaque layers of white in one pixel.
#include "draw.h"
#include "abuffer.glsl"
#include "srgb.glsl"

layout(binding = BIND_NODES) uniform usamplerBuffer nodes;
layout(binding = BIND_HEADS) uniform usamplerBuffer heads;
#if BASE
layout(binding = BIND_BASE) uniform sampler2D base;
#endif
layout(location = 0) out vec4 pixel_out; // sRGB, alpha not multiplied in

const float COLOR_STEPS = 16384.0;
const float COLOR_MAX = 8.0;
const float DEPTH_STEPS = 4096.0;

vec4 over(vec4 front, vec4 behind)
{
    return front + (1.0 - front.a) * behind;
}

vec4 rest_color(ivec4 sum, int optical_depth)
{
    float alpha = 1.0 - exp2(float(optical_depth) * (-1.0 / DEPTH_STEPS));
    vec3 mean = vec3(sum.rgb) / max(float(sum.a), 1.0);
    return vec4(mean * alpha, alpha);
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    int link = int(texelFetch(heads, (pixel.y - int(draw_params.band.y)) * int(draw_params.band.x) + pixel.x).x);
    ivec3 layer[LAYERS];
    for (int i = 0; i < LAYERS; ++i) layer[i] = ivec3(0);
    ivec4 sum = ivec4(0);
    int optical_depth = 0;
    while (link != 0) {
        ivec4 node = ivec4(texelFetch(nodes, link - 1));
        link = node.x;
        ivec3 farther = node.yzw;
        for (int i = 0; i < LAYERS; ++i) {
            bool nearer = abuffer_nearer(farther, layer[i]);
            ivec3 here = layer[i];
            layer[i] = nearer ? farther : here;
            farther = nearer ? here : farther;
        }
        vec4 c = min(abuffer_color(farther), COLOR_MAX);
        sum += ivec4(c * COLOR_STEPS + 0.5);
        optical_depth += int(-log2(max(1.0 - c.a, 1.0 / 65536.0)) * DEPTH_STEPS + 0.5);
    }
#if BASE
    vec4 color = texelFetch(base, pixel, 0);
#else
    vec4 color = draw_params.background;
#endif
    color = over(rest_color(sum, optical_depth), color);
    for (int i = LAYERS - 1; i >= 0; --i) color = over(abuffer_color(layer[i]), color);
    pixel_out = vec4(srgb_from_linear(color.rgb / max(color.a, 1e-6)), color.a);
}
