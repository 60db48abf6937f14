// SPDX-License-Identifier: MIT
#include "sim/solver.h"

const SolverType SOLVER_NONE = {
    .name = "none",
    .summary = "no simulation: hair keeps the shape that the file has, and moves with the head",
    .lengths = "exact",
    .style = "rigid",
};
