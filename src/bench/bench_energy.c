// SPDX-License-Identifier: MIT
#include "bench/bench_energy.h"
#include "base/interrupt.h"
#include "bench/bench_motions.h"
#include "bench/bench_trial.h"
#include "sim/particle_solver.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LENGTH        0.25
#define G             9.81
#define STATED_RISE   0.01
#define STATED_LENGTH 1e-5

enum { SIZES = 3, KINDS = 2, STRANDS = SIZES * KINDS };
static const int COUNTS[SIZES] = {4, 16, 64};

// Who is known to gain more, from how many particles a strand on (docs/solvers.md says why).
static const struct {
    const char *algo;
    int from;
    double most;
} KNOWN[] = {{"dftl", 64, 0.12}, {"dftl", 16, 0.04}};

static double known(const Method *method, int n)
{
    for (size_t i = 0; i < sizeof KNOWN / sizeof *KNOWN; ++i)
        if (strcmp(KNOWN[i].algo, method->algo) == 0 && n >= KNOWN[i].from) return KNOWN[i].most;
    return NAN;
}

// --- Energy.

// Strand s has COUNTS[s / KINDS] particles; its kind is straight or a helix.
typedef struct Fall {
    Trial trial;
    double (*start)[3], (*before)[3]; // of all particles; of split, tips where those of strands are
    double most[SIZES], last[SIZES];  // energy over what can be lost, the greatest of both kinds
    double most_own[SIZES];           // the same by the solver's own velocities
    bool own, ends;                   // it has such; at a step's end, not in the middle of the way
} Fall;

static Result make_strands(Strands *strands, Error *error)
{
    uint32_t total = 0, at = 0;
    for (int i = 0; i < SIZES; ++i) total += KINDS * (uint32_t)COUNTS[i];
    Result result = strands_create(strands, STRANDS, total, error);
    for (uint32_t s = 0; s < STRANDS && result == RESULT_OK; ++s) {
        double points[64][3];
        int n = COUNTS[s / KINDS];
        strands->first[s] = at;
        (s % KINDS ? trial_make_helix(points, n, LENGTH, 1) : trial_make_beam(points, n, LENGTH));
        for (int j = 0; j < n; ++j, ++at)
            for (int k = 0; k < 3; ++k) strands->position[at][k] = (float)points[j][k];
    }
    if (result == RESULT_OK) strands->first[STRANDS] = at;
    return result;
}

// The drawn positions; split's tips in place of the strands' ends.
static Result read_points(Fall *fall, double (*points)[3], Error *error)
{
    size_t at = 0;
    Result result = trial_read(&fall->trial, error);
    for (uint32_t s = 0; s < STRANDS && result == RESULT_OK; ++s) {
        float tip[2][4];
        size_t n = (size_t)COUNTS[s / KINDS];
        for (size_t j = at; j < at + n; ++j)
            for (int k = 0; k < 3; ++k) points[j][k] = (double)fall->trial.points[j][k];
        at += n;
        if (trial_read_tip(&fall->trial, s / KINDS, s % KINDS, tip))
            for (int k = 0; k < 3; ++k) points[at - 1][k] = (double)tip[0][k];
    }
    return result;
}

// Of the motion from a to b in dt, less that of the start, over what falling can give. Particles
// from `from` on have mass.
static double energy(const double (*start)[3], const double (*a)[3], const double (*b)[3], int from,
                     int n, double dt)
{
    double sum = 0, budget = 0;
    for (int j = from; j < n; ++j) {
        double square = 0;
        for (int k = 0; k < 3; ++k) square += pow((b[j][k] - a[j][k]) / dt, 2);
        sum += square / 2 + G * ((a[j][1] + b[j][1]) / 2 - start[j][1]);
        budget += G * (start[j][1] - start[0][1] + LENGTH * j / (n - 1));
    }
    return sum / budget;
}

// Whose velocities are those of its strand: not split's, whose tip has mass alone, nor dftl's,
// which also hold the corrections that are to come.
static bool has_velocities(const Method *method)
{
    return strcmp(method->algo, "split") != 0 && strcmp(method->algo, "dftl") != 0;
}

// Seconds of the steps that the solver really takes.
static double small_step(const Trial *trial)
{
    const ParticleRecipe *recipe = trial->solver.type->recipes[0];
    int count = recipe && recipe->substeps
                    ? recipe->substeps(&trial->step, &trial->params, &trial->hair)
                    : 1;
    return trial->step.dt / count;
}

// The way from a to b in h seconds that a strand's velocities say, with `now` at its end or, if the
// velocities are those at a step's end, in its middle.
static void follow_velocities(const Fall *fall, uint32_t s, const double (*now)[3], double h,
                              double (*a)[3], double (*b)[3])
{
    const HairBatch *batch = &fall->trial.hair.batches[s / KINDS];
    const double ahead = fall->ends ? h / 2 : 0;
    SolverBuffer buffers[SOLVER_MAX_BUFFERS];
    int count = solver_buffers(&fall->trial.solver, s / KINDS, buffers);
    for (int i = 0; i < count; ++i) {
        if (buffers[i].kind != SOLVER_VELOCITIES) continue;
        glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffers[i].buffer->buffer);
        for (uint32_t j = 0; j < batch->vertex_count; ++j) {
            float v[4];
            glGetBufferSubData(GL_SHADER_STORAGE_BUFFER,
                               (GLintptr)(hair_address(batch, s % KINDS, j) * sizeof v), sizeof v,
                               v);
            for (int k = 0; k < 3; ++k) {
                b[j][k] = now[j][k] + ahead * (double)v[k];
                a[j][k] = b[j][k] - h * (double)v[k];
            }
        }
    }
}

static void raise_most(double *most, double e)
{
    if (!(e <= *most)) *most = e; // a NaN stays
}

static void judge(Fall *fall, const double (*now)[3])
{
    float tip[2][4];
    bool tips = trial_read_tip(&fall->trial, 0, 0, tip);
    double dt = fall->trial.step.dt, h = small_step(&fall->trial), a[64][3], b[64][3];
    size_t at = 0;
    for (uint32_t s = 0; s < STRANDS; ++s) {
        const double(*start)[3] = (const double(*)[3])fall->start + at;
        const double(*before)[3] = (const double(*)[3])fall->before + at;
        uint32_t size = s / KINDS;
        int n = COUNTS[size];
        double e = energy(start, before, now + at, tips ? n - 1 : 1, n, dt);
        raise_most(&fall->most[size], e);
        fall->last[size] = s % KINDS ? fmax(fall->last[size], e) : e;
        if (fall->own) {
            follow_velocities(fall, s, now + at, h, a, b);
            raise_most(&fall->most_own[size],
                       energy(start, (const double(*)[3])a, (const double(*)[3])b, 1, n, h));
        }
        at += (size_t)n;
    }
}

// Looks at every step in the first second, when hair falls, and 4 times a second then.
static Result watch(Fall *fall, double rate, double seconds, Error *error)
{
    size_t count = fall->trial.hair.particle_count;
    double(*now)[3] = calloc(count, sizeof *now);
    long steps = (long)(seconds * rate + 0.5), sparse = (long)fmax(rate / 4, 1);
    Result result = now ? read_points(fall, fall->start, error)
                        : error_set(error, RESULT_FAILED, "no memory for positions");
    if (result == RESULT_OK) memcpy(fall->before, fall->start, count * sizeof *now);
    for (long i = 1; i <= steps && result == RESULT_OK; ++i) {
        bool look = i <= (long)rate || i % sparse == 0 || i == steps;
        if (interrupt_requested()) result = error_set(error, RESULT_INTERRUPTED, "interrupted");
        if (look && i > 1 && result == RESULT_OK) result = read_points(fall, fall->before, error);
        trial_step(&fall->trial);
        if (look && result == RESULT_OK) result = read_points(fall, now, error);
        if (look && result == RESULT_OK) judge(fall, (const double(*)[3])now);
    }
    free(now);
    return result;
}

static Result fall_create(Fall *fall, const Accuracy *accuracy, const Method *method,
                          SectionParams *params, double rate, Error *error)
{
    Strands strands = {0};
    *fall = (Fall){.most = {-1, -1, -1},
                   .most_own = {-1, -1, -1},
                   .own = has_velocities(method),
                   .ends = strcmp(method->algo, "hybrid") == 0 ||
                           strcmp(method->algo, "emulation") == 0};
    Result result = method_params(params, method, error);
    if (result == RESULT_OK) result = make_strands(&strands, error);
    params->stretch_drawn = true; // the strand that has the energy
    if (result == RESULT_OK)
        result = trial_create(&fall->trial, accuracy->gpu, &strands, params, rate, error);
    if (result == RESULT_OK) {
        size_t count = fall->trial.hair.particle_count;
        fall->start = calloc(count, sizeof *fall->start);
        fall->before = calloc(count, sizeof *fall->before);
        if (!fall->start || !fall->before)
            result = error_set(error, RESULT_FAILED, "no memory for positions");
    }
    strands_destroy(&strands);
    return result;
}

static void fall_destroy(Fall *fall)
{
    trial_destroy(&fall->trial);
    free(fall->start);
    free(fall->before);
}

static double floor_at_0(double energy)
{
    return isnan(energy) || energy > 0 ? energy : 0;
}

static Result use_fall(Accuracy *accuracy, const Method *method, double rate, int drag, bool styled,
                       Error *error)
{
    Fall fall;
    SectionParams params = {0};
    char settings[512];
    double seconds = accuracy->options->seconds;
    snprintf(settings, sizeof settings, "--style %s --drag %d %s", styled ? "0.5" : "0", drag,
             method->settings);
    const Method own = {method->algo, method->variant, settings};
    bool stated = !*method->variant && !*method->settings;
    Result result = fall_create(&fall, accuracy, &own, &params, rate, error);
    if (result == RESULT_OK) result = watch(&fall, rate, seconds, error);
    for (int i = 0; i < SIZES && result == RESULT_OK; ++i) {
        AccuracyRow row = accuracy_row("energy", method, rate);
        snprintf(row.scenario, sizeof row.scenario, "n = %d, drag %d, %s", COUNTS[i], drag,
                 styled ? "styled" : "loose");
        row.what = "rise as drawn", row.value = floor_at_0(fall.most[i]);
        if (fall.own) accuracy_add(accuracy, &row);
        row.what = "rise", row.value = floor_at_0(fall.own ? fall.most_own[i] : fall.most[i]);
        row.bound = stated ? STATED_RISE : NAN, row.known = stated ? known(method, COUNTS[i]) : NAN;
        accuracy_add(accuracy, &row);
        row.what = "change", row.value = fall.last[i], row.bound = row.known = NAN;
        if (drag == 0 && !styled) accuracy_add(accuracy, &row);
    }
    fall_destroy(&fall);
    params_destroy_section(&params);
    return result;
}

static Result use_method(Accuracy *accuracy, const Method *method, Error *error)
{
    static const double own[] = {30, 60, 120, 240};
    double rates[BENCH_MOST_RATES];
    int count = accuracy_rates(accuracy, own, 4, rates);
    Result result = RESULT_OK;
    for (int r = 0; r < count; ++r)
        for (int run = 0; run < 4 && result == RESULT_OK; ++run)
            result = use_fall(accuracy, method, rates[r], run % 2, run / 2, error);
    return result;
}

Result energy_run(Accuracy *accuracy, Error *error)
{
    return accuracy_for_each(accuracy, use_method, error);
}

// --- Stretch.

static double greatest_stretch(const Trial *trial, const Motion *motion)
{
    double most = 0, size = 0;
    for (int j = 1; j < motion->n; ++j) {
        double now = 0, rest = 0;
        for (int k = 0; k < 3; ++k) {
            now += pow((double)trial->points[j][k] - (double)trial->points[j - 1][k], 2);
            rest += pow(
                (double)(float)motion->points[j][k] - (double)(float)motion->points[j - 1][k], 2);
            size = fmax(size, fabs((double)trial->points[j][k]));
        }
        // less what the rounding of stored positions explains: 2^-24 of a coordinate for either end
        double rounding = 2 * 1.8 * 0x1p-24 * size;
        double off = fabs(sqrt(now) - sqrt(rest));
        most = fmax(most, (off - rounding) / sqrt(rest));
        if (isnan(off)) most = NAN;
    }
    return most;
}

static Result stretch_in(Accuracy *accuracy, const Motion *motion, const SectionParams *params,
                         double rate, double *most, Error *error)
{
    Trial trial;
    Result result = motions_start(&trial, accuracy->gpu, motion, params, rate, error);
    for (size_t f = 1; f < motion->frame_count && result == RESULT_OK; ++f) {
        while ((double)trial.steps < motion->frames[f].time * rate - 0.01)
            motions_advance(&trial, motion);
        result = trial_read(&trial, error);
        double now = greatest_stretch(&trial, motion);
        if (!(now <= *most)) *most = now;
    }
    trial_destroy(&trial);
    return result;
}

static Result add_stretch(Accuracy *accuracy, const Method *method, double rate, bool simulated,
                          Error *error)
{
    SectionParams params;
    AccuracyRow row = accuracy_row("stretch", method, rate);
    snprintf(row.scenario, sizeof row.scenario, "greatest of all motions");
    row.what = simulated ? "as simulated" : "as drawn";
    row.value = 0;
    Result result = accuracy_loose_params(&params, method, error);
    params.stretch_drawn = simulated;
    for (size_t m = 0; m < accuracy->motion_count && result == RESULT_OK; ++m)
        result = interrupt_requested() ? error_set(error, RESULT_INTERRUPTED, "interrupted")
                                       : stretch_in(accuracy, &accuracy->motions[m], &params, rate,
                                                    &row.value, error);
    params_destroy_section(&params);
    if (result != RESULT_OK) return result;
    bool stated = !*method->variant && !*method->settings && !simulated;
    row.bound = stated ? STATED_LENGTH : NAN;
    accuracy_add(accuracy, &row);
    return RESULT_OK;
}

static Result use_stretch(Accuracy *accuracy, const Method *method, Error *error)
{
    static const double own[] = {60, 240};
    double rates[BENCH_MOST_RATES];
    int count = accuracy_rates(accuracy, own, 2, rates);
    bool springy = strcmp(method->algo, "spring") == 0 || strcmp(method->algo, "rope") == 0;
    Result result = RESULT_OK;
    for (int r = 0; r < count && result == RESULT_OK; ++r) {
        result = add_stretch(accuracy, method, rates[r], false, error);
        if (springy && result == RESULT_OK)
            result = add_stretch(accuracy, method, rates[r], true, error);
    }
    return result;
}

Result energy_run_stretch(Accuracy *accuracy, Error *error)
{
    return accuracy_for_each(accuracy, use_stretch, error);
}
