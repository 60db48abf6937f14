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
    STEP_ROD,
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
    // Strands per lane, one after the other, if they are in scratch memory. The memory belongs to
    // the lane (glsl/sim/scratch.glsl), so it stays in a CPU's cache from strand to strand; a GPU
    // needs all lanes that there are. At least 1.
    uint32_t strands_in_memory;
} StepSizes;

extern const StepSizes STEP_SIZES[STEP_SHAPES][GPU_KINDS];
