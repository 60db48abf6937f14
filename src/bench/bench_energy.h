// SPDX-License-Identifier: MIT
// What strands should keep when nothing but gravity acts: energy and lengths.
#pragma once

#include "bench/bench_accuracy.h"

// The part "energy": a straight strand held horizontally and a helix fall for --seconds, at 30 to
// 240 Hz, with 4, 16 and 64 particles, drag 0 and 1/s, without and with style. The greatest rise of
// energy above the start's in what a strand could lose by falling ("rise"; stated: at most 0.01 for
// default forms) and, without drag and style, the change over the whole run ("change"). Kinetic
// energy is that of the solver's own velocities; "rise as drawn" has it from the drawn motion from
// step to step, and potential energy from the middle of that. Of dftl, whose velocities hold more
// than the motion, there is only the latter; of split, whose tip alone has mass, that of the tip.
Result energy_run(Accuracy *accuracy, Error *error);

// The part "stretch": the greatest | |x_j - x_(j-1)| / l_j - 1 | over all links and frames of the
// exact motions, as drawn (stated: 1e-5) and, of solvers that stretch, as simulated.
Result energy_run_stretch(Accuracy *accuracy, Error *error);
