// SPDX-License-Identifier: MIT
// How the strands of each solver are assigned to the lanes of each kind of device, in one table.
// GpuSizes.strands has the number of lanes in a group.
#pragma once

#include "gpu/gpu_sizes.h"

#include <stdint.h>

// A row of the table. The first row is for solvers that always keep strands in memory.
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
    // Strands of at most this many vertices stay in registers during a step, which needs a compiled
    // program for each vertex count; 0: never.
    uint32_t most_in_registers;
    // Strands per lane if they are in registers. On a CPU two strands hide each other's latency; on
    // a GPU other waves do.
    uint32_t strands;
} StepSizes;

extern const StepSizes STEP_SIZES[STEP_SHAPES][GPU_KINDS];
