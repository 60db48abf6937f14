// SPDX-License-Identifier: MIT
#include "bench/bench_pendulum.h"
#include "base/csv.h"
#include "base/interrupt.h"
#include "bench/bench_trial.h"

#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { SPLIT_VERTICES = 16 };
#define LENGTH 0.25

// What is stated: split's tip at 60 Hz.
#define STATED_CASE  "planar90_c4"
#define STATED_RATE  60.0
#define STATED_ERROR 0.002

typedef struct Pendulum {
    char name[64];
    double velocity[3], drag;
    bool rest; // starts without velocity
    int axes;  // columns of a point: x, y and perhaps z
    size_t column;
    const Csv *csv;
} Pendulum;

static double value_at(const Pendulum *pendulum, size_t row, int axis)
{
    double value = 0;
    if (axis < pendulum->axes)
        csv_number(pendulum->csv, row, pendulum->column + (size_t)axis, &value, NULL);
    return value;
}

// --- One run.

// The buffer of that kind and where the tip's entry (or its velocity) is in it; NULL: there is
// none.
static const GpuBuffer *find_entry(const Trial *trial, SolverBufferKind kind, size_t *offset)
{
    const HairBatch *batch = &trial->hair.batches[0];
    SolverBuffer buffers[SOLVER_MAX_BUFFERS];
    int count = solver_buffers(&trial->solver, 0, buffers);
    *offset = hair_address(batch, 0, batch->vertex_count - 1) * sizeof(float[4]);
    if (kind == SOLVER_TIPS) *offset = 0;
    for (int i = 0; i < count; ++i)
        if (buffers[i].kind == kind) return buffers[i].buffer;
    return NULL;
}

// False if the pendulum has a start velocity that the solver cannot be given.
static bool set_velocity(const Trial *trial, const Pendulum *pendulum)
{
    size_t offset;
    float velocity[4] = {(float)pendulum->velocity[0], (float)pendulum->velocity[1],
                         (float)pendulum->velocity[2], 0};
    const GpuBuffer *buffer = find_entry(trial, SOLVER_TIPS, &offset);
    if (buffer)
        offset += sizeof velocity; // behind the point
    else
        buffer = find_entry(trial, SOLVER_VELOCITIES, &offset);
    if (!buffer || pendulum->rest) return pendulum->rest;
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer->buffer);
    glBufferSubData(GL_SHADER_STORAGE_BUFFER, (GLintptr)offset, sizeof velocity, velocity);
    return true;
}

static Result read_end(Trial *trial, float end[3], Error *error)
{
    float tip[2][4];
    if (trial_read_tip(trial, 0, 0, tip)) {
        memcpy(end, tip[0], sizeof(float[3]));
        return RESULT_OK;
    }
    Result result = trial_read(trial, error);
    memcpy(end, trial->points[trial->hair.particle_count - 1], sizeof(float[3]));
    return result;
}

static Result follow(Trial *trial, const Pendulum *pendulum, double rate, double *rms, Error *error)
{
    double sum = 0;
    long counted = 0;
    Result result = RESULT_OK;
    for (size_t row = 1; row < pendulum->csv->row_count && result == RESULT_OK; ++row) {
        double time = 0;
        float tip[3];
        csv_number(pendulum->csv, row, 1, &time, NULL);
        while ((double)trial->steps < time * rate - 0.01) trial_step(trial);
        if (fabs((double)trial->steps - time * rate) > 0.01) continue;
        result = read_end(trial, tip, error);
        for (int k = 0; k < 3; ++k) sum += pow((double)tip[k] - value_at(pendulum, row, k), 2);
        ++counted;
    }
    *rms = counted ? sqrt(sum / (double)counted) / LENGTH : NAN;
    return result;
}

// *rms is NaN if the solver cannot start so.
static Result measure(Accuracy *accuracy, const Method *method, const Pendulum *pendulum,
                      double rate, double *rms, Error *error)
{
    double points[SPLIT_VERTICES][3];
    int n = strcmp(method->algo, "split") == 0 ? SPLIT_VERTICES : 2;
    SectionParams params;
    Strands strands = {0};
    Trial trial = {0};
    for (int j = 0; j < n; ++j)
        for (int k = 0; k < 3; ++k) points[j][k] = value_at(pendulum, 0, k) * j / (n - 1);
    *rms = NAN;
    if (interrupt_requested()) return error_set(error, RESULT_INTERRUPTED, "interrupted");
    Result result = accuracy_loose_params(&params, method, error);
    params.drag = (float)pendulum->drag;
    if (result == RESULT_OK)
        result = trial_make_strand(&strands, (const double(*)[3])points, n, error);
    if (result == RESULT_OK)
        result = trial_create(&trial, accuracy->gpu, &strands, &params, rate, error);
    if (result == RESULT_OK && set_velocity(&trial, pendulum))
        result = follow(&trial, pendulum, rate, rms, error);
    trial_destroy(&trial);
    strands_destroy(&strands);
    params_destroy_section(&params);
    return result;
}

// --- Rows.

static double stated(const Method *method, const Pendulum *pendulum, double rate)
{
    return strcmp(method->algo, "split") == 0 && !*method->variant &&
                   strcmp(pendulum->name, STATED_CASE) == 0 && rate == STATED_RATE
               ? STATED_ERROR
               : NAN;
}

static Result use_pendulum(Accuracy *accuracy, const Method *method, const Pendulum *pendulum,
                           Error *error)
{
    static const double own[] = {60, 120, 240};
    double rates[BENCH_MOST_RATES], errors[BENCH_MOST_RATES];
    int count = accuracy_rates(accuracy, own, 3, rates);
    AccuracyRow row = accuracy_row("pendulum", method, NAN);
    snprintf(row.scenario, sizeof row.scenario, "%s", pendulum->name);
    for (int r = 0; r < count; ++r) {
        Result result = measure(accuracy, method, pendulum, rates[r], &errors[r], error);
        if (result != RESULT_OK) return result;
        if (isnan(errors[r])) return RESULT_OK;
        row.rate = rates[r], row.what = "error", row.value = errors[r];
        row.bound = stated(method, pendulum, rates[r]);
        accuracy_add(accuracy, &row);
    }
    if (count < 2) return RESULT_OK;
    row.rate = row.bound = NAN;
    row.what = "order", row.value = accuracy_order(rates, errors, count, &row.spread);
    accuracy_add(accuracy, &row);
    return RESULT_OK;
}

// The pendulum whose x is in `column`: its start from the JSON file, or from rest.
static Pendulum describe(const Csv *csv, size_t column, const json_t *starts)
{
    Pendulum pendulum = {.csv = csv, .column = column, .axes = 2, .rest = true};
    snprintf(pendulum.name, sizeof pendulum.name, "%s", csv->column[column] + 2);
    if (column + 2 < csv->column_count && csv->column[column + 2][0] == 'z') pendulum.axes = 3;
    const json_t *start = json_object_get(starts, pendulum.name),
                 *velocity = json_object_get(start, "velocity");
    pendulum.drag = json_number_value(json_object_get(start, "drag_c"));
    for (size_t k = 0; k < 3; ++k) {
        pendulum.velocity[k] = json_number_value(json_array_get(velocity, k));
        pendulum.rest = pendulum.rest && pendulum.velocity[k] == 0;
    }
    return pendulum;
}

static Result use_file(Accuracy *accuracy, const Method *method, const char *name, Error *error)
{
    char path[4096];
    Csv csv;
    snprintf(path, sizeof path, "%s/%s.json", accuracy->folder, name);
    json_t *starts = json_load_file(path, 0, NULL);
    snprintf(path, sizeof path, "%s/%s.csv", accuracy->folder, name);
    if (access(path, R_OK) != 0) {
        json_decref(starts);
        return RESULT_OK;
    }
    Result result = csv_read(&csv, path, error);
    for (size_t i = 2; result == RESULT_OK && i < csv.column_count; ++i) {
        if (strncmp(csv.column[i], "x_", 2) != 0) continue;
        const Pendulum pendulum = describe(&csv, i, starts);
        result = use_pendulum(accuracy, method, &pendulum, error);
    }
    csv_destroy(&csv);
    json_decref(starts);
    return result;
}

static Result use_method(Accuracy *accuracy, const Method *method, Error *error)
{
    Result result = use_file(accuracy, method, "e_pendulum_planar", error);
    return result == RESULT_OK ? use_file(accuracy, method, "e_pendulum_3d", error) : result;
}

Result pendulum_run(Accuracy *accuracy, Error *error)
{
    return accuracy_for_each(accuracy, use_method, error);
}
