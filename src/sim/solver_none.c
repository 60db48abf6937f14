// SPDX-License-Identifier: MIT
#include "sim/solver.h"

const SolverType SOLVER_NONE = {
    .name = "none",
    .summary = "hair stiff in its style, carried by the head",
    .lengths = "exact",
    .style = "rigid",
};
