// SPDX-License-Identifier: MIT
// The commands `tractrix-bench image` and `images`: how long drawing hair takes, and how far the
// image is from the exact one (image_reference.h), with the exact light at the vertices
// (shadow_reference.h) for schemes with shadows.
#pragma once

#include "bench/bench_options.h"

// options->scheme on --set or --tfx. RESULT_USAGE unless there is one of both.
Result images_run_one(const BenchOptions *options, const Gpu *gpu, Error *error);

// The schemes and presets that are worth comparing, for sets that look like hair and the files
// that are named.
Result images_run(const BenchOptions *options, const Gpu *gpu, Error *error);
