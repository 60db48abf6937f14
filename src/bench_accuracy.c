// SPDX-License-Identifier: MIT
#include "bench_accuracy.h"
#include "interrupt.h"
#include "solver.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SHIPPED "tests/data/motion"

// What is stated: errors of default forms, over the length. "mean": geometric mean of all motions.
static const struct {
    const char *algo, *scenario;
    double rate, most;
} BOUNDS[] = {
    {"chain", "mean", 60, 0.02},
    {"chain", "mean", 240, 0.005},
    {"hybrid", "a_horizontal_n16_c4", 120, 0.03},
    {"emulation", "a_horizontal_n16_c4", 120, 0.03},
};

// The motions that the mean is taken over where a folder has all of them; else it is of all that
// are there, and no bound holds for it.
static const char *const MEAN_OF[] = {
    "a_horizontal_n16_c0", "a_horizontal_n16_c1", "a_horizontal_n16_c4", "b_curly_n16_c0",
    "b_curly_n16_c1",      "b_curly_n16_c4",      "c_root2Hz_n16_c0",    "c_root2Hz_n16_c1",
    "c_root2Hz_n16_c4",    "d_wind_n16_c1",       "d_wind_n16_c4",       "a_horizontal_n32_c1",
    "bd_curly_wind_n16_c4"};
enum { MEAN_COUNT = sizeof MEAN_OF / sizeof *MEAN_OF };

static bool is_in_mean(const char *name)
{
    for (int i = 0; i < MEAN_COUNT; ++i)
        if (strcmp(MEAN_OF[i], name) == 0) return true;
    return false;
}

AccuracyOptions accuracy_options_default(void)
{
    return (AccuracyOptions){.rates = {60, 120, 240}, .rate_count = 3};
}

// --- One run.

typedef struct Run {
    Hair hair;
    GpuTimer timer;
    Solver solver;
    SolverStep step;
} Run;

static void run_destroy(Run *run)
{
    solver_destroy(&run->solver);
    hair_destroy(&run->hair);
    gpu_timer_destroy(&run->timer);
}

static Result upload(Run *run, const Gpu *gpu, const Motion *motion, Error *error)
{
    Strands strands;
    Result result = strands_create(&strands, 1, (uint32_t)motion->n, error);
    if (result != RESULT_OK) return result;
    strands.first[1] = (uint32_t)motion->n;
    for (int i = 0; i < 3 * motion->n; ++i)
        strands.position[i / 3][i % 3] = (float)motion->points[i / 3][i % 3];
    result = hair_create(&run->hair, &strands, 0, &gpu->limits, error);
    strands_destroy(&strands);
    return result;
}

// At rest in the motion's start. `params` outlive the run.
static Result run_create(Run *run, const Gpu *gpu, const Motion *motion,
                         const SectionParams *params, double rate, Error *error)
{
    *run = (Run){.step = {.dt = 1 / rate, .first = true}};
    run->step.head.rotation[3] = run->step.head_old.rotation[3] = 1;
    memcpy(run->step.gravity, motion->gravity, sizeof motion->gravity);
    for (int i = 0; i < 4; ++i) memcpy(run->step.wind[i], motion->wind, sizeof motion->wind);
    gpu_timer_create(&run->timer, false, true);
    Result result = upload(run, gpu, motion, error);
    const SolverSetup setup = {
        .gpu = gpu, .timer = &run->timer, .hair = &run->hair, .params = params};
    return result == RESULT_OK ? solver_create(&run->solver, &setup, error) : result;
}

// One step further, to `time`.
static void run_advance(Run *run, const Motion *motion, double time)
{
    run->step.head.translation[0] = (float)motion_root(motion, time);
    solver_step(&run->solver, &run->step);
    run->step.head_old = run->step.head;
    run->step.first = false;
    ++run->step.shuffle;
}

// Mean square distance of particles 1 .. n-1 from the frame's.
static Result square_distance(Run *run, const Motion *motion, const MotionFrame *frame,
                              double *mean, Error *error)
{
    const HairBatch *batch = &run->hair.batches[0];
    size_t size = (size_t)batch->vertex_count * hair_slots(batch) * sizeof(float[4]);
    float(*x)[4] = malloc(size);
    if (!x) return error_set(error, RESULT_FAILED, "no memory for a strand's positions");
    solver_pose(&run->solver, &run->step.head);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, batch->position.buffer);
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)size, x);
    *mean = 0;
    for (int j = 1; j < motion->n; ++j)
        for (int k = 0; k < 3; ++k) {
            double r = (double)x[hair_address(batch, 0, (uint32_t)j)][k] - frame->points[j][k];
            *mean += r * r / (motion->n - 1);
        }
    free(x);
    return RESULT_OK;
}

static Result follow(Run *run, const Motion *motion, double rate, double *rms, Error *error)
{
    double sum = 0;
    long steps = 0, counted = 0;
    Result result = RESULT_OK;
    for (size_t f = 1; f < motion->frame_count && result == RESULT_OK; ++f) {
        const MotionFrame *frame = &motion->frames[f];
        double mean = 0, ends = frame->time * rate;
        while ((double)steps < ends - 0.01) {
            ++steps;
            run_advance(run, motion, (double)steps / rate);
        }
        if (!frame->followed || fabs((double)steps - ends) > 0.01) continue;
        result = square_distance(run, motion, frame, &mean, error);
        sum += mean, ++counted;
    }
    *rms = counted ? sqrt(sum / (double)counted) / motion->length : NAN;
    return result;
}

Result accuracy_measure(double *error_over_length, const Gpu *gpu, const Motion *motion,
                        const SectionParams *params, double rate, Error *error)
{
    SectionParams own = *params; // its strings are borrowed
    Run run;
    own.drag = (float)motion->drag;
    Result result = run_create(&run, gpu, motion, &own, rate, error);
    if (result == RESULT_OK) result = follow(&run, motion, rate, error_over_length, error);
    run_destroy(&run);
    return result;
}

double accuracy_order(const double *rates, const double *errors, int count)
{
    double x = 0, y = 0, xx = 0, xy = 0;
    for (int i = 0; i < count; ++i) {
        double u = -log(rates[i]), w = log(errors[i]);
        x += u, y += w, xx += u * u, xy += u * w;
    }
    double spread = xx - x * x / count;
    return count > 1 && spread > 0 ? (xy - x * y / count) / spread : 0;
}

// --- The table.

typedef struct Table {
    const Gpu *gpu;
    const AccuracyOptions *options;
    FILE *stream;
    json_t *rows;
    Motion *motions;
    size_t motion_count;
    bool whole; // all that the mean is stated for are there
    int broken; // bounds
    char first_broken[256];
} Table;

static void check_bounds(Table *table, const SectionParams *params, const char *scenario,
                         const double *errors)
{
    for (size_t b = 0; b < sizeof BOUNDS / sizeof *BOUNDS; ++b)
        for (int r = 0; r < table->options->rate_count; ++r) {
            double rate = table->options->rates[r];
            if (strcmp(BOUNDS[b].algo, params->algo) != 0 || *params->variant ||
                strcmp(BOUNDS[b].scenario, scenario) != 0 || BOUNDS[b].rate != rate)
                continue;
            if (errors[r] <= BOUNDS[b].most || table->broken++) continue;
            snprintf(table->first_broken, sizeof table->first_broken,
                     "%s, %s at %g Hz: %.4g of the length, stated is at most %g", params->algo,
                     scenario, rate, errors[r], BOUNDS[b].most);
        }
}

static void add_row(Table *table, const SectionParams *params, const char *scenario,
                    const double *errors)
{
    const AccuracyOptions *options = table->options;
    double order = accuracy_order(options->rates, errors, options->rate_count);
    const char *variant = *params->variant ? params->variant : "-";
    json_t *by_rate = json_object();
    fprintf(table->stream, "%s,%s,%s", params->algo, variant, scenario);
    for (int r = 0; r < options->rate_count; ++r) {
        char rate[32];
        snprintf(rate, sizeof rate, "%g", options->rates[r]);
        fprintf(table->stream, ",%.4g", errors[r]);
        json_object_set_new(by_rate, rate, json_real(errors[r]));
    }
    fprintf(table->stream, ",%.2f\n", order);
    fflush(table->stream);
    if (table->rows)
        json_array_append_new(table->rows,
                              json_pack("{s:s, s:s, s:s, s:O, s:f}", "algo", params->algo,
                                        "variant", params->variant, "scenario", scenario,
                                        "error_over_length", by_rate, "order", order));
    json_decref(by_rate);
    check_bounds(table, params, scenario, errors);
}

static void add_mean(Table *table, const SectionParams *params, const double *logs, size_t count)
{
    double errors[ACCURACY_MOST_RATES];
    for (int r = 0; r < table->options->rate_count; ++r) errors[r] = exp(logs[r] / (double)count);
    add_row(table, params, table->whole ? "mean" : "mean of these", errors);
}

static Result measure_solver(Table *table, const SectionParams *params, Error *error)
{
    const AccuracyOptions *options = table->options;
    double logs[ACCURACY_MOST_RATES] = {0}, errors[ACCURACY_MOST_RATES];
    size_t counted = 0;
    for (size_t m = 0; m < table->motion_count; ++m) {
        bool counts = !table->whole || is_in_mean(table->motions[m].name);
        for (int r = 0; r < options->rate_count; ++r) {
            if (interrupt_requested()) return error_set(error, RESULT_INTERRUPTED, "interrupted");
            Result result = accuracy_measure(&errors[r], table->gpu, &table->motions[m], params,
                                             options->rates[r], error);
            if (result != RESULT_OK) return result;
            if (counts) logs[r] += log(errors[r]);
        }
        counted += counts;
        add_row(table, params, table->motions[m].name, errors);
    }
    add_mean(table, params, logs, counted);
    return RESULT_OK;
}

static Result measure_by_name(Table *table, const char *algo, const char *variant, Error *error)
{
    SectionParams params;
    Result result = section_params_create(&params, error);
    if (result == RESULT_OK) result = param_parse(param_find("algo"), &params, algo, error);
    if (result == RESULT_OK) result = param_parse(param_find("variant"), &params, variant, error);
    params.style = 0;
    if (result == RESULT_OK) result = solver_check(&params, error);
    if (result == RESULT_OK) result = measure_solver(table, &params, error);
    section_params_destroy(&params);
    return result;
}

static Result read_motions(Table *table, Error *error)
{
    const char *folder = table->options->reference ? table->options->reference : SHIPPED;
    char **names;
    size_t count;
    Result result = motion_list(&names, &count, folder, error);
    if (result != RESULT_OK) return result;
    table->motions = calloc(count, sizeof *table->motions);
    if (!table->motions)
        result = error_set(error, RESULT_FAILED, "no memory for %zu motions", count);
    for (size_t i = 0; i < count && result == RESULT_OK; ++i) {
        result = motion_read(&table->motions[i], folder, names[i], error);
        if (result == RESULT_OK) table->motion_count = i + 1;
    }
    size_t in_mean = 0;
    for (size_t i = 0; i < count; ++i) in_mean += is_in_mean(names[i]);
    table->whole = in_mean == MEAN_COUNT;
    motion_names_destroy(names, count);
    return result;
}

static Result measure_all(Table *table, Error *error)
{
    const AccuracyOptions *options = table->options;
    Result result = RESULT_OK;
    fprintf(table->stream, "algo,variant,scenario");
    for (int r = 0; r < options->rate_count; ++r)
        fprintf(table->stream, ",%g Hz", options->rates[r]);
    fprintf(table->stream, ",order\n");
    if (options->algo)
        return measure_by_name(table, options->algo, options->variant ? options->variant : "",
                               error);
    for (const SolverType *const *type = SOLVER_TYPES; *type && result == RESULT_OK; ++type)
        if ((*type)->calls->step) result = measure_by_name(table, (*type)->name, "", error);
    return result;
}

Result accuracy_run(const Gpu *gpu, const AccuracyOptions *options, FILE *stream, json_t *rows,
                    Error *error)
{
    Table table = {.gpu = gpu, .options = options, .stream = stream, .rows = rows};
    Result result = read_motions(&table, error);
    if (result == RESULT_OK) result = measure_all(&table, error);
    for (size_t i = 0; i < table.motion_count; ++i) motion_destroy(&table.motions[i]);
    free(table.motions);
    if (result == RESULT_OK && table.broken)
        return error_set(error, RESULT_FAILED, "%s%s", table.first_broken,
                         table.broken > 1 ? ", and more bounds are broken" : "");
    return result;
}
