// SPDX-License-Identifier: MIT
// The commands `tractrix-bench step` and `chain`: the tractrix in float32 against exact results.
#pragma once

#include "bench/bench_options.h"

// A row for each category and one for all, by our rule and by the thesis's. RESULT_FAILED if a step
// of ours is farther off than VECTORS_STEP_MARK, after all rows.
Result bench_step(const BenchOptions *options, const Gpu *gpu, Error *error);

// The same for chains that are pulled along paths, by our rule; VECTORS_CHAIN_MARK.
Result bench_chain(const BenchOptions *options, const Gpu *gpu, Error *error);
