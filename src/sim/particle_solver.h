// SPDX-License-Identifier: MIT
// What all solvers that move every particle have in common: positions and velocities on the GPU, a
// compute shader per step. Such a solver is a ParticleRecipe, a GLSL file, and a SolverType with
// .calls = &PARTICLE_SOLVER (solver_dftl.c is the example).
#pragma once

#include "gpu/shader.h"
#include "sim/solver.h"
#include "sim/step_uniforms.h"

// The vec4s of StepParams.own that a recipe may fill.
enum { PARTICLE_OWN = 4 };

typedef struct ParticleRecipe {
    const char *label;          // of the timer: "sim_<name>"
    const char *shader;         // glsl file; see particles.glsl for what it is given
    uint32_t most_in_registers; // strands of at most this many vertices get IN_REGISTERS 1 and
                                // VERTICES; 0: never
    uint32_t scratch; // vec4 a particle of scratch memory (BIND_SCRATCH) where the strand is not in
                      // registers
    uint32_t most_vertices; // longer strands are refused: their loops would take more than the
                            // 65,535 iterations that CPU drivers allow an invocation; 0: any length
    uint32_t carried;       // vertices, from the root, that the head carries; colliders leave them
                            // where they are. The root always is.
    // Refuses what it cannot do by construction, RESULT_USAGE with the reason; NULL: nothing.
    Result (*check)(const SolverSetup *setup, Error *error);
    // Fills StepParams.own for a step, may change other members; NULL: nothing.
    void (*fill)(StepParams *uniforms, const SolverStep *step, const SectionParams *params);
    // Sets the variant's own macros, at most STEP_OWN_DEFINES; {0} ends them. NULL: none.
    void (*define)(ShaderDefine *defines, const SectionParams *params);
    // How many equal sub-steps a step needs for the longest strand; NULL: 1.
    int (*substeps)(const SolverStep *step, const SectionParams *params, const Hair *hair);
    // How many dispatches (StepParams.phase) a (sub-)step takes where strands are not in registers:
    // CPU drivers end loops silently after 65,535 iterations in all of an invocation; NULL: 1.
    int (*phases)(const SectionParams *params, const Hair *hair);
} ParticleRecipe;

// Positions live in Hair's own buffer, so that a pose costs nothing; the first pose puts the style
// where the head is. Velocities start at 0. The recipe is that of the type for the variant.
extern const SolverCalls PARTICLE_SOLVER;

// The velocities of batch `batch` (vec4 a particle, m/s), by hair_address. For tests.
const GpuBuffer *particle_solver_velocities(const void *state, uint32_t batch);
