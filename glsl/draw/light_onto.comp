// SPDX-License-Identifier: MIT
// The light that hair sends onto skin: from the light of all ordinates in a cell to its six faces
// (kernel/onto.h, light_grid_onto.c). A lane for each cell.
#include "draw/light.h"
#include "draw/light.glsl"
#include "kernel/onto.h"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(std430, binding = BIND_LIGHT_ONTO_OUT) readonly buffer Onto { uvec2 onto[]; };
layout(std430, binding = BIND_LIGHT_FACES_OUT) writeonly buffer Faces { vec4 faces[]; };

void main()
{
    int cell = lane_index(), all_cells = int(light_params.count.w);
    if (cell >= all_cells) return;
    vec3 sum[ONTO_FACES];
    float weights[ONTO_FACES], all = 0.0;
    for (int f = 0; f < ONTO_FACES; ++f) {
        sum[f] = vec3(0.0);
        weights[f] = 0.0;
    }
    for (int d = 0; d < LIGHT_ORDINATES; ++d) {
        uvec2 packed_light = onto[d * all_cells + cell];
        vec3 light = vec3(unpackHalf2x16(packed_light.x), unpackHalf2x16(packed_light.y).x),
             way = light_params.ordinate[d].xyz;
        for (int f = 0; f < ONTO_FACES; ++f) {
            float weight = onto_weight((f & 1) == 1 ? way[f / 2] : -way[f / 2]);
            weights[f] += weight;
            sum[f] += weight * light;
        }
    }
    for (int f = 0; f < ONTO_FACES; ++f) {
        sum[f] /= weights[f];
        all += sum[f].r + sum[f].g + sum[f].b;
    }
    for (int f = 0; f < ONTO_FACES; ++f) faces[cell * ONTO_FACES + f] = vec4(sum[f], all);
}
