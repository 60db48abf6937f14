// SPDX-License-Identifier: MIT
#include "bench/bench_scaling.h"
#include "base/interrupt.h"
#include "base/outfile.h"
#include "bench/bench_child.h"
#include "gen/strands_make.h"

#include <ftw.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MOST_SIZES = 8 };

// As many steps as take half a second or so, by what a particle costs; at least 3.
static BenchOptions fewer_steps(const Speed *speed, uint64_t particles)
{
    BenchOptions options = *speed->options;
    double most = fmax(3, 1e7 / (double)particles);
    if (options.steps > most) options.steps = (int)most;
    if (options.warm_up > options.steps / 3) options.warm_up = options.steps / 3;
    options.size[0] = 0;
    return options;
}

static Result make_hair(Strands *strands, uint32_t count, uint32_t vertices, Error *error)
{
    StrandsRecipe recipe = strands_recipe_default(STRANDS_STYLE_RANDOM);
    recipe.count = count;
    recipe.vertices = vertices;
    return strands_make(strands, &recipe, error);
}

// What grows, and the times so far: least ms by method and size.
typedef struct Growth {
    const char *part;
    double sizes[MOST_SIZES], least[METHODS_MOST][MOST_SIZES];
    int count;
} Growth;

static Result measure_size(Speed *speed, Growth *growth, uint32_t strand_count, uint32_t vertices,
                           Error *error)
{
    char name[64];
    Strands strands = {0};
    snprintf(name, sizeof name, "%u x %u", strand_count, vertices);
    Result result = make_hair(&strands, strand_count, vertices, error);
    for (int m = 0; m < speed->method_count && result == RESULT_OK; ++m) {
        const SpeedSubject subject = {
            .name = name, .strands = &strands, .method = speed->methods[m]};
        const BenchOptions options = fewer_steps(speed, strands.vertex_count);
        SpeedRow row = speed_row(growth->part, &subject);
        if (interrupt_requested()) result = error_set(error, RESULT_INTERRUPTED, "interrupted");
        if (result == RESULT_OK)
            result = speed_measure(&row.result, speed->gpu, &subject, &options, error);
        if (result != RESULT_OK) break;
        growth->least[m][growth->count] = row.result.step.minimum;
        speed_add(speed, &row);
    }
    strands_destroy(&strands);
    ++growth->count;
    return result;
}

static void add_exponents(Speed *speed, const Growth *growth)
{
    for (int m = 0; m < speed->method_count; ++m) {
        SpeedRow row = speed_row(growth->part, NULL);
        snprintf(row.hair, sizeof row.hair, "all of these");
        row.method = speed->methods[m];
        row.exponent = table_slope(growth->sizes, growth->least[m], growth->count, &row.spread);
        speed_add(speed, &row);
    }
}

Result scaling_run_strands(Speed *speed, Error *error)
{
    static const uint32_t counts[] = {1000, 10000, 100000, 1000000};
    static Growth growth;
    growth = (Growth){.part = "strands"};
    Result result = RESULT_OK;
    for (size_t i = 0; i < sizeof counts / sizeof *counts && result == RESULT_OK; ++i) {
        growth.sizes[i] = counts[i];
        result = measure_size(speed, &growth, counts[i], 16, error);
    }
    if (result == RESULT_OK) add_exponents(speed, &growth);
    return result;
}

Result scaling_run_vertices(Speed *speed, Error *error)
{
    static Growth growth;
    growth = (Growth){.part = "vertices"};
    Result result = RESULT_OK;
    for (uint32_t n = 4; n <= 64 && result == RESULT_OK; n *= 2) {
        growth.sizes[growth.count] = n;
        result = measure_size(speed, &growth, 10000, n, error);
    }
    if (result == RESULT_OK) add_exponents(speed, &growth);
    return result;
}

// --- In processes of their own.

static double number(const json_t *row, const char *name)
{
    const json_t *value = json_object_get(row, name);
    return json_is_number(value) ? json_number_value(value) : NAN;
}

static void take_times(SpeedRow *row, const json_t *from)
{
    row->strands = (long)number(from, "strands");
    row->vertices = (long)number(from, "vertices");
    row->particles = (long)number(from, "particles");
    row->result.first_step_ms = number(from, "first_ms");
    row->result.step = (Times){number(from, "ms_min"), number(from, "ms_q1"),
                               number(from, "ms_median"), number(from, "ms_q3")};
}

static SpeedRow child_row(const Speed *speed, const char *part, const char *set, int method)
{
    SpeedRow row = speed_row(part, NULL);
    row.set = speed->options->tfx ? NULL : speed->options->set ? speed->options->set : set;
    row.file = speed->options->tfx;
    const char *name = row.file ? row.file : row.set, *slash = strrchr(name, '/');
    snprintf(row.hair, sizeof row.hair, "%s", slash ? slash + 1 : name);
    row.method = speed->methods[method];
    return row;
}

static Result measure_threads(Speed *speed, int method, int threads, double *least, Error *error)
{
    char count[16];
    const ChildVariable variable = {"LP_NUM_THREADS", count};
    SpeedRow row = child_row(speed, "threads", "10k32", method);
    const BenchOptions options = fewer_steps(speed, 320000);
    json_t *from = NULL;
    snprintf(count, sizeof count, "%d", threads);
    row.threads = threads;
    Result result = child_measure(speed->options, &row.method, row.set, row.file, options.steps,
                                  options.warm_up, &variable, 1, &from, &row.process_ms, error);
    if (result != RESULT_OK) return result;
    take_times(&row, from);
    json_decref(from);
    *least = row.result.step.minimum;
    speed_add(speed, &row);
    return RESULT_OK;
}

Result scaling_run_threads(Speed *speed, Error *error)
{
    static const double threads[] = {1, 2};
    const char *before = getenv("LP_NUM_THREADS");
    char *kept = before ? strdup(before) : NULL;
    Result result = RESULT_OK;
    bool known = strstr(speed->gpu->renderer, "llvmpipe") != NULL;
    for (int m = 0; m < speed->method_count && known && result == RESULT_OK; ++m) {
        double least[2] = {NAN, NAN};
        for (int i = 0; i < 2 && result == RESULT_OK; ++i)
            result = interrupt_requested()
                         ? error_set(error, RESULT_INTERRUPTED, "interrupted")
                         : measure_threads(speed, m, (int)threads[i], &least[i], error);
        SpeedRow row = child_row(speed, "threads", "10k32", m);
        row.exponent = table_slope(threads, least, 2, &row.spread);
        if (result == RESULT_OK) speed_add(speed, &row);
    }
    if (kept)
        setenv("LP_NUM_THREADS", kept, 1);
    else
        unsetenv("LP_NUM_THREADS");
    free(kept);
    return result;
}

static int remove_entry(const char *path, const struct stat *status, int kind, struct FTW *walk)
{
    (void)status, (void)kind, (void)walk;
    return remove(path);
}

static Result measure_start(Speed *speed, int method, const char *cache, const char *remark,
                            Error *error)
{
    const ChildVariable variable = {"MESA_SHADER_CACHE_DIR", cache};
    SpeedRow row = child_row(speed, "start", "1k16", method);
    json_t *from = NULL;
    Result result = child_measure(speed->options, &row.method, row.set, row.file, 1, 0, &variable,
                                  1, &from, &row.process_ms, error);
    if (result != RESULT_OK) return result;
    const Times none = row.result.step;
    take_times(&row, from);
    row.result.step = none; // of one step: says nothing
    row.remark = remark;
    json_decref(from);
    speed_add(speed, &row);
    return RESULT_OK;
}

Result scaling_run_start(Speed *speed, Error *error)
{
    const char *before = getenv("MESA_SHADER_CACHE_DIR");
    char *kept = before ? strdup(before) : NULL;
    Result result = RESULT_OK;
    for (int m = 0; m < speed->method_count && result == RESULT_OK; ++m) {
        char cache[PATH_MAX];
        outfile_scratch_name(cache, "tractrix-cache");
        if (!mkdtemp(cache)) result = error_set(error, RESULT_FAILED, "%s: cannot be made", cache);
        if (result == RESULT_OK) result = measure_start(speed, m, cache, "cold", error);
        if (result == RESULT_OK) result = measure_start(speed, m, cache, "warm", error);
        nftw(cache, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
        if (interrupt_requested()) result = error_set(error, RESULT_INTERRUPTED, "interrupted");
    }
    if (kept)
        setenv("MESA_SHADER_CACHE_DIR", kept, 1);
    else
        unsetenv("MESA_SHADER_CACHE_DIR");
    free(kept);
    return result;
}
