// SPDX-License-Identifier: MIT
// The commands `tractrix-bench step` and `chain`: test the GLSL tractrix with high-precision test
// vectors, each judged by the accuracy that float32 can attain for it.
#pragma once

#include "bench/bench_options.h"

// Allowed errors: of a step in units of `floor32` (the smallest error that float32 evaluation can
// attain), of a chain in units of `sens32` (the change of the result if all inputs are rounded to
// float32).
#define VECTORS_STEP_MARK  16.0
#define VECTORS_CHAIN_MARK 32.0

enum { VECTORS_MAX_CATEGORIES = 64 };

// The rule of a step: ours, or the one published in the thesis.
typedef enum TestVectorsRule { VECTORS_OURS, VECTORS_PUBLISHED } TestVectorsRule;

// Results of a category; errors in units of floor32 or sens32, infinite for NaN.
typedef struct TestVectorsCategory {
    char name[32];
    size_t rows, failed, not_finite;
    long worst_id;
    double worst, median;
    double *ratios; // [rows], until the median is computed
} TestVectorsCategory;

typedef struct TestVectorsReport {
    TestVectorsCategory categories[VECTORS_MAX_CATEGORIES];
    size_t category_count, rows, failed, not_finite;
} TestVectorsReport;

// Steps: a CSV file with a header that contains at least id, category, hx_hex .. pz_hex, floor32,
// tnx, tny, tnz. Chains: FILE.csv with case, kind (P start, M waypoint, R result), index, x_hex ..
// z_hex, x, y, z, and FILE_cases.csv with case, segments, moves, shape, path, sens32; categories
// are "shape path". RESULT_BAD_INPUT names file and line; failed rows are counted and are no error.
// Needs a current context.
Result test_vectors_check_steps(TestVectorsReport *report, const Gpu *gpu, TestVectorsRule rule,
                                const char *path, Error *error);
Result test_vectors_check_chains(TestVectorsReport *report, const Gpu *gpu, const char *path,
                                 Error *error);

// The commands: print a row for each category and one for all; steps by our rule and by the
// thesis's. RESULT_FAILED after all rows if one by our rule exceeds its allowed error.
Result test_vectors_run_steps(const BenchOptions *options, const Gpu *gpu, Error *error);
Result test_vectors_run_chains(const BenchOptions *options, const Gpu *gpu, Error *error);
