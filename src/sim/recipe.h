// SPDX-License-Identifier: MIT
// What a solver is made of: its state, its shader, its parameters. A new solver is a GLSL file, a C
// file with a SolverRecipe and a SolverType, and a line of SOLVERS.
#pragma once

#include "gpu/gpu_timer.h"
#include "gpu/shader.h"
#include "scene/colliders.h"
#include "sim/distance_field.h"
#include "sim/step.h"

// What a solver works on. All of it outlives the solver.
typedef struct SolverSetup {
    const Gpu *gpu;
    GpuTimer *timer; // spans "sim_<name>" and "pose"
    const Hair *hair;
    // Of parameters that change over time (`start` is there) the greatest values, while the solver
    // is made; later those of the step.
    const SectionParams *params;
    const SectionParams *start; // as at time 0; NULL: nothing changes
    bool style_changes;         // in time
    const HeadPose *head;       // at the start; NULL: where the style is
    const Colliders *colliders; // shapes that hair must not cross; NULL: none
    const DistanceField *field; // a mesh that it must not cross; NULL: none
    const GpuBuffer *frames;    // [batches] of strands on a mesh that deforms (bound.h); NULL: none
    bool sheltered;             // SolverStep.shelter counts
    bool keeps_groom;           // colliders do not push what is as near to them in the groom
    const Hair *bounds;         // whose bounds and longest strand hold for `hair`; NULL: its own
    // m/s^2, in the world: under which the groom is at rest, with the head at `head`; 0 0 0: hair
    // falls from there (--rest hanging).
    float rest_gravity[3];
} SolverSetup;

// Events so far, for the statistics.
typedef struct SolverReport {
    uint64_t moves_limited; // moves cut because a particle was flung beyond what float32 can follow
    uint64_t contacts;      // particles that touched a collider in the last step
    // m: deepest that a particle was in a collider, with its margin, before it was pushed out, and
    // after.
    float deepest_found, deepest_left;
} SolverReport;

// What a strand hands on from one step to the next. Hair starts at rest.
typedef enum SolverStateKind {
    // Positions and velocities (vec4 a particle). Positions live in Hair's own buffer, so that a
    // pose costs nothing. glsl/sim/particles.glsl has what the shader is given.
    SOLVER_PARTICLES,
    // Unit directions with rest lengths (vec4 a particle, j = 0 unused), and tips (two vec4 a
    // strand: position, times limited; velocity). The pose mixes the style into what is drawn
    // (pose.h). With a rest gravity they start hanging straight down.
    SOLVER_SEGMENTS,
} SolverStateKind;

typedef struct SolverRecipe {
    const char *label;  // of the timer: "sim_<name>"
    const char *shader; // glsl file
    SolverStateKind state;
    StepShape shape; // which strands get IN_REGISTERS 1 and VERTICES: a row of STEP_SIZES
    // vec4 a particle of scratch memory (BIND_SCRATCH) where the strand is not in registers.
    uint32_t scratch;
    // Longer strands are refused: their loops would take more than the 65,535 iterations that CPU
    // drivers allow an invocation, after which they end them silently; 0: any length.
    uint32_t most_vertices;
    // Vertices, from the root, that the head carries; colliders leave them where they are. The root
    // always is.
    uint32_t carried;
    size_t params_size; // of its uniform block (BIND_SOLVER), bytes; 0: it has none
    // Refuses what it cannot do by construction, RESULT_USAGE with the reason; NULL: nothing.
    Result (*check)(const SolverSetup *setup, Error *error);
    // Fills its block, params_size zero bytes, for a step; may change `uniforms`. NULL: nothing.
    void (*fill)(void *block, StepParams *uniforms, const SolverStep *step,
                 const SectionParams *params);
    // Sets the variant's own macros beside those of step_programs_create, at most STEP_OWN_DEFINES;
    // {0} ends them. NULL: none.
    void (*define)(ShaderDefine *defines, const SectionParams *params);
    // For profiles (along.h): what the shader reads of one vertex, of its block by `fill` with the
    // parameters as they are there, and the block of their means. NULL: it takes the means.
    void (*along)(float texel[4], const void *block, const void *mean, const SectionParams *there);
    // How many equal sub-steps a step needs for the longest strand; NULL: 1.
    int (*substeps)(const SolverStep *step, const SectionParams *params, const Hair *hair);
    // How many dispatches (StepParams.phase) a (sub-)step takes where strands are not in registers;
    // NULL: 1.
    int (*phases)(const SectionParams *params, const Hair *hair);
} SolverRecipe;
