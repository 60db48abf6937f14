// SPDX-License-Identifier: MIT
// Run time against error: solvers with their settings as points.
#pragma once

#include "bench/bench_accuracy.h"

// The part: for each point (a method and a rate) its mean error over the exact motions, and on each
// set of hair the milliseconds that a simulated second takes, both in this run. Points on the
// front, those that no other beats in both, are named, and for each set the fastest point at some
// levels of error. A method with a variant or settings of its own is measured alone; else those
// that are worth comparing.
Result work_run(Accuracy *accuracy, Error *error);
