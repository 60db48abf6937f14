// SPDX-License-Identifier: MIT
// TressFX's solver, with its parameters, and a form of it whose stiffness depends on nothing else
// (glsl/tressfx.comp).
#pragma once

#include "solver.h"

extern const SolverType SOLVER_TRESSFX;
