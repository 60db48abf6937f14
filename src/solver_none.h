// SPDX-License-Identifier: MIT
// No solver: hair stiff in its style, carried by the head.
#pragma once

#include "solver.h"

extern const SolverType SOLVER_NONE;
