// SPDX-License-Identifier: MIT
// Fills the uniform block that every solver's shaders read.
#pragma once

#include "sim/solver.h"

#include "glsl/sim/step.h"

// Lanes of a work group: on a CPU driver one SIMD register, so that there are many groups to share
// out among the cores; on a GPU whole warps. Both are such that a group's strands are whole tiles,
// or the tile whole groups.
uint32_t step_group_size(const Gpu *gpu);

// The factors of exact drag c (1/s) over h seconds: *decay = e^{-ch}, *gain = (1 - e^{-ch})/c = h f
// (h at c = 0).
void step_drag_factors(double c, double h, float *decay, float *gain);

// What a step gives to each batch; `strand_count`, `vertex_count`, `passes` and `phase` are
// left 0.
StepParams step_uniforms(const SolverStep *step, const SectionParams *params);

// The implicit spring towards the style of stiffness k = style_stiffness style/(1 - style) (1/s^2):
// the share w/(1 + w), w = k dt h f, of the way from a predicted position to the style's. 0 .. 1.
float step_style_pull(const StepParams *uniforms, const SectionParams *params);

// For solvers by the midpoint rule (glsl/sim/midpoint.glsl): `decay` and `gain` become those of
// dt/2, own[1] the springs towards the style: keep, draw (1/s) and their stiffness k (1/s^2). They
// start from rest like any other step: `first` does not matter.
void step_midpoint(StepParams *uniforms, const SolverStep *step, const SectionParams *params);

// Work groups of `group_size` lanes that cover `count` strands with `strands_per_lane` strands a
// lane.
uint32_t step_group_count(uint32_t count, uint32_t group_size, uint32_t strands_per_lane);

// Whether the hair's strands may stay in registers for a step: all have at most `most` vertices,
// and of few different counts, since each costs a compilation (0.2 to 0.7 s on a CPU driver).
bool step_fits_registers(const Hair *hair, uint32_t most);
