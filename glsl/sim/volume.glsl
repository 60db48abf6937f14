// SPDX-License-Identifier: MIT
// Shared by all passes of a section's volume (sim/volume.h).
//
// WHO 0: one strand per lane
//     1: VOLUME_CELLS_A_LANE cells per lane
// GRAIN: number of neighbouring particles that count as being in the cell of the middle one
#include "sim/volume_params.h"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
#include "kernel/grain.h"

#define STRANDS 0
#define CELLS   1

#if WHO == STRANDS
#include "common/hair_address.glsl"

layout(binding = BIND_POSITION) uniform samplerBuffer position;

// The cell of the grain that begins with particle j of a strand (`first`: address of its root); -1
// if outside.
int grain_cell(int first, int j, int last)
{
    int middle = grain_middle(j, GRAIN, last);
    vec4 x = vec4(texelFetch(position, first + middle * STRAND_TILE).xyz, 1.0);
    ivec3 size = ivec3(volume_params.size.xyz);
    return grain_cell_at(dot(volume_params.axis[0], x), dot(volume_params.axis[1], x),
                         dot(volume_params.axis[2], x), size.x, size.y, size.z);
}

// Whether a particle with this velocity relative to the head takes part.
bool is_slow(vec3 v) { return all(lessThan(abs(v), vec3(VOLUME_FASTEST))); }

// The particle's place as a share of the way from root to tip.
float share_of(int j, int n) { return float(j) / float(n - 1); }
#else
// The k-th cell of the lane; neighbouring lanes have neighbouring cells.
int lane_cell(int k)
{
    return (group_index() * VOLUME_CELLS_A_LANE + k) * GROUP_SIZE + int(gl_LocalInvocationID.x);
}
#endif
