// SPDX-License-Identifier: MIT
// Mass-spring strands: coil and angular springs, implicit or explicit (glsl/spring.comp).
#pragma once

#include "solver.h"

extern const SolverType SOLVER_SPRING;
