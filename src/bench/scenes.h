// SPDX-License-Identifier: MIT
// The command `tractrix-bench scenes`: what followers, colliders, sleep and sections cost.
#pragma once

#include "bench/bench_options.h"

// A frame of simulation (a step and the positions that are drawn, followers too) of scenes that
// differ in one of these, with options->method ("split" if it names none) and options->set ("10k16"
// if NULL), `steps` times after `warm_up` frames. RESULT_FAILED if hair that should sleep does not
// within 60 s.
Result scenes_run(const BenchOptions *options, const Gpu *gpu, Error *error);
