// SPDX-License-Identifier: MIT
// One step of time: what it gives to all solvers (glsl/sim/step_params.h), and the compute programs
// that take it.
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
    // The first step from rest: forces act for dt/2 (leapfrog start, which second order needs).
    bool first;
    uint32_t number;         // counts up by 1 from step to step, from any start
    HeadPose head_old, head; // at the step's start and end
    // Of the mesh that hair is bound to: numbers that are equal only where its shape is
    // (bound_body_shape), and the shares of the whole step at which this part begins and ends.
    double shape_old, shape;
    float frame_old, frame_now;
    uint64_t params_stamp;  // equal only where the section's parameters are (section_tracks_stamp)
    float gravity[3];       // m/s^2
    float wind[4][3];       // m/s: mixed by the place of a strand's root
    float shelter[4];       // m: the middle of the head; share of the wind kept off behind it
    float head_velocity[3]; // m/s, of that middle
} SolverStep;

// Fills the step's shelter and head_velocity from its heads and dt: the lee of the head, whose
// middle in its own frame is `middle` (m, head_middle), keeps off `share` of the wind.
void step_shelter(SolverStep *step, const float middle[3], float share);

// The factors of exact drag c (1/s) over h seconds: *decay = e^{-ch}, *gain = (1 - e^{-ch})/c = h f
// (h at c = 0).
void step_drag_factors(double c, double h, float *decay, float *gain);

// What a step gives to each batch; `strand_count`, `vertex_count` and `phase` are left 0.
StepParams step_uniforms(const SolverStep *step, const SectionParams *params);

// The spring towards the style over h seconds (glsl/sim/style_spring.h), under the drag of
// `uniforms`.
StyleSpring step_style_spring(const StepParams *uniforms, double h, const SectionParams *params);

// For solvers by the midpoint rule (glsl/sim/midpoint.glsl): `decay` and `gain` become those of
// dt/2, for which the spring is. They start from rest like any other step: `first` does not matter.
StyleSpring step_midpoint(StepParams *uniforms, const SolverStep *step,
                          const SectionParams *params);

// SolverRecipe.along of solvers whose block begins with a StyleSpring: that spring.
void step_spring_along(float texel[4], const void *block, const void *mean,
                       const SectionParams *there);

// style/(1 - style): 1, a stiffness as given, for style 0.5.
float step_style_odds(const SectionParams *params);

enum { STEP_OWN_DEFINES = 8 };

// A program that works on strands, a lane each, and its parameters. A zeroed one may be destroyed.
typedef struct StepPass {
    GLuint program;
    const GpuLimits *limits; // the context's
} StepPass;

// `defines`: all macros but GROUP_SIZE, STEP_OWN_DEFINES at most, ended by {0}; NULL: none. Errors
// of shader_build_compute.
Result step_pass_create(StepPass *pass, const Gpu *gpu, const char *shader,
                        const ShaderDefine *defines, Error *error);
void step_pass_destroy(StepPass *pass);

// Runs it on `strand_count` strands with the block `params` of `size` bytes at BIND_STEP; the other
// buffers are bound.
void step_pass_run(StepPass *pass, const void *params, size_t size, uint32_t strand_count);

// What decides how many programs a solver has and how strands go to lanes.
typedef struct StepProgramsOptions {
    const char *shader; // glsl file
    StepShape shape;    // which strands get IN_REGISTERS 1, and how many strands a lane takes
    uint32_t lead;      // vertices that the head carries beside the root, where a strand has enough
    bool sheltered;     // the head keeps wind off (forces.glsl)
    bool styled;        // there is a spring towards the style
    bool varies;        // parameters differ along the strand (along.h)
    bool bound;         // strands have frames of their own (bound.h)
    const ShaderDefine *defines; // the variant's own, at most STEP_OWN_DEFINES
} StepProgramsOptions;

// The programs of a solver: one for each of a hair's batches, shared where batches are alike.
typedef struct StepPrograms {
    GLuint *programs; // [batch_count]; equal ones may be the same
    uint32_t *leads;  // [batch_count]: of the batch's strands
    uint32_t batch_count, strands_per_lane;
    const GpuLimits *limits; // the context's
    bool in_registers;
    bool ordered; // the state is read by the buffers that it is written to (particles.glsl)
} StepPrograms;

// Compiles with the macros GROUP_SIZE (lanes), STRANDS (a lane's), IN_REGISTERS, VERTICES (but for
// the lead), LEAD, SHELTER, STYLED, VARIES, ORDERED, BOUND and the own ones. Strands are in
// registers if all are short enough and of few different counts. Errors of shader_build_compute;
// RESULT_FAILED without memory.
Result step_programs_create(StepPrograms *programs, const Gpu *gpu, const Hair *hair,
                            const StepProgramsOptions *options, Error *error);
void step_programs_destroy(StepPrograms *programs);

// Runs batch `batch` of `strand_count` strands; the buffers are bound.
void step_programs_dispatch(const StepPrograms *programs, uint32_t batch, uint32_t strand_count);
