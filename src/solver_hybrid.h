// SPDX-License-Identifier: MIT
// Hybrid: tractrices as the length constraint, in two passes (glsl/hybrid.comp).
#pragma once

#include "solver.h"

extern const SolverType SOLVER_HYBRID;
