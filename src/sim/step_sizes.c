// SPDX-License-Identifier: MIT
#include "sim/step_sizes.h"

// Numbers of vertices up to which a strand stays in registers. CPU drivers spill what does not fit
// their vector registers to the stack, which the first-level cache holds. So their limit is where
// Mesa no longer unrolls the loops along the strand, 32 turns (glsl/sim/keep.glsl); chain's is
// where compilation took longer than it saved. On a GPU a lane has 128 registers if 8 waves are to
// hide latency, and 256 at most; the limits are those that fit for every variant, found by
// scripts/gpu-statistics (docs/gpu_development.md). Solvers for which only a few vertices would fit
// stay in memory: chain, hybrid and emulation keep 11 to 16 numbers per vertex.
const StepSizes STEP_SIZES[STEP_SHAPES][GPU_KINDS] = {
    [STEP_IN_MEMORY] = {[GPU_CPU_DRIVER] = {0, 1, 1}, [GPU_HARDWARE] = {0, 1, 1}},
    [STEP_CHAIN] = {[GPU_CPU_DRIVER] = {16, 1, 8}, [GPU_HARDWARE] = {0, 1, 1}},
    [STEP_EMULATION] = {[GPU_CPU_DRIVER] = {33, 1, 8}, [GPU_HARDWARE] = {0, 1, 1}},
    [STEP_HYBRID] = {[GPU_CPU_DRIVER] = {33, 1, 8}, [GPU_HARDWARE] = {0, 1, 1}},
    [STEP_ROD] = {[GPU_CPU_DRIVER] = {0, 1, 8}, [GPU_HARDWARE] = {0, 1, 1}},
    [STEP_ROPE] = {[GPU_CPU_DRIVER] = {33, 1, 1}, [GPU_HARDWARE] = {8, 1, 1}},
    [STEP_SPLIT] = {[GPU_CPU_DRIVER] = {33, 2, 1}, [GPU_HARDWARE] = {20, 1, 1}},
};
