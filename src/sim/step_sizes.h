// SPDX-License-Identifier: MIT
// How the strands of each solver lie on the lanes of each kind of device: one table. What a group
// has of lanes is GpuSizes.strands.
#pragma once

#include "gpu/gpu_sizes.h"

#include <stdint.h>

// A row of the table. The first is of solvers that always keep strands in memory.
typedef enum StepShape {
    STEP_IN_MEMORY,
    STEP_CHAIN,
    STEP_EMULATION,
    STEP_HYBRID,
    STEP_ROPE,
    STEP_SPLIT,
    STEP_SHAPES
} StepShape;

typedef struct StepSizes {
    // Strands of at most this many vertices stay in registers for a step, which costs a compilation
    // for each vertex count; 0: never.
    uint32_t most_in_registers;
    // Strands of a lane where they are in registers: two hide each other's latency on a CPU; a GPU
    // has other waves for that.
    uint32_t strands;
} StepSizes;

extern const StepSizes STEP_SIZES[STEP_SHAPES][GPU_KINDS];
