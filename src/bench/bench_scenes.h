// SPDX-License-Identifier: MIT
// What followers, sleep and sections cost: frames of simulation of scenes that differ in one of
// them.
#pragma once

#include "bench/bench_options.h"

// The command `tractrix-bench scenes`: one frame (a step and the positions that are drawn,
// followers too) of each scene with options->method ("split" if it names none) and options->set
// ("10k16" if NULL), `steps` times after `warm_up` frames. RESULT_FAILED if hair that should sleep
// does not within 60 s.
Result scenes_run(const BenchOptions *options, const Gpu *gpu, Error *error);
