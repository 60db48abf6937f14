// SPDX-License-Identifier: MIT
// Copies `from` to `to` with 10 added to each word, after `rounds` rounds of a random generator
// (tests/gpu/test_gpu_buffer.c). TEXTURE 1: reads `from` as a texture.
layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer To { uint to[]; };
#if TEXTURE
layout(binding = 0) uniform usamplerBuffer from;
#define from_word(i) texelFetch(from, i).x
#else
layout(std430, binding = 1) readonly buffer From { uint from[]; };
#define from_word(i) from[i]
#endif
layout(location = 0) uniform int rounds;

void main()
{
    int i = int(gl_GlobalInvocationID.x);
    uint x = uint(i) + 1u;
    for (int k = 0; k < rounds; ++k) x = x * 1664525u + 1013904223u;
    to[i] = from_word(i) + 10u + (x == 0u ? 1u : 0u); // so that no compiler leaves the rounds out
}
