// SPDX-License-Identifier: MIT
#include "gpu/gpu_sizes.h"

// A CPU driver runs a work group on one thread. Strands take long and vary in length, so a group of
// strands is one vector of 8 lanes: many groups balance the load of the cores. Where a lane does
// little work, larger groups save overhead. A GPU needs whole waves.
const GpuSizes GPU_SIZES[GPU_KINDS] = {
    [GPU_CPU_DRIVER] = {.strands = 8, .items = 64, .sort = 64, .pixels = 4, .stages = 0},
    [GPU_HARDWARE] = {.strands = 64, .items = 64, .sort = 256, .pixels = 1, .stages = 1},
};
