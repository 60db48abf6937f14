// SPDX-License-Identifier: MIT
// The commands `tractrix-bench image` and `images`: rows of what drawing takes and how far it is
// from the exact picture.
#pragma once

#include "bench/bench_options.h"

// --set or --tfx as the options say.
Result images_run_one(const BenchOptions *options, const Gpu *gpu, Error *error);

// The schemes and presets that are worth comparing, for sets that look like hair and the files
// that are named.
Result images_run(const BenchOptions *options, const Gpu *gpu, Error *error);
