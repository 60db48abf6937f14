// SPDX-License-Identifier: MIT
// The commands `tractrix-bench step` and `chain`: the GLSL tractrix on high-precision test vectors,
// each row judged by its own attainable accuracy.
#pragma once

#include "bench/bench_options.h"

// Pass marks: a step's error in units of `floor32` (the error that no float32 evaluation can be
// asked to beat), a chain's in units of `sens32` (what rounding all inputs to float32 does to the
// result).
#define VECTORS_STEP_MARK  16.0
#define VECTORS_CHAIN_MARK 32.0

enum { VECTORS_MAX_CATEGORIES = 64 };

// The rule of a step: ours, or the one that the thesis published.
typedef enum TestVectorsRule { VECTORS_OURS, VECTORS_PUBLISHED } TestVectorsRule;

// The rows of a category; errors in units of floor32 or sens32, infinite for NaN.
typedef struct TestVectorsCategory {
    char name[32];
    size_t rows, failed, not_finite;
    long worst_id;
    double worst, median;
    double *ratios; // [rows], until they are summed up
} TestVectorsCategory;

typedef struct TestVectorsReport {
    TestVectorsCategory categories[VECTORS_MAX_CATEGORIES];
    size_t category_count, rows, failed, not_finite;
} TestVectorsReport;

// Steps: a CSV file with a header naming at least id, category, hx_hex .. pz_hex, floor32, tnx,
// tny, tnz. Chains: FILE.csv with case, kind (P start, M waypoint, R result), index, x_hex ..
// z_hex, x, y, z, and FILE_cases.csv beside it with case, segments, moves, shape, path, sens32.
// Categories are "shape path". RESULT_BAD_INPUT naming file and line; failed rows are no error but
// counted. Needs a current context.
Result test_vectors_check_steps(TestVectorsReport *report, const Gpu *gpu, TestVectorsRule rule,
                                const char *path, Error *error);
Result test_vectors_check_chains(TestVectorsReport *report, const Gpu *gpu, const char *path,
                                 Error *error);

// The commands: a row for each category and one for all; steps by our rule and by the thesis's.
// RESULT_FAILED if a row of our rule is farther off than its mark, after all rows.
Result test_vectors_run_steps(const BenchOptions *options, const Gpu *gpu, Error *error);
Result test_vectors_run_chains(const BenchOptions *options, const Gpu *gpu, Error *error);
