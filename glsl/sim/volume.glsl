// SPDX-License-Identifier: MIT
// What all passes of a section's volume share (sim/volume.h).
//
// WHO 0: a strand a lane
//     1: VOLUME_CELLS_A_LANE cells a lane
// GRAIN: so many neighbours in a strand lie in the cell of the middle one
#include "sim/volume_params.h"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
#include "kernel/grain.h"

#define STRANDS 0
#define CELLS   1

#if WHO == STRANDS
#include "common/hair_address.glsl"

layout(binding = BIND_POSITION) uniform samplerBuffer position;

// The cell of a grain that begins with particle j of a strand (its root's address), -1: none.
int grain_cell(int first, int j, int last)
{
    int middle = grain_middle(j, GRAIN, last);
    vec4 x = vec4(texelFetch(position, first + middle * STRAND_TILE).xyz, 1.0);
    ivec3 size = ivec3(volume_params.size.xyz);
    return grain_cell_at(dot(volume_params.axis[0], x), dot(volume_params.axis[1], x),
                         dot(volume_params.axis[2], x), size.x, size.y, size.z);
}

// Whether a particle of this velocity relative to the head's takes part.
bool is_slow(vec3 v) { return all(lessThan(abs(v), vec3(VOLUME_FASTEST))); }

// Its share of the way from the root to the tip.
float share_of(int j, int n) { return float(j) / float(n - 1); }
#else
// The k-th cell of the lane; lanes side by side have cells side by side.
int lane_cell(int k)
{
    return (group_index() * VOLUME_CELLS_A_LANE + k) * GROUP_SIZE + int(gl_LocalInvocationID.x);
}
#endif
