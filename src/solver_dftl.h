// SPDX-License-Identifier: MIT
// Dynamic follow-the-leader: the cheapest way to keep every length (glsl/dftl.comp).
#pragma once

#include "solver.h"

extern const SolverType SOLVER_DFTL;
