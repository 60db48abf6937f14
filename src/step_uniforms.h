// SPDX-License-Identifier: MIT
// Fills the uniform block that every solver's shaders read.
#pragma once

#include "solver.h"

#include "step.h"

// A compute shader takes this many strands in a work group: enough groups for every core, whole
// SIMD registers.
enum { STEP_GROUP_SIZE = 8 };

// The factors of exact drag c (1/s) over h seconds: *decay = e^{-ch}, *gain = (1 - e^{-ch})/c = h f
// (h at c = 0).
void step_drag_factors(double c, double h, float *decay, float *gain);

// What a step gives to each batch; `strand_count`, `vertex_count` and `passes` are left 0.
StepParams step_uniforms(const SolverStep *step, const SectionParams *params);

// Work groups that cover `count` strands with `strands_per_lane` strands a lane.
uint32_t step_group_count(uint32_t count, uint32_t strands_per_lane);
