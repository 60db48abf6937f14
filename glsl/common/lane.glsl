// SPDX-License-Identifier: MIT
// The index of a lane and of its work group of GROUP_SIZE lanes, in a dispatch whose groups form
// rows (gpu/gpu_dispatch.h). There may be more lanes than work.
int group_index() { return int(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x); }
int lane_index() { return group_index() * GROUP_SIZE + int(gl_LocalInvocationID.x); }
