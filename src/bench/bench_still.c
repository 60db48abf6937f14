// SPDX-License-Identifier: MIT
#include "bench/bench_still.h"
#include "base/interrupt.h"
#include "bench/bench_trial.h"

#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 256, FPS = 60, REST_S = 20, SETTLE_S = 10 };
#define LENGTH 0.25

typedef double Points[MOST][3];

static double distance(float (*const a)[3], const double (*b)[3], int n)
{
    double sum = 0;
    for (int j = 1; j < n; ++j)
        for (int k = 0; k < 3; ++k) sum += pow((double)a[j][k] - b[j][k], 2);
    return sqrt(sum / (n - 1)) / LENGTH;
}

// Particles in the style at rest, with the method's settings and `settings` before them.
static Result start(Trial *trial, const Accuracy *accuracy, const Method *method,
                    const char *settings, const Points points, int n, double rate,
                    SectionParams *params, Error *error)
{
    char all[512];
    Strands strands = {0};
    snprintf(all, sizeof all, "%s %s", settings, method->settings);
    const Method own = {method->algo, method->variant, all};
    *trial = (Trial){0};
    Result result = method_params(params, &own, error);
    if (result == RESULT_OK) result = trial_make_strand(&strands, points, n, error);
    if (result == RESULT_OK)
        result = trial_create(trial, accuracy->gpu, &strands, params, rate, error);
    strands_destroy(&strands);
    return result;
}

// --- Against exact minima.

typedef struct StillCase {
    const char *style;
    int n;
    double stiffness; // of the position springs, 1/s2
    Points from, to;
} StillCase;

static bool has_position_springs(const char *algo)
{
    static const char *const with[] = {"emulation", "hybrid", "chain", "rope", "dftl"};
    for (size_t i = 0; i < sizeof with / sizeof *with; ++i)
        if (strcmp(algo, with[i]) == 0) return true;
    return false;
}

static void read_points(const json_t *array, Points points)
{
    for (size_t j = 0; j < json_array_size(array) && j < MOST; ++j)
        for (size_t k = 0; k < 3; ++k)
            points[j][k] = json_number_value(json_array_get(json_array_get(array, j), k));
}

static Result settle(const Accuracy *accuracy, const Method *method, const StillCase *still,
                     double rate, double *off, Error *error)
{
    char settings[128];
    SectionParams params = {0};
    Trial trial;
    snprintf(settings, sizeof settings, "--style 0.5 --style-stiffness %g --drag 5",
             still->stiffness);
    Result result =
        start(&trial, accuracy, method, settings, still->from, still->n, rate, &params, error);
    while (result == RESULT_OK && (double)trial.steps < REST_S * rate) trial_step(&trial);
    if (result == RESULT_OK) result = trial_read(&trial, error);
    if (result == RESULT_OK) *off = distance(trial.points, still->to, still->n);
    trial_destroy(&trial);
    params_destroy_section(&params);
    return result;
}

static Result use_case(Accuracy *accuracy, const Method *method, const StillCase *still,
                       Error *error)
{
    static const double own[] = {60};
    double rates[BENCH_MOST_RATES];
    int count = accuracy_rates(accuracy, own, 1, rates);
    Result result = RESULT_OK;
    for (int r = 0; r < count && result == RESULT_OK; ++r) {
        AccuracyRow row = accuracy_row("static", method, rates[r]);
        if (interrupt_requested()) return error_set(error, RESULT_INTERRUPTED, "interrupted");
        snprintf(row.scenario, sizeof row.scenario, "%s, k = %g/s2", still->style,
                 still->stiffness);
        row.what = "error";
        result = settle(accuracy, method, still, rates[r], &row.value, error);
        if (result == RESULT_OK) accuracy_add(accuracy, &row);
    }
    return result;
}

static Result use_springs(Accuracy *accuracy, const Method *method, Error *error)
{
    static StillCase still; // large
    char path[4096];
    if (!has_position_springs(method->algo)) return RESULT_OK;
    snprintf(path, sizeof path, "%s/static_style.json", accuracy->folder);
    json_t *file = json_load_file(path, 0, NULL), *entry;
    Result result = RESULT_OK;
    size_t i;
    json_array_foreach(json_object_get(file, "cases"), i, entry)
    {
        int n = (int)json_integer_value(json_object_get(entry, "n"));
        if (n < 2 || n > MOST || result != RESULT_OK) continue;
        still.style = json_string_value(json_object_get(entry, "style"));
        still.n = n;
        still.stiffness = json_number_value(json_object_get(entry, "k_style"));
        read_points(json_object_get(entry, "style_positions"), still.from);
        read_points(json_object_get(entry, "positions"), still.to);
        result = use_case(accuracy, method, &still, error);
    }
    json_decref(file);
    return result;
}

Result still_run_static(Accuracy *accuracy, Error *error)
{
    return accuracy_for_each(accuracy, use_springs, error);
}

// --- Drift.

// The farthest that a particle has gone since `before`, over the length; `before` becomes now.
static double farthest(float (*const now)[3], Points before, int n)
{
    double most = 0;
    for (int j = 0; j < n; ++j) {
        double square = 0;
        for (int k = 0; k < 3; ++k) {
            square += pow((double)now[j][k] - before[j][k], 2);
            before[j][k] = (double)now[j][k];
        }
        most = fmax(most, sqrt(square));
    }
    return most / LENGTH;
}

static Result watch(Trial *trial, int n, double seconds, double rate, double *drift, double *tremor,
                    Error *error)
{
    static Points settled, before;
    double begin = fmin(SETTLE_S, seconds / 2);
    int steps_per_frame = rate > FPS ? (int)(rate / FPS + 0.5) : 1;
    *tremor = 0;
    Result result = RESULT_OK;
    while ((double)trial->steps < begin * rate) trial_step(trial);
    result = trial_read(trial, error);
    farthest(trial->points, settled, n);
    farthest(trial->points, before, n);
    while ((double)trial->steps < seconds * rate && result == RESULT_OK) {
        for (int i = 0; i < steps_per_frame; ++i) trial_step(trial);
        result = trial_read(trial, error);
        *tremor = fmax(*tremor, farthest(trial->points, before, n));
    }
    *drift = distance(trial->points, (const double(*)[3])settled, n);
    return result;
}

static Result use_helix(Accuracy *accuracy, const Method *method, int n, double rate, Error *error)
{
    static Points helix;
    SectionParams params = {0};
    Trial trial;
    double drift = NAN, tremor = NAN;
    AccuracyRow row = accuracy_row("drift", method, rate);
    if (interrupt_requested()) return error_set(error, RESULT_INTERRUPTED, "interrupted");
    trial_make_helix(helix, n, LENGTH, n > 16 ? 4 : 2);
    Result result =
        start(&trial, accuracy, method, "", (const double(*)[3])helix, n, rate, &params, error);
    if (result == RESULT_OK)
        result = watch(&trial, n, accuracy->options->seconds, rate, &drift, &tremor, error);
    trial_destroy(&trial);
    params_destroy_section(&params);
    if (result != RESULT_OK) return result;
    snprintf(row.scenario, sizeof row.scenario, "helix of %d, %g s", n, accuracy->options->seconds);
    row.what = "drift", row.value = drift;
    accuracy_add(accuracy, &row);
    row.what = "tremor", row.value = tremor;
    accuracy_add(accuracy, &row);
    return RESULT_OK;
}

static Result use_helices(Accuracy *accuracy, const Method *method, Error *error)
{
    static const double own[] = {60};
    double rates[BENCH_MOST_RATES];
    int count = accuracy_rates(accuracy, own, 1, rates);
    Result result = RESULT_OK;
    for (int r = 0; r < count; ++r)
        for (int n = 16; n <= 48 && result == RESULT_OK; n += 32)
            result = use_helix(accuracy, method, n, rates[r], error);
    return result;
}

Result still_run_drift(Accuracy *accuracy, Error *error)
{
    return accuracy_for_each(accuracy, use_helices, error);
}
