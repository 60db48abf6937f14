// SPDX-License-Identifier: MIT
// A heavy tip against pendulums.
#pragma once

#include "bench/bench_accuracy.h"

// The part: RMS distance from exact pendulums over their length of 0.25 m, and the order, for each
// pendulum of e_pendulum_planar.csv (from rest, without drag, columns x_A90, y_A90: by the
// amplitude in degrees) and e_pendulum_3d.csv with e_pendulum_3d.json (start, velocity and drag of
// each name). split: the tip of a straight strand of 16; other solvers: a strand of 2. Those whose
// velocities cannot be set start from rest only. A folder without these files has no rows.
Result pendulum_run(Accuracy *accuracy, Error *error);
