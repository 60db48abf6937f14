// SPDX-License-Identifier: MIT
// Moves the hair as one rigid body, whatever its solver: when the head jumps, and when it moves
// from the first instant on.
#pragma once

#include "gpu/shader.h"
#include "sim/head.h"
#include "sim/solver.h"

// A zeroed one may be destroyed.
typedef struct Carry {
    const GpuLimits *limits; // the context's
    GLuint program;
} Carry;

// `bound`: each strand has a motion of its own. Errors of shader_build_compute.
Result carry_create(Carry *carry, const GpuLimits *limits, bool bound, Error *error);
void carry_destroy(Carry *carry);

// Changes the state of `solver`, which holds `hair` and has posed. Only queues GPU work.
// With frames ([batches], bound_set_way or bound_set_start) those are the motions.
void carry_apply(Carry *carry, const Solver *solver, const Hair *hair, const HeadMotion *motion,
                 const GpuBuffer *frames);
