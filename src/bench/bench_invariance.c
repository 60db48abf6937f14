// SPDX-License-Identifier: MIT
#include "bench/bench_invariance.h"
#include "base/interrupt.h"
#include "bench/bench_motions.h"
#include "bench/bench_trial.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// --- The frame rate.

enum { FPS = 30, SECONDS = 2, FRAMES = FPS * SECONDS, MOST = 128 };

// Positions at the end of each frame.
typedef float Course[FRAMES][MOST][3];

static Result record(Accuracy *accuracy, const Motion *motion, const SectionParams *params,
                     double rate, Course course, Error *error)
{
    Trial trial;
    Result result = motions_start(&trial, accuracy->gpu, motion, params, rate, error);
    for (int f = 0; f < FRAMES && result == RESULT_OK; ++f) {
        while ((double)trial.steps < (f + 1) * rate / FPS - 0.01) motions_advance(&trial, motion);
        result = trial_read(&trial, error);
        memcpy(course[f], trial.points, (size_t)motion->n * sizeof *trial.points);
    }
    trial_destroy(&trial);
    return result;
}

static double course_distance(const Course a, const Course b, const Motion *motion)
{
    double sum = 0;
    for (int f = 0; f < FRAMES; ++f)
        for (int j = 1; j < motion->n; ++j)
            for (int k = 0; k < 3; ++k) sum += pow((double)a[f][j][k] - (double)b[f][j][k], 2);
    return sqrt(sum / (FRAMES * (motion->n - 1))) / motion->length;
}

static Result compare_rates(Accuracy *accuracy, const Method *method, const Motion *motion,
                            Error *error)
{
    static const double own[] = {30, 60, 120, 240};
    static Course course, finest; // large
    double rates[BENCH_MOST_RATES];
    int count = accuracy_rates(accuracy, own, 4, rates);
    SectionParams params;
    Result result = method_params(&params, method, error);
    if (result == RESULT_OK)
        result = record(accuracy, motion, &params, rates[count - 1], finest, error);
    for (int r = 0; r < count - 1 && result == RESULT_OK; ++r) {
        AccuracyRow row = accuracy_row("rate", method, rates[r]);
        snprintf(row.scenario, sizeof row.scenario, "%s", motion->name);
        result = record(accuracy, motion, &params, rates[r], course, error);
        row.what = "from finest";
        row.value = course_distance((const float(*)[MOST][3])course,
                                    (const float(*)[MOST][3])finest, motion);
        if (result == RESULT_OK) accuracy_add(accuracy, &row);
    }
    params_destroy_section(&params);
    return result;
}

static Result use_rates(Accuracy *accuracy, const Method *method, Error *error)
{
    static const char *const names[] = {"c_root2Hz_n16_c1", "bd_curly_wind_n16_c4"};
    Result result = RESULT_OK;
    for (size_t m = 0; m < accuracy->motion_count; ++m)
        for (size_t i = 0; i < sizeof names / sizeof *names && result == RESULT_OK; ++i)
            if (strcmp(accuracy->motions[m].name, names[i]) == 0 && accuracy->motions[m].n <= MOST)
                result = interrupt_requested()
                             ? error_set(error, RESULT_INTERRUPTED, "interrupted")
                             : compare_rates(accuracy, method, &accuracy->motions[m], error);
    return result;
}

Result invariance_run_rate(Accuracy *accuracy, Error *error)
{
    return accuracy_for_each(accuracy, use_rates, error);
}

// --- The unit of length.

enum { N = 16, STEPS = 30 };
#define LENGTH 0.25
#define SCALE  100.0
#define STATED 1e-4

// All parameters of solvers that are lengths, or accelerations of them.
static void scale_params(SectionParams *params, double scale)
{
    for (size_t i = 0; i < PARAM_COUNT; ++i) {
        const ParamInfo *info = &PARAM_TABLE[i];
        bool length = strcmp(info->unit, "m") == 0 || strcmp(info->unit, "cm") == 0 ||
                      strcmp(info->unit, "m/s2") == 0;
        if (!length || !method_takes(info) || info->kind != PARAM_FLOAT) continue;
        float *value = (float *)(void *)((char *)params + info->offset);
        *value *= (float)scale;
    }
}

static Result run_scaled(Accuracy *accuracy, const Method *method, double rate, double scale,
                         float points[N][3], Error *error)
{
    double helix[N][3];
    SectionParams params;
    Strands strands = {0};
    Trial trial = {0};
    trial_make_helix(helix, N, LENGTH, 2);
    for (int i = 0; i < 3 * N; ++i) helix[i / 3][i % 3] *= scale;
    Result result = method_params(&params, method, error);
    if (result == RESULT_OK) scale_params(&params, scale);
    if (result == RESULT_OK)
        result = trial_make_strand(&strands, (const double(*)[3])helix, N, error);
    if (result == RESULT_OK)
        result = trial_create(&trial, accuracy->gpu, &strands, &params, rate, error);
    trial.step.gravity[1] *= (float)scale;
    for (int i = 0; i < STEPS && result == RESULT_OK; ++i) trial_step(&trial);
    if (result == RESULT_OK) result = trial_read(&trial, error);
    for (int i = 0; i < 3 * N && result == RESULT_OK; ++i)
        points[i / 3][i % 3] = (float)((double)trial.points[i / 3][i % 3] / scale);
    trial_destroy(&trial);
    strands_destroy(&strands);
    params_destroy_section(&params);
    return result;
}

static Result use_scale(Accuracy *accuracy, const Method *method, Error *error)
{
    static const double own[] = {60};
    double rates[BENCH_MOST_RATES];
    int count = accuracy_rates(accuracy, own, 1, rates);
    Result result = RESULT_OK;
    for (int r = 0; r < count && result == RESULT_OK; ++r) {
        float metres[N][3] = {{0}}, centimetres[N][3] = {{0}};
        AccuracyRow row = accuracy_row("scale", method, rates[r]);
        double sum = 0;
        result = run_scaled(accuracy, method, rates[r], 1, metres, error);
        if (result == RESULT_OK)
            result = run_scaled(accuracy, method, rates[r], SCALE, centimetres, error);
        for (int i = 3; i < 3 * N; ++i)
            sum += pow((double)metres[i / 3][i % 3] - (double)centimetres[i / 3][i % 3], 2);
        snprintf(row.scenario, sizeof row.scenario, "helix of %d in cm", N);
        row.what = "from metres", row.value = sqrt(sum / (N - 1)) / LENGTH, row.bound = STATED;
        if (result == RESULT_OK) accuracy_add(accuracy, &row);
    }
    return result;
}

Result invariance_run_scale(Accuracy *accuracy, Error *error)
{
    return accuracy_for_each(accuracy, use_scale, error);
}
