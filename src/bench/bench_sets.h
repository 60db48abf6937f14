// SPDX-License-Identifier: MIT
// Solvers' steps on the thesis's sets and on hair files.
#pragma once

#include "bench/bench_speed.h"

// The part "sets": a row for each hair and method, with the thesis's figure and what is stated
// beside it; with --size drawing, too.
Result sets_run(Speed *speed, Error *error);
