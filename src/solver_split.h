// SPDX-License-Identifier: MIT
// Split: only the tip is simulated, the strand follows it as a chain of tractrices, and the style
// is mixed back in (glsl/split.comp).
#pragma once

#include "solver.h"

extern const SolverType SOLVER_SPLIT;
