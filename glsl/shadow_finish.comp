// SPDX-License-Identifier: MIT
// Smooths each layer's sums with the neighbours' (1 2 1 each way), and adds them up.
#include "shadow.h"

layout(local_size_x = GROUP_SIZE) in;
layout(location = 0) uniform ivec2 map; // side, number
layout(location = 1) uniform float unit; // steps for an optical depth of 1
layout(binding = BIND_SUMS) uniform usamplerBuffer sums;
layout(std430, binding = BIND_LAYERS_OUT) writeonly buffer Layers { vec2 layers[]; };

int side = map.x;

float smooth_sum(int layer, ivec4 x, ivec4 y)
{
    float sum = 0.0;
    for (int j = 0; j < 3; ++j) {
        int row = layer + y[j] * side;
        float line = float(int(texelFetch(sums, row + x[0]).x)) + float(int(texelFetch(sums, row + x[2]).x)) +
                     2.0 * float(int(texelFetch(sums, row + x[1]).x));
        sum += j == 1 ? 2.0 * line : line;
    }
    return sum;
}

void main()
{
    int at = int(gl_GlobalInvocationID.x);
    if (at >= side * side) return;
    int column = at % side, row = at / side;
    ivec4 x = ivec4(max(column - 1, 0), column, min(column + 1, side - 1), 0);
    ivec4 y = ivec4(max(row - 1, 0), row, min(row + 1, side - 1), 0);
    float scale = 1.0 / (16.0 * unit);
    float before = 0.0;
    for (int k = 0; k < SHADOW_LAYERS; ++k) {
        int layer = (map.y * SHADOW_LAYERS + k) * side * side;
        float own = scale * smooth_sum(layer, x, y);
        layers[layer + at] = vec2(before, own);
        before += own;
    }
}
