// SPDX-License-Identifier: MIT
// Copies positions strand by strand, for readers that do not know the tiled layout (hair.h).
#include "sim/gather_params.h"
#include "common/hair_address.glsl"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(binding = BIND_POSITION) uniform samplerBuffer positions;
layout(binding = BIND_STRAND_ID) uniform usamplerBuffer begins; // per strand, in vec4s
layout(std430, binding = BIND_POSITION_OUT) writeonly buffer Gathered { vec4 gathered[]; };

void main()
{
    int s = lane_index(), n = int(gather_params.vertex_count);
    if (s >= int(gather_params.strand_count)) return;
    int first = particle_address(s, 0, n);
    uint to = gather_params.begin + texelFetch(begins, s).x;
    for (int j = 0; j < n; ++j)
        gathered[to + uint(j)] = vec4(texelFetch(positions, first + j * STRAND_TILE).xyz, 1.0);
}
