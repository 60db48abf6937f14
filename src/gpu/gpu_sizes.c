// SPDX-License-Identifier: MIT
#include "gpu/gpu_sizes.h"

// A CPU driver runs a group on one thread: one vector of 8 lanes a group for strands, whose work
// is long and uneven, so that there are many groups to share out among the cores; larger ones
// where a lane does little. A GPU wants whole waves.
const GpuSizes GPU_SIZES[GPU_KINDS] = {
    [GPU_CPU_DRIVER] = {.strands = 8, .items = 64, .sort = 64, .pixels = 4, .stages = 0},
    [GPU_HARDWARE] = {.strands = 64, .items = 64, .sort = 256, .pixels = 1, .stages = 1},
};
