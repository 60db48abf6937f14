// SPDX-License-Identifier: MIT
// Strands that bend under their own weight, held horizontally at the root: against the exact shape.
#pragma once

#include "bench/bench_accuracy.h"

// The part: RMS distance over the length at rest from the exact shape of the same chain, and for
// stiff strands the tip's drop over that of a continuous beam. chain with --chain-bend and spring
// with --spring-angular; the others have no stiffness against bending that has a formula.
Result beam_run(Accuracy *accuracy, Error *error);
