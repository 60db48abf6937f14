// SPDX-License-Identifier: MIT
// The grid of a distance field while it is computed, and the triangles of the mesh.
#include "field/field_params.h"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
// 3 texels per triangle: its corners, m, relative to grid point 0 0 0.
layout(binding = BIND_POSITION) uniform samplerBuffer triangles;

ivec3 grid_size() { return ivec3(field_params.size_x, field_params.size_y, field_params.size_z); }
int grid_address(ivec3 at)
{
    return (at.z * int(field_params.size_y) + at.y) * int(field_params.size_x) + at.x;
}

// The lane's work item in a dispatch over items; the lane's grid point in a dispatch over the grid
// (one row along x per group row).
uint item() { return uint(lane_index()); }
ivec3 grid_point() { return ivec3(gl_GlobalInvocationID.x, gl_WorkGroupID.yz); }

vec3 corner(uint triangle, int i) { return texelFetch(triangles, int(triangle) * 3 + i).xyz; }
