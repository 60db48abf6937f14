// SPDX-License-Identifier: MIT
// The lee of the head: what --wind-shelter needs to know of a step (glsl/sim/forces.glsl).
#pragma once

#include "scene/scene.h"
#include "sim/solver.h"
#include "strands/strands.h"

// The middle of the box around the roots of all sections, in the head's frame (m).
void shelter_middle(float middle[3], const Scene *scene, const Strands *strands);

// Fills the step's shelter and head_velocity from its heads and dt.
void shelter_fill(SolverStep *step, const float middle[3], float share);
