// SPDX-License-Identifier: MIT
#include "bench/test_vectors.h"
#include "base/csv.h"
#include "gpu/gpu_buffer.h"
#include "gpu/shader.h"

#include "glsl/common/shared.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef float Float4[4];

static Result judge(TestVectorsReport *report, const char *category, long id, double ratio,
                    double mark, Error *error)
{
    size_t i = 0;
    while (i < report->category_count && strcmp(report->categories[i].name, category) != 0) ++i;
    if (i == VECTORS_MAX_CATEGORIES)
        return error_set(error, RESULT_BAD_INPUT, "more than %zu categories", i);
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

static int compare_ratios(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void sum_up(TestVectorsReport *report)
{
    for (size_t i = 0; i < report->category_count; ++i) {
        TestVectorsCategory *at = &report->categories[i];
        qsort(at->ratios, at->rows, sizeof *at->ratios, compare_ratios);
        at->median = at->rows ? at->ratios[at->rows / 2] : 0;
        free(at->ratios);
        at->ratios = NULL;
    }
}

// Three numbers of a row in consecutive named columns.
static Result numbers(const Csv *csv, size_t row, const size_t column[3], double value[3],
                      Error *error)
{
    Result result = RESULT_OK;
    for (int k = 0; k < 3 && result == RESULT_OK; ++k)
        result = csv_number(csv, row, column[k], &value[k], error);
    return result;
}

static Result find_columns(const Csv *csv, const char *const *names, size_t count, size_t *columns,
                           Error *error)
{
    Result result = RESULT_OK;
    for (size_t i = 0; i < count && result == RESULT_OK; ++i)
        result = csv_find(csv, names[i], &columns[i], error);
    return result;
}

static double distance(const double a[3], const float b[3])
{
    double sum = 0;
    for (int k = 0; k < 3; ++k) sum += (a[k] - (double)b[k]) * (a[k] - (double)b[k]);
    return sqrt(sum);
}

// Runs a check shader over storage buffers; the one at BIND_POSITION_OUT comes back into `results`.
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
    Result result = shader_build_compute(&program, file, defines, error);
    for (int i = 0; i < count && result == RESULT_OK; ++i) {
        result = gpu_buffer_create(&buffers[i], &gpu->limits, file, (int64_t)inputs[i].size,
                                   inputs[i].data, 0, error);
        if (result == RESULT_OK) gpu_buffer_bind_storage(&buffers[i], inputs[i].binding);
    }
    if (result == RESULT_OK) {
        glUseProgram(program);
        glDispatchCompute((GLuint)((lanes + 7) / 8), 1, 1);
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffers[0].buffer);
        glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)size, results);
        result = gpu_check(file, error);
    }
    for (int i = 0; i < count; ++i) gpu_buffer_destroy(&buffers[i]);
    if (program) glDeleteProgram(program);
    return result;
}

enum {
    STEP_ID,
    STEP_CATEGORY,
    STEP_H,
    STEP_T = 5,
    STEP_P = 8,
    STEP_FLOOR = 11,
    STEP_TAIL,
    STEP_COLUMNS = 15
};
static const char *const STEP_NAMES[STEP_COLUMNS] = {
    "id",     "category", "hx_hex", "hy_hex",  "hz_hex", "tx_hex", "ty_hex", "tz_hex",
    "px_hex", "py_hex",   "pz_hex", "floor32", "tnx",    "tny",    "tnz"};

static Result read_step_cases(const Csv *csv, const size_t *columns, Float4 *cases, Error *error)
{
    for (size_t row = 0; row < csv->row_count; ++row)
        for (size_t point = 0; point < 3; ++point) {
            double value[3];
            Result result = numbers(csv, row, &columns[STEP_H + 3 * point], value, error);
            if (result != RESULT_OK) return result;
            for (int k = 0; k < 3; ++k) cases[3 * row + point][k] = (float)value[k];
        }
    return RESULT_OK;
}

static Result judge_steps(TestVectorsReport *report, const Csv *csv, const size_t *columns,
                          const Float4 *tails, Error *error)
{
    Result result = RESULT_OK;
    for (size_t row = 0; row < csv->row_count && result == RESULT_OK; ++row) {
        double exact[3], floor32 = 0, id = 0;
        result = numbers(csv, row, &columns[STEP_TAIL], exact, error);
        if (result == RESULT_OK)
            result = csv_number(csv, row, columns[STEP_FLOOR], &floor32, error);
        if (result == RESULT_OK) result = csv_number(csv, row, columns[STEP_ID], &id, error);
        if (result != RESULT_OK) break;
        double wrong = distance(exact, tails[row]);
        result = judge(report, csv_text(csv, row, columns[STEP_CATEGORY]), (long)id,
                       wrong == 0 ? 0 : wrong / floor32, VECTORS_STEP_MARK, error);
    }
    return result;
}

Result test_vectors_check_steps(TestVectorsReport *report, const Gpu *gpu, TestVectorsRule rule,
                                const char *path, Error *error)
{
    const ShaderDefine defines[] = {{"PUBLISHED", rule == VECTORS_PUBLISHED}, {0}};
    *report = (TestVectorsReport){0};
    Csv csv;
    size_t columns[STEP_COLUMNS];
    Float4 *cases = NULL, *tails = NULL;
    Result result = csv_read(&csv, path, error);
    if (result == RESULT_OK) result = find_columns(&csv, STEP_NAMES, STEP_COLUMNS, columns, error);
    if (result == RESULT_OK) {
        cases = calloc(3 * csv.row_count, sizeof *cases);
        tails = calloc(csv.row_count, sizeof *tails);
        if (!cases || !tails) result = error_set(error, RESULT_FAILED, "%s: no memory", path);
    }
    if (result == RESULT_OK) result = read_step_cases(&csv, columns, cases, error);
    if (result == RESULT_OK) {
        const CheckBuffer buffers[] = {{BIND_POSITION_OUT, tails, csv.row_count * sizeof *tails},
                                       {BIND_STATE_OUT, cases, 3 * csv.row_count * sizeof *cases}};
        result = run_check(gpu, "bench/check_step.comp", defines, buffers, 2, csv.row_count, tails,
                           buffers[0].size, error);
    }
    if (result == RESULT_OK)
        result = judge_steps(report, &csv, columns, (const Float4 *)tails, error);
    sum_up(report);
    free(cases);
    free(tails);
    csv_destroy(&csv);
    return result;
}

typedef struct Span {
    uint32_t first_point, segments, first_waypoint, waypoints;
} Span;

enum { CASE_ID, CASE_SEGMENTS, CASE_MOVES, CASE_SHAPE, CASE_PATH, CASE_SENS, CASE_COLUMNS };
static const char *const CASE_NAMES[CASE_COLUMNS] = {"case",  "segments", "moves",
                                                     "shape", "path",     "sens32"};
enum { POINT_CASE, POINT_KIND, POINT_INDEX, POINT_HEX, POINT_EXACT = 6, POINT_COLUMNS = 9 };
static const char *const POINT_NAMES[POINT_COLUMNS] = {"case",  "kind", "index", "x_hex", "y_hex",
                                                       "z_hex", "x",    "y",     "z"};

// The chains of a file: start points and results share their numbering, waypoints have their own.
typedef struct Chains {
    Csv cases, points;
    size_t case_column[CASE_COLUMNS], point_column[POINT_COLUMNS];
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

static Result open_chains(Chains *chains, const char *path, Error *error)
{
    char cases_path[4096];
    size_t stem = strlen(path);
    if (stem > 4 && strcmp(path + stem - 4, ".csv") == 0) stem -= 4;
    snprintf(cases_path, sizeof cases_path, "%.*s_cases.csv", (int)stem, path);
    Result result = csv_read(&chains->points, path, error);
    if (result == RESULT_OK) result = csv_read(&chains->cases, cases_path, error);
    if (result == RESULT_OK)
        result = find_columns(&chains->cases, CASE_NAMES, CASE_COLUMNS, chains->case_column, error);
    if (result == RESULT_OK)
        result =
            find_columns(&chains->points, POINT_NAMES, POINT_COLUMNS, chains->point_column, error);
    return result;
}

static Result read_spans(Chains *chains, Error *error)
{
    chains->spans = calloc(chains->cases.row_count, sizeof *chains->spans);
    if (!chains->spans) return error_set(error, RESULT_FAILED, "no memory for chains");
    for (size_t row = 0; row < chains->cases.row_count; ++row) {
        double id, segments, moves;
        Result result = csv_number(&chains->cases, row, chains->case_column[CASE_ID], &id, error);
        if (result == RESULT_OK)
            result = csv_number(&chains->cases, row, chains->case_column[CASE_SEGMENTS], &segments,
                                error);
        if (result == RESULT_OK)
            result =
                csv_number(&chains->cases, row, chains->case_column[CASE_MOVES], &moves, error);
        if (result != RESULT_OK) return result;
        if (!(id == (double)row && segments >= 1 && segments <= 65535 && moves >= 0 &&
              moves <= 1e6))
            return error_set(error, RESULT_BAD_INPUT,
                             "%s:%zu: expected case %zu with 1 to 65535 segments",
                             chains->cases.path, row + 2, row);
        chains->spans[row] = (Span){(uint32_t)chains->point_count, (uint32_t)segments,
                                    (uint32_t)chains->waypoint_count, (uint32_t)moves};
        chains->point_count += (size_t)segments + 1;
        chains->waypoint_count += (size_t)moves;
    }
    return RESULT_OK;
}

static Result refuse_point(const Chains *chains, size_t row, Error *error)
{
    return error_set(error, RESULT_BAD_INPUT, "%s:%zu: no such case, kind or index",
                     chains->points.path, row + 2);
}

static Result read_point(Chains *chains, size_t row, Error *error)
{
    const Csv *csv = &chains->points;
    double id, index, value[3];
    const char *kind = csv_text(csv, row, chains->point_column[POINT_KIND]);
    const size_t *columns = &chains->point_column[*kind == 'R' ? POINT_EXACT : POINT_HEX];
    Result result = csv_number(csv, row, chains->point_column[POINT_CASE], &id, error);
    if (result == RESULT_OK)
        result = csv_number(csv, row, chains->point_column[POINT_INDEX], &index, error);
    if (result == RESULT_OK) result = numbers(csv, row, columns, value, error);
    if (result != RESULT_OK) return result;
    if (!(id >= 0 && id < (double)chains->cases.row_count && index >= 0))
        return refuse_point(chains, row, error);
    Span span = chains->spans[(size_t)id];
    bool waypoint = *kind == 'M';
    if (index >= (waypoint ? span.waypoints : span.segments + 1) || !strchr("PMR", *kind))
        return refuse_point(chains, row, error);
    size_t at = (waypoint ? span.first_waypoint : span.first_point) + (size_t)index;
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
    Result result = open_chains(chains, path, error);
    if (result == RESULT_OK) result = read_spans(chains, error);
    if (result != RESULT_OK) return result;
    chains->start = calloc(chains->point_count, sizeof(Float4));
    chains->result = calloc(chains->point_count, sizeof(Float4));
    chains->waypoint = calloc(chains->waypoint_count + 1, sizeof(Float4));
    chains->exact = calloc(chains->point_count, sizeof *chains->exact);
    if (!chains->start || !chains->result || !chains->waypoint || !chains->exact)
        return error_set(error, RESULT_FAILED, "%s: no memory", path);
    for (size_t row = 0; row < chains->points.row_count && result == RESULT_OK; ++row)
        result = read_point(chains, row, error);
    return result;
}

static double mean_segment(const Chains *chains, const Span *span)
{
    double total = 0;
    for (uint32_t j = span->first_point + 1; j <= span->first_point + span->segments; ++j) {
        const float *a = chains->start[j - 1], *b = chains->start[j];
        total += distance((double[3]){(double)a[0], (double)a[1], (double)a[2]}, b);
    }
    return total / span->segments;
}

static Result judge_chains(TestVectorsReport *report, const Chains *chains, Error *error)
{
    Result result = RESULT_OK;
    for (size_t row = 0; row < chains->cases.row_count && result == RESULT_OK; ++row) {
        const Span *span = &chains->spans[row];
        double sens32, worst = 0;
        char category[32];
        result = csv_number(&chains->cases, row, chains->case_column[CASE_SENS], &sens32, error);
        if (result != RESULT_OK) break;
        for (uint32_t j = span->first_point; j <= span->first_point + span->segments; ++j) {
            double wrong = distance(chains->exact[j], chains->result[j]);
            if (!(wrong <= worst)) worst = wrong;
        }
        snprintf(category, sizeof category, "%.14s %.14s",
                 csv_text(&chains->cases, row, chains->case_column[CASE_SHAPE]),
                 csv_text(&chains->cases, row, chains->case_column[CASE_PATH]));
        result = judge(report, category, (long)row, worst / mean_segment(chains, span) / sens32,
                       VECTORS_CHAIN_MARK, error);
    }
    return result;
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
    if (result == RESULT_OK) result = judge_chains(report, &chains, error);
    sum_up(report);
    chains_destroy(&chains);
    return result;
}
