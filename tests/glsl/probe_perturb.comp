// SPDX-License-Identifier: MIT
// The functions that common/perturb.glsl changes, for four arguments at a time
// (tests/gpu/test_shader.c).
layout(local_size_x = 1) in;

layout(std430, binding = 0) readonly buffer Arguments { vec4 x[]; };
layout(std430, binding = 1) buffer Results { vec4 y[]; }; // 10 for each x

void main()
{
    uint i = gl_WorkGroupID.x;
    y[10u * i] = sqrt(x[i]);
    y[10u * i + 1u] = inversesqrt(x[i]);
    y[10u * i + 2u] = exp(x[i]);
    y[10u * i + 3u] = exp2(x[i]);
    y[10u * i + 4u] = log(x[i]);
    y[10u * i + 5u] = log2(x[i]);
    y[10u * i + 6u] = sin(x[i]);
    y[10u * i + 7u] = cos(x[i]);
    y[10u * i + 8u] = asin(x[i]);
    y[10u * i + 9u] = acos(x[i]);
}
