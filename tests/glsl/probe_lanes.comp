// SPDX-License-Identifier: MIT
// Counts how often each lane of a dispatch runs (tests/gpu/test_gpu_dispatch.c).
layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"

layout(location = 0) uniform int count;
layout(std430, binding = 0) buffer Visits { uint visits[]; }; // [layers][count]

void main()
{
    int lane = lane_index();
    if (lane < count) atomicAdd(visits[int(gl_WorkGroupID.z) * count + lane], 1u);
}
