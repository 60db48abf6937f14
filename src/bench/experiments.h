// SPDX-License-Identifier: MIT
// The table of experiments of `tractrix-bench accuracy`: strands whose motion, rest shape or
// balance is known exactly. accuracy.c runs them with every solver.
#pragma once

#include "bench/experiment.h"

extern const Experiment EXPERIMENTS[];
extern const int EXPERIMENT_COUNT;

// Fills case `number` (from 0 on) of an experiment; false: the method has no more cases.
bool experiments_set_up(const Experiment *experiment, const MotionFolder *folder,
                        const MotionFolder *rods, const Method *method, double seconds, int number,
                        Setup *setup);

// Simulates and measures run->method in run->setup. RESULT_INTERRUPTED after an interrupt.
Result experiments_run(const Experiment *experiment, Run *run, const Gpu *gpu, double rate,
                       Error *error);
