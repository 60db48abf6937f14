// SPDX-License-Identifier: MIT
// Computes for each cell, from its sums, the mean velocity and how much denser it is than at rest.
#define WHO 1
#include "sim/volume.glsl"

layout(binding = BIND_VOLUME_SUMS) uniform isamplerBuffer sums;
layout(binding = BIND_VOLUME_OWN) uniform usamplerBuffer own;
layout(std430, binding = BIND_VOLUME_CELLS_OUT) writeonly buffer Cells { vec4 cells[]; };
layout(std430, binding = BIND_VOLUME_FACES_OUT) writeonly buffer Faces { vec2 faces[]; };
layout(std430, binding = BIND_VOLUME_DENSE_OUT) buffer Dense { uint dense[]; };

// Tolerance: a groom that has moved slightly has a few particles in other cells.
const float SLACK = 1.05, SLACK_PARTICLES = 1.0;
// Excess density from which a cell lets nothing approach; at twice the excess, hair bounces back.
const float STOP = 0.1;

vec2 sum_at(int cell)
{
    return vec2(float(texelFetch(sums, VOLUME_SUMS * cell).x),
                float(texelFetch(sums, VOLUME_SUMS * cell + 1).x));
}

void measure(int c, int count)
{
    int row = int(volume_params.size.x), slice = row * int(volume_params.size.y);
    vec2 sum = GRAIN_SMOOTH(sum_at, c, row, slice);
    float at_rest = max(sum.y / sum.x, float(texelFetch(own, c).x));
    float over = max(sum.x / (SLACK * at_rest + 2.0 * SLACK_PARTICLES) - 1.0, 0.0) / STOP;
    vec3 v = vec3(texelFetch(sums, VOLUME_SUMS * c + 2).x, texelFetch(sums, VOLUME_SUMS * c + 3).x,
                  texelFetch(sums, VOLUME_SUMS * c + 4).x);
    cells[c] = vec4(v / (VOLUME_STEPS * float(count)), float(count));
    faces[c] = vec2(min(volume_params.strength * over, 2.0),
                    volume_params.friction * min(volume_params.strength * over, 1.0));
    if (over > 0.0 && dense[0] == 0u) atomicOr(dense[0], 1u);
}

void main()
{
    for (int k = 0; k < VOLUME_CELLS_A_LANE; ++k) {
        int c = lane_cell(k);
        bool exists = c < int(volume_params.cell_count);
        int count = exists ? texelFetch(sums, VOLUME_SUMS * c).x : 0;
        bool full = count > 0 && count <= VOLUME_MOST;
        if (full) measure(c, count);
        if (exists && !full) cells[c] = vec4(0.0);
        if (exists && !full) faces[c] = vec2(0.0);
    }
}
