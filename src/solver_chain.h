// SPDX-License-Identifier: MIT
// Chain: rigid segments by direct tridiagonal solves, second order in the step (glsl/chain.comp).
#pragma once

#include "solver.h"

extern const SolverType SOLVER_CHAIN;
