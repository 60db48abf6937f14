// SPDX-License-Identifier: MIT
#include "bench/bench_motions.h"
#include "base/interrupt.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

// --- One run.

Result motions_start(Trial *trial, const Gpu *gpu, const Motion *motion,
                     const SectionParams *params, double rate, Error *error)
{
    SectionParams own = *params; // its strings are borrowed
    Strands strands;
    own.drag = (float)motion->drag;
    *trial = (Trial){0};
    Result result =
        trial_make_strand(&strands, (const double(*)[3])motion->points, motion->n, error);
    if (result != RESULT_OK) return result;
    result = trial_create(trial, gpu, &strands, &own, rate, error);
    strands_destroy(&strands);
    memcpy(trial->step.gravity, motion->gravity, sizeof motion->gravity);
    for (int i = 0; i < 4; ++i) memcpy(trial->step.wind[i], motion->wind, sizeof motion->wind);
    return result;
}

void motions_advance(Trial *trial, const Motion *motion)
{
    double time = (double)(trial->steps + 1) * trial->step.dt;
    trial->step.head.translation[0] = (float)motion_root(motion, time);
    trial_step(trial);
}

// Mean square distance of particles 1 .. n-1 from the frame's.
static Result square_distance(Trial *trial, const Motion *motion, const MotionFrame *frame,
                              double *mean, Error *error)
{
    Result result = trial_read(trial, error);
    *mean = 0;
    for (int j = 1; j < motion->n; ++j)
        for (int k = 0; k < 3; ++k) {
            double r = (double)trial->points[j][k] - frame->points[j][k];
            *mean += r * r / (motion->n - 1);
        }
    return result;
}

static Result follow(Trial *trial, const Motion *motion, double rate, double *rms, Error *error)
{
    double sum = 0;
    long counted = 0;
    Result result = RESULT_OK;
    for (size_t f = 1; f < motion->frame_count && result == RESULT_OK; ++f) {
        const MotionFrame *frame = &motion->frames[f];
        double mean = 0, ends = frame->time * rate;
        while ((double)trial->steps < ends - 0.01) motions_advance(trial, motion);
        if (!frame->followed || fabs((double)trial->steps - ends) > 0.01) continue;
        result = square_distance(trial, motion, frame, &mean, error);
        sum += mean, ++counted;
    }
    *rms = counted ? sqrt(sum / (double)counted) / motion->length : NAN;
    return result;
}

Result accuracy_measure(double *error_over_length, const Gpu *gpu, const Motion *motion,
                        const SectionParams *params, double rate, Error *error)
{
    Trial trial;
    Result result = motions_start(&trial, gpu, motion, params, rate, error);
    if (result == RESULT_OK) result = follow(&trial, motion, rate, error_over_length, error);
    trial_destroy(&trial);
    return result;
}

// --- All motions.

Result motions_read(Accuracy *accuracy, Error *error)
{
    const char *folder = accuracy->folder;
    char **names;
    size_t count, in_mean = 0;
    Result result = motion_list(&names, &count, folder, error);
    if (result != RESULT_OK) return result;
    accuracy->motions = calloc(count, sizeof *accuracy->motions);
    if (!accuracy->motions)
        result = error_set(error, RESULT_FAILED, "no memory for %zu motions", count);
    for (size_t i = 0; i < count && result == RESULT_OK; ++i) {
        result = motion_read(&accuracy->motions[i], folder, names[i], error);
        if (result == RESULT_OK) accuracy->motion_count = i + 1;
        in_mean += is_in_mean(names[i]);
    }
    accuracy->whole = in_mean == MEAN_COUNT;
    motion_names_destroy(names, count);
    return result;
}

static double stated(const Method *method, const char *scenario, double rate)
{
    for (size_t b = 0; b < sizeof BOUNDS / sizeof *BOUNDS; ++b)
        if (strcmp(BOUNDS[b].algo, method->algo) == 0 && !*method->variant && !*method->settings &&
            strcmp(BOUNDS[b].scenario, scenario) == 0 && BOUNDS[b].rate == rate)
            return BOUNDS[b].most;
    return NAN;
}

static void add_rows(Accuracy *accuracy, const Method *method, const char *scenario,
                     const double *rates, const double *errors, int count)
{
    AccuracyRow row;
    for (int r = 0; r < count; ++r) {
        row = accuracy_row("motions", method, rates[r]);
        snprintf(row.scenario, sizeof row.scenario, "%s", scenario);
        row.what = "error", row.value = errors[r];
        row.bound = stated(method, scenario, rates[r]);
        accuracy_add(accuracy, &row);
    }
    if (count < 2) return;
    row.rate = row.bound = NAN;
    row.what = "order", row.value = accuracy_order(rates, errors, count, &row.spread);
    accuracy_add(accuracy, &row);
}

static Result measure_rates(Accuracy *accuracy, const Motion *motion, const SectionParams *params,
                            const double *rates, int count, double *errors, Error *error)
{
    Result result = RESULT_OK;
    for (int r = 0; r < count && result == RESULT_OK; ++r)
        result = interrupt_requested()
                     ? error_set(error, RESULT_INTERRUPTED, "interrupted")
                     : accuracy_measure(&errors[r], accuracy->gpu, motion, params, rates[r], error);
    return result;
}

static bool counts(const Accuracy *accuracy, size_t motion)
{
    return !accuracy->whole || is_in_mean(accuracy->motions[motion].name);
}

static Result measure_method(Accuracy *accuracy, const Method *method, Error *error)
{
    static const double own[] = {60, 120, 240};
    double rates[BENCH_MOST_RATES], errors[BENCH_MOST_RATES], logs[BENCH_MOST_RATES] = {0};
    int count = accuracy_rates(accuracy, own, 3, rates), counted = 0;
    SectionParams params;
    Result result = accuracy_loose_params(&params, method, error);
    for (size_t m = 0; m < accuracy->motion_count && result == RESULT_OK; ++m) {
        const Motion *motion = &accuracy->motions[m];
        result = measure_rates(accuracy, motion, &params, rates, count, errors, error);
        if (result != RESULT_OK) break;
        add_rows(accuracy, method, motion->name, rates, errors, count);
        for (int r = 0; r < count && counts(accuracy, m); ++r) logs[r] += log(errors[r]);
        counted += counts(accuracy, m);
    }
    params_destroy_section(&params);
    if (result != RESULT_OK) return result;
    for (int r = 0; r < count; ++r) errors[r] = exp(logs[r] / counted);
    add_rows(accuracy, method, accuracy->whole ? "mean" : "mean of these", rates, errors, count);
    return RESULT_OK;
}

Result motions_mean(Accuracy *accuracy, const Method *method, double rate, double *mean,
                    Error *error)
{
    SectionParams params;
    double logs = 0;
    int counted = 0;
    Result result = accuracy_loose_params(&params, method, error);
    for (size_t m = 0; m < accuracy->motion_count && result == RESULT_OK; ++m) {
        double off = 0;
        if (!counts(accuracy, m)) continue;
        result = measure_rates(accuracy, &accuracy->motions[m], &params, &rate, 1, &off, error);
        logs += log(off), ++counted;
    }
    params_destroy_section(&params);
    *mean = exp(logs / counted);
    return result;
}

Result motions_run(Accuracy *accuracy, Error *error)
{
    return accuracy_for_each(accuracy, measure_method, error);
}
