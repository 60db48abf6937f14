// SPDX-License-Identifier: MIT
// Dispatches of any number of work groups: a driver allows 65,535 side by side (OpenGL 4.3, table
// 23.64), so more of them lie in rows. Shaders number their lanes by glsl/common/lane.glsl.
#pragma once

#include "gpu/gpu.h"

// Runs the current program on `items` items with `per_group` of them a work group, and on each of
// `layers` layers (gl_WorkGroupID.z) of them, 65,535 at most. Less than a row of groups more may
// run than there are items for. Nothing for 0 items.
void gpu_dispatch(const GpuLimits *limits, uint64_t items, uint64_t per_group, uint32_t layers);
