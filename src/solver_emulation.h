// SPDX-License-Identifier: MIT
// Emulation: every particle is simulated and pulls the whole strand along (glsl/emulation.comp).
#pragma once

#include "solver.h"

extern const SolverType SOLVER_EMULATION;
