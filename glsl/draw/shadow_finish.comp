// SPDX-License-Identifier: MIT
// Smooths each layer's sums with the neighbouring texels (weights 1 2 1 along each axis), and sums
// up the layers. A lane processes a column of STRIP texels from top to bottom, so that the sum of a
// row is computed once for three texels.
#include "draw/shadow.h"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(location = 0) uniform ivec2 map;  // side, number
layout(location = 1) uniform float unit; // steps for one fibre
layout(binding = BIND_SUMS) uniform usamplerBuffer sums;
layout(std430, binding = BIND_LAYERS_OUT) writeonly buffer Layers { uint layers[]; };

int side = map.x, first = map.y * SHADOW_LAYERS * map.x * map.x;

struct Row {
    float sum[SHADOW_LAYERS];
};

Row read_row(int row, ivec3 columns)
{
    Row line;
    ivec3 at = first + clamp(row, 0, side - 1) * side + columns;
    for (int k = 0; k < SHADOW_LAYERS; ++k) {
        line.sum[k] = float(int(texelFetch(sums, at.x).x)) +
                      2.0 * float(int(texelFetch(sums, at.y).x)) +
                      float(int(texelFetch(sums, at.z).x));
        at += side * side;
    }
    return line;
}

void main()
{
    int at = lane_index(), column = at % side, row = at / side * STRIP;
    if (row >= side) return;
    ivec3 columns = clamp(column + ivec3(-1, 0, 1), 0, side - 1);
    float scale = 1.0 / (16.0 * unit);
    Row above = read_row(row - 1, columns), here = read_row(row, columns);
    for (int turn = 0; turn < STRIP; ++turn, ++row) {
        Row below = read_row(row + 1, columns);
        float before = 0.0;
        for (int k = 0; k < SHADOW_LAYERS; ++k) {
            float own = scale * (above.sum[k] + 2.0 * here.sum[k] + below.sum[k]);
            layers[first + (k * side + row) * side + column] = pack_layer(before, own);
            before += own;
        }
        above = here;
        here = below;
    }
}
