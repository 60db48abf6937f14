// SPDX-License-Identifier: MIT
// What followers, sleep and sections cost: frames of simulation of scenes that differ in one of
// them.
#pragma once

#include "bench_speed.h"

#include <stdio.h>

// Measures one frame (a step and the positions that are drawn, followers too) of each scene with
// options->method ("split" if it names none) and options->set ("10k16" if NULL), `steps` times
// after `warm_up` frames, and prints a line for each. `rows`: an array that the same goes to, or
// NULL. RESULT_FAILED if hair that should sleep does not within 60 s.
Result scenes_measure(const Gpu *gpu, const BenchOptions *options, FILE *stream, json_t *rows,
                      Error *error);
