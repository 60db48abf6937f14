// SPDX-License-Identifier: MIT
#include "bench/test_vectors.h"
#include "base/csv.h"
#include "bench/bench_glsl.h"
#include "gpu/gpu_buffer.h"
#include "gpu/gpu_dispatch.h"

#include "glsl/common/shared.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CHECK_LANES = 8 }; // work group size of glsl/bench/check_*.comp

typedef float Float4[4];

static Result judge(TestVectorsReport *report, const char *category, long id, double ratio,
                    double mark, Error *error)
{
    size_t i = 0;
    while (i < report->category_count && strcmp(report->categories[i].name, category) != 0) ++i;
    if (i == VECTORS_MAX_CATEGORIES)
        return error_set(error, RESULT_BAD_INPUT, "too many categories: expected at most %zu", i);
    TestVectorsCategory *at = &report->categories[i];
    if (i == report->category_count) {
        ++report->category_count;
        snprintf(at->name, sizeof at->name, "%s", category);
        at->worst = -1;
    }
    double *ratios = realloc(at->ratios, (at->rows + 1) * sizeof *ratios);
    if (!ratios) return error_set(error, RESULT_FAILED, "no memory for rows");
    at->ratios = ratios;
    bool finite = isfinite(ratio), failed = !(ratio <= mark);
    if (!finite) ratio = INFINITY;
    at->ratios[at->rows] = ratio;
    at->failed += failed, report->failed += failed;
    at->not_finite += !finite, report->not_finite += !finite;
    ++at->rows, ++report->rows;
    if (ratio > at->worst) at->worst = ratio, at->worst_id = id;
    return RESULT_OK;
}

static void sum_up(TestVectorsReport *report)
{
    for (size_t i = 0; i < report->category_count; ++i) {
        TestVectorsCategory *at = &report->categories[i];
        at->median = table_times(at->ratios, (int)at->rows).median;
        free(at->ratios);
        at->ratios = NULL;
    }
}

// --- Reading.

static Result read_number(const Csv *csv, size_t row, const char *name, double *value, Error *error)
{
    size_t column;
    TRY(csv_find(csv, name, &column, error));
    return csv_number(csv, row, column, value, error);
}

// Reads the columns BEFOREx_AFTER, BEFOREy_AFTER and BEFOREz_AFTER.
static Result read_vector(const Csv *csv, size_t row, const char *before, const char *after,
                          double value[3], Error *error)
{
    for (int k = 0; k < 3; ++k) {
        char name[32];
        snprintf(name, sizeof name, "%s%c%s", before, "xyz"[k], after);
        TRY(read_number(csv, row, name, &value[k], error));
    }
    return RESULT_OK;
}

static Result read_text(const Csv *csv, size_t row, const char *name, const char **text,
                        Error *error)
{
    size_t column;
    TRY(csv_find(csv, name, &column, error));
    *text = csv_text(csv, row, column);
    return RESULT_OK;
}

static double distance(const double a[3], const float b[3])
{
    double sum = 0;
    for (int k = 0; k < 3; ++k) sum += (a[k] - (double)b[k]) * (a[k] - (double)b[k]);
    return sqrt(sum);
}

// A storage buffer of a check shader. The buffer at BIND_POSITION_OUT is read back into `results`.
typedef struct CheckBuffer {
    GLuint binding;
    const void *data;
    size_t size;
} CheckBuffer;

static Result run_check(const Gpu *gpu, const char *file, const ShaderDefine *defines,
                        const CheckBuffer *inputs, int count, size_t lanes, void *results,
                        size_t size, Error *error)
{
    GLuint program = 0;
    GpuBuffer buffers[4] = {{0}};
    shader_add_sources(BENCH_GLSL_SOURCES);
    Result result = shader_build_compute(&program, file, defines, error);
    for (int i = 0; i < count && result == RESULT_OK; ++i) {
        result = gpu_buffer_create(&buffers[i], &gpu->limits, file, (int64_t)inputs[i].size,
                                   inputs[i].data, 0, error);
        if (result == RESULT_OK) gpu_buffer_bind_storage(&buffers[i], inputs[i].binding);
    }
    if (result == RESULT_OK) {
        glUseProgram(program);
        gpu_dispatch(&gpu->limits, lanes, CHECK_LANES, 1);
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffers[0].buffer);
        glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)size, results);
        result = gpu_check(file, error);
    }
    for (int i = 0; i < count; ++i) gpu_buffer_destroy(&buffers[i]);
    shader_release(program);
    return result;
}

// --- Steps.

static Result read_steps(const Csv *csv, Float4 *cases, Error *error)
{
    static const char *const points[] = {"h", "t", "p"};
    for (size_t i = 0; i < 3 * csv->row_count; ++i) {
        double value[3];
        TRY(read_vector(csv, i / 3, points[i % 3], "_hex", value, error));
        for (int k = 0; k < 3; ++k) cases[i][k] = (float)value[k];
    }
    return RESULT_OK;
}

static Result judge_steps(TestVectorsReport *report, const Csv *csv, const Float4 *tails,
                          Error *error)
{
    for (size_t row = 0; row < csv->row_count; ++row) {
        double exact[3], floor32 = 0, id = 0;
        const char *category;
        TRY(read_vector(csv, row, "tn", "", exact, error));
        TRY(read_number(csv, row, "floor32", &floor32, error));
        TRY(read_number(csv, row, "id", &id, error));
        TRY(read_text(csv, row, "category", &category, error));
        double wrong = distance(exact, tails[row]);
        TRY(judge(report, category, (long)id, wrong == 0 ? 0 : wrong / floor32, VECTORS_STEP_MARK,
                  error));
    }
    return RESULT_OK;
}

Result test_vectors_check_steps(TestVectorsReport *report, const Gpu *gpu, TestVectorsRule rule,
                                const char *path, Error *error)
{
    const ShaderDefine defines[] = {{"PUBLISHED", rule == VECTORS_PUBLISHED}, {0}};
    Csv csv;
    *report = (TestVectorsReport){0};
    TRY(csv_read(&csv, path, error));
    size_t size = csv.row_count * sizeof(Float4);
    Float4 *cases = calloc(3, size + 1), *tails = calloc(1, size + 1);
    Result result = cases && tails ? read_steps(&csv, cases, error)
                                   : error_set(error, RESULT_FAILED, "%s: no memory", path);
    const CheckBuffer buffers[] = {{BIND_POSITION_OUT, tails, size},
                                   {BIND_STATE_OUT, cases, 3 * size}};
    THEN(result, run_check(gpu, "bench/check_step.comp", defines, buffers, 2, csv.row_count, tails,
                           size, error));
    THEN(result, judge_steps(report, &csv, (const Float4 *)tails, error));
    sum_up(report);
    free(cases);
    free(tails);
    csv_destroy(&csv);
    return result;
}

// --- Chains. Start points and results have the same numbering; waypoints have their own.

typedef struct Span {
    uint32_t first_point, segments, first_waypoint, waypoints;
} Span;

typedef struct Chains {
    Csv cases, points;
    Span *spans;
    size_t point_count, waypoint_count;
    Float4 *start, *waypoint, *result;
    double (*exact)[3];
} Chains;

static void chains_destroy(Chains *chains)
{
    free(chains->spans);
    free(chains->start);
    free(chains->waypoint);
    free(chains->result);
    free(chains->exact);
    csv_destroy(&chains->cases);
    csv_destroy(&chains->points);
}

static Result read_spans(Chains *chains, Error *error)
{
    const Csv *csv = &chains->cases;
    chains->spans = calloc(csv->row_count, sizeof *chains->spans);
    if (!chains->spans) return error_set(error, RESULT_FAILED, "no memory for chains");
    for (size_t row = 0; row < csv->row_count; ++row) {
        double id, segments, moves;
        TRY(read_number(csv, row, "case", &id, error));
        TRY(read_number(csv, row, "segments", &segments, error));
        TRY(read_number(csv, row, "moves", &moves, error));
        if (!(id == (double)row && segments >= 1 && segments <= 65535 && moves >= 0 &&
              moves <= 1e6))
            return error_set(error, RESULT_BAD_INPUT,
                             "%s:%zu: wrong case or numbers: expected case %zu with 1 to 65535 "
                             "segments and 0 to 1000000 moves",
                             csv->path, row + 2, row);
        chains->spans[row] = (Span){(uint32_t)chains->point_count, (uint32_t)segments,
                                    (uint32_t)chains->waypoint_count, (uint32_t)moves};
        chains->point_count += (size_t)segments + 1;
        chains->waypoint_count += (size_t)moves;
    }
    return RESULT_OK;
}

// Reads a start point (P), a waypoint (M) or a result (R).
static Result read_point(Chains *chains, size_t row, Error *error)
{
    const Csv *csv = &chains->points;
    double id, index, value[3];
    const char *kind;
    TRY(read_text(csv, row, "kind", &kind, error));
    TRY(read_number(csv, row, "case", &id, error));
    TRY(read_number(csv, row, "index", &index, error));
    TRY(read_vector(csv, row, "", *kind == 'R' ? "" : "_hex", value, error));
    bool known = id >= 0 && id < (double)chains->cases.row_count && index >= 0;
    const Span *span = &chains->spans[known ? (size_t)id : 0];
    bool waypoint = *kind == 'M';
    if (!known || index >= (waypoint ? span->waypoints : span->segments + 1) ||
        !strchr("PMR", *kind))
        return error_set(error, RESULT_BAD_INPUT,
                         "%s:%zu: unknown case, kind or index: expected a case of the other file, "
                         "kind P, M or R, and an index in its range",
                         csv->path, row + 2);
    size_t at = (waypoint ? span->first_waypoint : span->first_point) + (size_t)index;
    for (int k = 0; k < 3; ++k) {
        if (*kind == 'R')
            chains->exact[at][k] = value[k];
        else
            (waypoint ? chains->waypoint : chains->start)[at][k] = (float)value[k];
    }
    return RESULT_OK;
}

static Result read_chains(Chains *chains, const char *path, Error *error)
{
    char cases_path[4096];
    size_t stem = strlen(path);
    if (stem > 4 && strcmp(path + stem - 4, ".csv") == 0) stem -= 4;
    snprintf(cases_path, sizeof cases_path, "%.*s_cases.csv", (int)stem, path);
    TRY(csv_read(&chains->points, path, error));
    TRY(csv_read(&chains->cases, cases_path, error));
    TRY(read_spans(chains, error));
    chains->start = calloc(chains->point_count, sizeof(Float4));
    chains->result = calloc(chains->point_count, sizeof(Float4));
    chains->waypoint = calloc(chains->waypoint_count + 1, sizeof(Float4));
    chains->exact = calloc(chains->point_count, sizeof *chains->exact);
    if (!chains->start || !chains->result || !chains->waypoint || !chains->exact)
        return error_set(error, RESULT_FAILED, "%s: no memory", path);
    for (size_t row = 0; row < chains->points.row_count; ++row) TRY(read_point(chains, row, error));
    return RESULT_OK;
}

// Finds the largest distance of a point in each chain, over the chain's mean segment.
static Result judge_chains(TestVectorsReport *report, const Chains *chains, Error *error)
{
    for (size_t row = 0; row < chains->cases.row_count; ++row) {
        const Span *span = &chains->spans[row];
        double sens32, worst = 0, length = 0;
        char category[32];
        const char *shape, *path;
        TRY(read_number(&chains->cases, row, "sens32", &sens32, error));
        TRY(read_text(&chains->cases, row, "shape", &shape, error));
        TRY(read_text(&chains->cases, row, "path", &path, error));
        for (uint32_t j = span->first_point; j <= span->first_point + span->segments; ++j) {
            const float *x = chains->start[j];
            double wrong = distance(chains->exact[j], chains->result[j]);
            if (!(wrong <= worst)) worst = wrong;
            if (j > span->first_point)
                length += distance((double[3]){(double)x[0], (double)x[1], (double)x[2]},
                                   chains->start[j - 1]);
        }
        snprintf(category, sizeof category, "%.14s %.14s", shape, path);
        TRY(judge(report, category, (long)row, worst / (length / span->segments) / sens32,
                  VECTORS_CHAIN_MARK, error));
    }
    return RESULT_OK;
}

Result test_vectors_check_chains(TestVectorsReport *report, const Gpu *gpu, const char *path,
                                 Error *error)
{
    *report = (TestVectorsReport){0};
    Chains chains = {0};
    Result result = read_chains(&chains, path, error);
    if (result == RESULT_OK) {
        size_t size = chains.point_count * sizeof(Float4);
        const CheckBuffer buffers[] = {
            {BIND_POSITION_OUT, chains.start, size},
            {BIND_STATE_OUT, chains.spans, chains.cases.row_count * sizeof *chains.spans},
            {BIND_TIPS, chains.waypoint, (chains.waypoint_count + 1) * sizeof(Float4)},
        };
        result = run_check(gpu, "bench/check_chain.comp", NULL, buffers, 3, chains.cases.row_count,
                           chains.result, size, error);
    }
    THEN(result, judge_chains(report, &chains, error));
    sum_up(report);
    chains_destroy(&chains);
    return result;
}

// --- The commands.

// clang-format off
#define ROW(X)                                                                                     \
    X(TEXT, rule, 7) X(TEXT, category, 20) X(WHOLE, rows, 5) X(WHOLE, above_mark, 10)              \
    X(WHOLE, not_finite, 10) X(WHOLE, worst_row, 9) X(REAL, median, 9) X(REAL, worst, 9)           \
    X(TEXT, unit, 7) X(REAL, mark, 5) X(TEXT, verdict, 7) X(CHARS, command, 0)
// clang-format on

typedef struct Row {
    ROW(TABLE_FIELD)
} Row;
static const Column COLUMNS[] = {ROW(TABLE_COLUMN)};

// A check: its rule, the unit of its errors and its mark.
typedef struct Check {
    const char *rule, *unit;
    const char *command, *path;
    double mark;
    bool stated; // the docs state the mark as a bound
} Check;

static void add_category(Table *table, const Check *check, const TestVectorsCategory *category,
                         double bound)
{
    Row row = {.rule = check->rule,
               .category = category->name,
               .unit = check->unit,
               .rows = (long)category->rows,
               .above_mark = (long)category->failed,
               .not_finite = (long)category->not_finite,
               .worst_row = category->worst_id,
               .median = category->median,
               .worst = category->worst,
               .mark = check->mark};
    row.verdict = table_check(table, row.worst, bound, "%s, row %ld, in %s", row.category,
                              row.worst_row, row.unit);
    snprintf(row.command, sizeof row.command, "tractrix-bench %s --vectors %s", check->command,
             check->path);
    table_add(table, &row);
}

static void add_report(Table *table, const Check *check, const TestVectorsReport *report)
{
    TestVectorsCategory all = {.name = "all", .worst = -1, .median = NAN};
    for (size_t i = 0; i < report->category_count; ++i) {
        const TestVectorsCategory *at = &report->categories[i];
        add_category(table, check, at, check->stated ? check->mark : NAN);
        if (at->worst > all.worst) all.worst = at->worst, all.worst_id = at->worst_id;
    }
    all.rows = report->rows, all.failed = report->failed, all.not_finite = report->not_finite;
    add_category(table, check, &all, NAN); // the categories have been checked already
}

Result test_vectors_run_steps(const BenchOptions *options, const Gpu *gpu, Error *error)
{
    static const char *const rules[] = {"ours", "thesis"};
    const char *path = options->vectors ? options->vectors : "tests/data/tractrix_steps.csv";
    Table table = {0};
    Result result = table_open(&table, TABLE_COLUMNS, gpu, &options->output, stdout, error);
    for (TestVectorsRule rule = VECTORS_OURS; rule <= VECTORS_PUBLISHED; ++rule) {
        const Check check = {rules[rule], "floor32",         "step",
                             path,        VECTORS_STEP_MARK, rule == VECTORS_OURS};
        TestVectorsReport report;
        THEN(result, test_vectors_check_steps(&report, gpu, rule, path, error));
        if (result == RESULT_OK) add_report(&table, &check, &report);
    }
    return table_close(&table, result, error);
}

Result test_vectors_run_chains(const BenchOptions *options, const Gpu *gpu, Error *error)
{
    const char *path = options->vectors ? options->vectors : "tests/data/chain_pulls.csv";
    const Check check = {"ours", "sens32", "chain", path, VECTORS_CHAIN_MARK, true};
    Table table = {0};
    TestVectorsReport report;
    Result result = table_open(&table, TABLE_COLUMNS, gpu, &options->output, stdout, error);
    THEN(result, test_vectors_check_chains(&report, gpu, path, error));
    if (result == RESULT_OK) add_report(&table, &check, &report);
    return table_close(&table, result, error);
}
