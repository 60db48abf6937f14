// SPDX-License-Identifier: MIT
// One time step: the values that it gives to all solvers (glsl/sim/step_params.h), and the compute
// programs that run it.
#pragma once

#include "base/params.h"
#include "gpu/shader.h"
#include "sim/hair.h"
#include "sim/head.h"
#include "sim/step_sizes.h"

#include "glsl/sim/step_params.h"
#include "glsl/sim/style_spring.h"

// A step, the same for all sections.
typedef struct SolverStep {
    double dt; // s
    // The first step from rest: forces act for dt/2 (the leapfrog start that second order needs).
    bool first;
    uint32_t number;         // increases by 1 from step to step; any first value
    HeadPose head_old, head; // at the step's start and end
    // A point near the hair, in the head's frame (m), and what rounding of the poses takes from its
    // displacement in the step (step_set_move). 0 if unknown.
    float pivot[3], move_lost[3];
    // The shape of the mesh that hair is bound to, at the step's start and end (bound_body_shape).
    double shape_old, shape;
    float frame_old, frame_now; // a sub-step's begin and end, as fractions of the whole step
    uint64_t params_stamp;      // identifies the section's parameters (section_tracks_stamp)
    float gravity[3];           // m/s^2
    float wind[4][3];           // m/s: mixed for each strand, by the position of its root
    float shelter[4];           // xyz: middle of the head (m); w: share of the wind that it blocks
    float head_velocity[3];     // m/s, of the middle of the head
} SolverStep;

// Sets `pivot` and says by how much it moves in the step, in the world (m). Far from the origin,
// roots that move by the difference of two rounded poses would tremble in short steps.
void step_set_move(SolverStep *step, const float pivot[3], const double move[3]);

// Fills the step's shelter and head_velocity from its head poses and dt. `middle`: the middle of
// the head in the head's frame (m, head_middle); `share`: share of the wind that the head blocks.
void step_shelter(SolverStep *step, const float middle[3], float share);

// The factors of exact drag c (1/s) over h seconds: *decay = e^{-ch}, *gain = (1 - e^{-ch})/c,
// which is h at c = 0.
void step_drag_factors(double c, double h, float *decay, float *gain);

// The uniforms of a step, the same for each batch; `strand_count`, `vertex_count` and `phase` are
// left 0.
StepParams step_uniforms(const SolverStep *step, const SectionParams *params);

// The spring towards the style over h seconds (glsl/sim/style_spring.h), with the drag of
// `uniforms`.
StyleSpring step_style_spring(const StepParams *uniforms, double h, const SectionParams *params);

// For solvers that use the midpoint rule (glsl/sim/midpoint.glsl): changes `decay` and `gain` to
// those of dt/2 and returns the spring for dt/2. The first step is like any other, so step->first
// is not used.
StyleSpring step_midpoint(StepParams *uniforms, const SolverStep *step,
                          const SectionParams *params);

// SolverRecipe.along for solvers whose uniform block begins with a StyleSpring: writes that
// spring.
void step_spring_along(float texel[4], const void *block, const void *mean,
                       const SectionParams *there);

// style/(1 - style), the factor of stiffnesses: 1 for style 0.5.
float step_style_odds(const SectionParams *params);

enum { STEP_OWN_DEFINES = 12 };

// A compute program that works on strands, one strand a lane. A zeroed struct may be destroyed.
typedef struct StepPass {
    GLuint program;
    const GpuLimits *limits; // the context's
} StepPass;

// `defines`: all macros except GROUP_SIZE, at most STEP_OWN_DEFINES, ended by {0}; NULL: none.
// Errors of shader_build_compute.
Result step_pass_create(StepPass *pass, const Gpu *gpu, const char *shader,
                        const ShaderDefine *defines, Error *error);
void step_pass_destroy(StepPass *pass);

// Runs the program on `strand_count` strands, with the uniform block `params` of `size` bytes at
// BIND_STEP. The caller has bound the other buffers.
void step_pass_run(StepPass *pass, const void *params, size_t size, uint32_t strand_count);

// What decides how many programs a solver has, and how strands are assigned to lanes.
typedef struct StepProgramsOptions {
    const char *shader; // glsl file
    StepShape shape;    // row of STEP_SIZES: which strands stay in registers, strands per lane
    // Vertices after the root that the head carries: of strands that keep a free tip, `lead`; where
    // mobility holds more (HairBatch.held), those beyond the `carried` of the solver itself.
    uint32_t lead, carried;
    uint32_t most_vertices;      // SolverRecipe.most_vertices
    bool sheltered;              // the head blocks wind (forces.glsl)
    bool styled;                 // there is a spring towards the style
    bool varies;                 // parameters differ along the strand (along.h)
    bool bound;                  // strands have frames of their own (bound.h)
    const ShaderDefine *defines; // the variant's own, at most STEP_OWN_DEFINES
} StepProgramsOptions;

// The programs of a solver: one for each batch of the hair, 0 where all vertices are held.
typedef struct StepPrograms {
    GLuint *programs; // [batch_count]
    uint32_t *leads;  // [batch_count]: vertices after the root that the head carries
    uint32_t batch_count, strands_per_lane;
    const GpuLimits *limits; // the context's
    bool in_registers;
    bool ordered; // the state is read through the buffers it is written to (particles.glsl)
} StepPrograms;

// Compiles the programs with the macros GROUP_SIZE (lanes), STRANDS (per lane), IN_REGISTERS,
// VERTICES (without the lead; 0: not in registers), LEAD, SHELTER, STYLED, VARIES, ORDERED, BOUND
// and the solver's own. Strands are kept in registers if all are short enough and they have few
// different vertex counts. Errors of shader_build_compute; RESULT_FAILED when memory is short.
Result step_programs_create(StepPrograms *programs, const Gpu *gpu, const Hair *hair,
                            const StepProgramsOptions *options, Error *error);
void step_programs_destroy(StepPrograms *programs);

// Runs the program of batch `batch` on `strand_count` strands. The caller has bound the buffers.
void step_programs_dispatch(const StepPrograms *programs, uint32_t batch, uint32_t strand_count);

// Number of lanes with work in that dispatch; each has its own scratch memory.
uint64_t step_programs_lanes(const StepPrograms *programs, uint32_t strand_count);
