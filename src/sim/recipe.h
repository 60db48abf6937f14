// SPDX-License-Identifier: MIT
// A recipe describes a solver: its state, its shader and its parameters. A new solver is a GLSL
// file, a C file with a SolverRecipe and a SolverType, and a line in SOLVERS (solver.h).
#pragma once

#include "gpu/gpu_timer.h"
#include "gpu/shader.h"
#include "scene/colliders.h"
#include "sim/distance_field.h"
#include "sim/step.h"

// The input of a solver. All of it must outlive the solver.
typedef struct SolverSetup {
    const Gpu *gpu;
    GpuTimer *timer; // spans "sim_<name>" and "pose"
    const Hair *hair;
    // If parameters change over time (`start` is not NULL): their greatest values while the solver
    // is created, and the values of the current step later.
    const SectionParams *params;
    const SectionParams *start; // the parameters at time 0; NULL: no parameter changes over time
    bool style_changes;         // the style changes over time
    const HeadPose *head;       // at the start; NULL: the head's frame is the world's
    const Colliders *colliders; // shapes that hair must not cross; NULL: none
    const DistanceField *field; // a mesh that hair must not cross; NULL: none
    const GpuBuffer *frames;    // [batches] of strands on a mesh that deforms (bound.h); NULL: none
    bool sheltered;             // SolverStep.shelter is used
    bool keeps_groom;           // particles may stay as near to colliders as in the groom
    const Hair *bounds;         // hair whose bounds and longest strand are used; NULL: `hair`
    // m/s^2, in the world: gravity in which the groom is at rest, with the head at `head`. 0 0 0:
    // hair falls from the groom (--rest hanging).
    float rest_gravity[3];
} SolverSetup;

// Numbers of events so far, for the statistics.
typedef struct SolverReport {
    uint64_t moves_limited;  // moves that were cut, because they went too far for float32
    uint64_t strands_slowed; // in all steps: strands of `rod` whose energy was limited
    // Of grooms that elastic strands carry, m^2/s^2 a strand, added up: their weight, and the
    // forces that hold what the strands cannot carry.
    double groom_weight, groom_held;
    uint64_t contacts; // particles that touched a collider in the last step
    // m: depth of the deepest particle in a collider (margin included), before and after it was
    // pushed out.
    float deepest_found, deepest_left;
} SolverReport;

// The state that a strand passes on from one step to the next. Hair starts at rest.
typedef enum SolverStateKind {
    // Positions and velocities (vec4 a particle). Positions are stored in Hair's own buffer, so a
    // pose costs nothing. glsl/sim/particles.glsl lists the shader's inputs.
    SOLVER_PARTICLES,
    // Unit directions with rest lengths (vec4 a particle, j = 0 unused), and tips (two vec4 a
    // strand: position and number of limited moves; velocity). The pose blends the style into the
    // drawn strand (pose.h). With a rest gravity strands start hanging straight down.
    SOLVER_SEGMENTS,
} SolverStateKind;

// The strands of a batch, for which SolverRecipe.balance finds the shape without load. Texels are
// addressed by hair_address; those before the solver's root stay 0.
typedef struct RestBatch {
    const HairBatch *hair;
    const SectionParams *params;
    uint32_t lead;           // vertices before the solver's root
    const float *gravity;    // m/s^2, in the head's frame: the groom is at rest in it
    const float (*rest)[4];  // as HairBatch.rest
    float (*natural)[4];     // written: direction, unloaded twist (rod_joint.glsl)
    float (*held)[4];        // written: the force that holds each particle (rod.comp)
    double weight, supports; // added: weight of the strands, and of it what is held
} RestBatch;

typedef struct SolverRecipe {
    const char *label;  // the timer's span: "sim_<name>"
    const char *shader; // glsl file
    SolverStateKind state;
    StepShape shape; // which strands get IN_REGISTERS 1 and VERTICES: a row of STEP_SIZES
    // vec4 a particle of scratch memory (BIND_SCRATCH) where the strand is not in registers.
    uint32_t scratch;
    // Longer strands are refused, because CPU drivers silently end the loops of an invocation after
    // 65,535 iterations; 0: any length.
    uint32_t most_vertices;
    // Number of vertices, from the root, that the head carries and that colliders do not move. The
    // root is always one of them.
    uint32_t carried;
    size_t params_size; // of its uniform block (BIND_SOLVER), bytes; 0: it has none
    // Refuses setups that the solver cannot handle: RESULT_USAGE with the reason. NULL: takes all.
    Result (*check)(const SolverSetup *setup, Error *error);
    // Fills the uniform block (params_size bytes, zero before the call) for a step; may change
    // `uniforms`. NULL: nothing to fill.
    void (*fill)(void *block, StepParams *uniforms, const SolverStep *step,
                 const SectionParams *params);
    // Sets the variant's own macros, in addition to those of step_programs_create: at most
    // STEP_OWN_DEFINES, ended by {0}. NULL: none.
    void (*define)(ShaderDefine *defines, const SectionParams *params);
    // For profiles (along.h): computes the texel that the shader reads for one vertex. `block` was
    // filled with the parameters at that vertex (`there`), `mean` with the means of the profiles.
    // NULL: the solver uses the means.
    void (*along)(float texel[4], const void *block, const void *mean, const SectionParams *there);
    // For solvers that find a shape whose own elasticity carries the weight of the groom, instead
    // of the difference of gravity that the others apply (solver.c). RESULT_FAILED when memory is
    // short.
    Result (*balance)(RestBatch *batch, Error *error);
    // For strands that resist bending: B/(rho A) by which a step's end is held back, over the
    // stiffness 2/dt^2 of inertia, m^4. Contacts respect it (collide.comp). NULL: 0.
    float (*bend)(const SectionParams *params, double dt);
    // The velocity at a step's end is 2 u/dt - v, for contacts (MIDPOINT of collide.comp).
    bool midpoint;
    // The shader counts strands that it slows down (a uint at BIND_TIPS).
    bool counts;
    // Number of equal sub-steps that a step needs for the longest strand; NULL: 1.
    int (*substeps)(const SolverStep *step, const SectionParams *params, const Hair *hair);
    // Number of dispatches (StepParams.phase) of a sub-step if strands are not in registers; NULL:
    // 1.
    int (*phases)(const SectionParams *params, const Hair *hair);
} SolverRecipe;
