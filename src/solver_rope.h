// SPDX-License-Identifier: MIT
// Position-based rope, as Bullet's soft bodies are used for hair, and XPBD (glsl/rope.comp).
#pragma once

#include "solver.h"

extern const SolverType SOLVER_ROPE;
