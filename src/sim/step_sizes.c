// SPDX-License-Identifier: MIT
#include "sim/step_sizes.h"

// CPU drivers keep what no longer fits their 16 vector registers on the stack, in the first level
// of cache, so their limits are where compilation takes longer than it saves. A GPU's lane has 128
// registers where 8 waves shall hide each other's latency, and none in reach beyond 256: its limits
// are what scripts/gpu-statistics finds to fit for every variant (docs/gpu_development.md). Where
// few vertices would fit, memory serves as well: sweeps of chain, hybrid and emulation keep 11 to
// 16 numbers a vertex.
const StepSizes STEP_SIZES[STEP_SHAPES][GPU_KINDS] = {
    [STEP_IN_MEMORY] = {[GPU_CPU_DRIVER] = {0, 1}, [GPU_HARDWARE] = {0, 1}},
    [STEP_CHAIN] = {[GPU_CPU_DRIVER] = {16, 1}, [GPU_HARDWARE] = {0, 1}},
    [STEP_EMULATION] = {[GPU_CPU_DRIVER] = {32, 1}, [GPU_HARDWARE] = {0, 1}},
    [STEP_HYBRID] = {[GPU_CPU_DRIVER] = {32, 1}, [GPU_HARDWARE] = {0, 1}},
    [STEP_ROPE] = {[GPU_CPU_DRIVER] = {32, 1}, [GPU_HARDWARE] = {8, 1}},
    [STEP_SPLIT] = {[GPU_CPU_DRIVER] = {40, 2}, [GPU_HARDWARE] = {20, 1}},
};
