// SPDX-License-Identifier: MIT
// Moves all hair as one rigid body, whatever its solver. Used when the head jumps, and when it
// already moves at time 0.
#pragma once

#include "gpu/shader.h"
#include "sim/head.h"
#include "sim/solver.h"

// A zeroed struct may be destroyed.
typedef struct Carry {
    const GpuLimits *limits; // the context's
    GLuint program;
} Carry;

// `bound`: each strand has a rigid motion of its own. Errors of shader_build_compute.
Result carry_create(Carry *carry, const GpuLimits *limits, bool bound, Error *error);
void carry_destroy(Carry *carry);

// Changes the state of `solver`, which works on `hair` and must have posed it. `frames`
// ([batches], from bound_set_way or bound_set_start) has a motion for each strand, in place of
// `motion`; NULL if hair is not bound. Only queues GPU work.
void carry_apply(Carry *carry, const Solver *solver, const Hair *hair, const HeadMotion *motion,
                 const GpuBuffer *frames);
