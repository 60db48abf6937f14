// SPDX-License-Identifier: MIT
// Dispatches with any number of work groups. Drivers need only allow 65,535 side by side (OpenGL
// 4.3, table 23.64), so larger numbers are arranged in rows. Shaders compute their lane numbers by
// glsl/common/lane.glsl.
#pragma once

#include "gpu/gpu.h"

// Runs the current program on `items` items, `per_group` per work group, in each of `layers` layers
// (gl_WorkGroupID.z, at most 65,535). Up to a row of surplus groups may run. Does nothing for 0
// items.
void gpu_dispatch(const GpuLimits *limits, uint64_t items, uint64_t per_group, uint32_t layers);
