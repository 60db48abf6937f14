// SPDX-License-Identifier: MIT
// The compute programs of a solver: one for each of a hair's batches, shared where batches are
// alike.
#pragma once

#include "gpu/shader.h"
#include "sim/hair.h"

// What decides how many programs there are and how strands go to lanes.
typedef struct StepProgramsOptions {
    const char *shader;         // glsl file
    uint32_t most_in_registers; // strands of at most this many vertices get IN_REGISTERS 1, which
                                // costs a compilation for each vertex count; 0: never
    uint32_t strands_on_cpu;    // strands of a lane on CPU drivers where they are in registers: two
                                // hide each other's latency, a GPU has other lanes for that
    uint32_t lead;  // vertices that the head carries beside the root, where a strand has enough
    bool sheltered; // the head keeps wind off (forces.glsl)
    const ShaderDefine *defines; // the variant's own, at most STEP_OWN_DEFINES
} StepProgramsOptions;

enum { STEP_OWN_DEFINES = 8 };

typedef struct StepPrograms {
    GLuint *programs; // [batch_count]; equal ones may be the same
    uint32_t *leads;  // [batch_count]: of the batch's strands
    uint32_t batch_count, group_size, strands_per_lane;
    bool in_registers;
} StepPrograms;

// Compiles with the macros GROUP_SIZE (lanes), STRANDS (a lane's), IN_REGISTERS, VERTICES (but for
// the lead), LEAD, SHELTER and the own ones. Errors of shader_build_compute; RESULT_FAILED without
// memory.
Result step_programs_create(StepPrograms *programs, const Gpu *gpu, const Hair *hair,
                            const StepProgramsOptions *options, Error *error);
void step_programs_destroy(StepPrograms *programs);

// Runs batch `batch` of `strand_count` strands; the buffers are bound.
void step_programs_dispatch(const StepPrograms *programs, uint32_t batch, uint32_t strand_count);
