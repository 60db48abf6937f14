// SPDX-License-Identifier: MIT
// The command `tractrix-bench accuracy`: how far solvers are from what is known exactly.
#pragma once

#include "bench/bench_options.h"

// Runs the parts that are asked for with each method: every row of EXPERIMENTS (experiments.h), and
// "work", run time against error: for each point (a method and a rate) its mean error over the
// exact motions, and on each set of hair the milliseconds that a simulated second takes. Points on
// the front, those that no other beats in both, are named, and for each set the fastest point at
// some levels of error. RESULT_FAILED if a stated bound is broken, after all rows.
Result accuracy_run(const BenchOptions *options, const Gpu *gpu, Error *error);
