// SPDX-License-Identifier: MIT
#include "bench/bench_work.h"
#include "base/interrupt.h"
#include "bench/bench_motions.h"
#include "bench/bench_speed.h"
#include "gen/strands_make.h"
#include "run/stats.h"
#include "strands/strands_read.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// What is worth comparing: every solver, its variants, and what trades time for accuracy.
static const Method WORTH[] = {
    {"split", "ball", ""},
    {"split", "thesis", ""},
    {"emulation", "projected", ""},
    {"hybrid", "", ""},
    {"chain", "", ""},
    {"tressfx", "steady", ""},
    {"tressfx", "tressfx4", "--tressfx-length-constraints-iterations 2"},
    {"tressfx", "tressfx4", "--tressfx-length-constraints-iterations 10"},
    {"spring", "implicit", "--spring-coil 10000"},
    {"spring", "implicit", "--spring-coil 1000000"},
    {"spring", "explicit", "--spring-coil 10000"},
    {"rope", "bullet", "--rope-iterations 2"},
    {"rope", "bullet", "--rope-iterations 10"},
    {"rope", "bullet", "--rope-iterations 50"},
    {"rope", "xpbd", "--rope-iterations 10"},
    {"rope", "xpbd", "--rope-iterations 50"},
    {"dftl", "", "--ftl-damping 0.9"},
    {"dftl", "", "--ftl-damping 0.98"},
};
enum { WORTH_COUNT = sizeof WORTH / sizeof *WORTH };

static const double LEVELS[] = {0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002};
static const char *const SETS[] = {"1k16", "1k32", "10k16", "10k32"};
enum { LEVEL_COUNT = sizeof LEVELS / sizeof *LEVELS, SET_COUNT = sizeof SETS / sizeof *SETS };

// A frame is what is timed: its steps, and the positions that are drawn. Rounds over all points,
// so that a noisy minute hits none alone.
enum { FPS = 60, ROUNDS = 2, WARM_UP = 2, MOST_SAMPLES = 20 };
#define ENOUGH_MS 200.0 // of a point in a round, and of its warm-up

typedef struct Point {
    Method method;
    double rate, error; // 1/s; mean over the length
    double samples[ROUNDS * MOST_SAMPLES];
    int count;
    BenchTimes times; // a simulated second, ms
    bool front;
} Point;

typedef struct Work {
    Accuracy *accuracy;
    Point *points;
    int count;
} Work;

static bool is_worth(const Accuracy *accuracy, const Method *method)
{
    const char *algo = accuracy->options->method.algo;
    return !algo || strcmp(algo, method->algo) == 0;
}

static Result list_points(Work *work, Error *error)
{
    static const double own[] = {60, 120, 240, 480};
    const Method *asked = &work->accuracy->options->method;
    bool one = asked->algo && (*asked->variant || *asked->settings);
    double rates[BENCH_MOST_RATES];
    int count = accuracy_rates(work->accuracy, own, 4, rates);
    work->points = calloc((size_t)(WORTH_COUNT * count), sizeof *work->points);
    if (!work->points) return error_set(error, RESULT_FAILED, "no memory for points");
    for (int m = 0; m < (one ? 1 : WORTH_COUNT); ++m)
        for (int r = 0; r < count; ++r)
            if (one || is_worth(work->accuracy, &WORTH[m]))
                work->points[work->count++] =
                    (Point){.method = one ? *asked : WORTH[m], .rate = rates[r]};
    return RESULT_OK;
}

static Result find_errors(Work *work, Error *error)
{
    Result result = RESULT_OK;
    for (int i = 0; i < work->count && result == RESULT_OK; ++i)
        result = motions_mean(work->accuracy, &work->points[i].method, work->points[i].rate,
                              &work->points[i].error, error);
    return result;
}

// --- Time.

static void time_frames(Trial *trial, Point *point, int most)
{
    int steps = point->rate > FPS ? (int)(point->rate / FPS + 0.5) : 1;
    double per_second = point->rate / steps, begun = stats_clock_ms();
    for (int i = -WARM_UP; i < most; ++i) {
        double begin = stats_clock_ms();
        if (i < 0 && begin - begun > ENOUGH_MS) i = 0; // warm enough
        for (int step = 0; step < steps; ++step) trial_step(trial);
        solver_pose(&trial->solver, &trial->step.head);
        glFinish();
        double end = stats_clock_ms();
        if (i == -1) begun = end;
        if (i < 0) continue;
        point->samples[point->count++] = (end - begin) * per_second;
        if (end - begun > ENOUGH_MS) return;
    }
}

static Result time_point(Work *work, Point *point, const Strands *strands, Error *error)
{
    SectionParams params;
    Trial trial = {0};
    if (interrupt_requested()) return error_set(error, RESULT_INTERRUPTED, "interrupted");
    Result result = accuracy_loose_params(&params, &point->method, error);
    if (result == RESULT_OK)
        result = trial_create(&trial, work->accuracy->gpu, strands, &params, point->rate, error);
    if (result == RESULT_OK) time_frames(&trial, point, MOST_SAMPLES);
    trial_destroy(&trial);
    params_destroy_section(&params);
    return result;
}

static Result time_points(Work *work, const Strands *strands, Error *error)
{
    Result result = RESULT_OK;
    for (int i = 0; i < work->count; ++i) work->points[i].count = 0;
    for (int round = 0; round < ROUNDS; ++round)
        for (int i = 0; i < work->count && result == RESULT_OK; ++i)
            result = time_point(work, &work->points[i], strands, error);
    for (int i = 0; i < work->count; ++i)
        work->points[i].times = bench_times_of(work->points[i].samples, work->points[i].count);
    return result;
}

// --- Rows.

// By the least time: noise only adds.
static void find_front(Work *work)
{
    for (int i = 0; i < work->count; ++i) {
        Point *p = &work->points[i];
        p->front = isfinite(p->error);
        for (int k = 0; k < work->count; ++k) {
            const Point *q = &work->points[k];
            if (q->error <= p->error && q->times.minimum <= p->times.minimum &&
                (q->error < p->error || q->times.minimum < p->times.minimum))
                p->front = false;
        }
    }
}

static AccuracyRow point_row(const Point *point, const char *set, const char *what)
{
    AccuracyRow row = accuracy_row("work", &point->method, point->rate);
    snprintf(row.scenario, sizeof row.scenario, "mean");
    row.set = set, row.what = what, row.value = point->error;
    row.ms_min = point->times.minimum, row.ms_median = point->times.median;
    row.ms_q1 = point->times.lower_quartile, row.ms_q3 = point->times.upper_quartile;
    row.front = point->front ? "front" : "";
    return row;
}

static void add_rows(Work *work, const char *set)
{
    find_front(work);
    for (int i = 0; i < work->count; ++i) {
        AccuracyRow row = point_row(&work->points[i], set, "error");
        accuracy_add(work->accuracy, &row);
    }
    for (int level = 0; level < LEVEL_COUNT; ++level) {
        const Point *best = NULL;
        for (int i = 0; i < work->count; ++i) {
            const Point *p = &work->points[i];
            if (p->error <= LEVELS[level] && (!best || p->times.minimum < best->times.minimum))
                best = p;
        }
        if (!best) continue;
        AccuracyRow row = point_row(best, set, "fastest at level");
        snprintf(row.scenario, sizeof row.scenario, "error <= %g", LEVELS[level]);
        accuracy_add(work->accuracy, &row);
    }
}

static Result use_set(Work *work, const char *set, const char *file, Error *error)
{
    Strands strands = {0};
    Result result = file ? strands_read(&strands, file, &(StrandsReadOptions){0}, NULL, error)
                         : strands_make_set(&strands, set, 1, error);
    if (result == RESULT_OK) result = time_points(work, &strands, error);
    if (result == RESULT_OK) add_rows(work, file ? file : set);
    strands_destroy(&strands);
    return result;
}

Result work_run(Accuracy *accuracy, Error *error)
{
    const BenchOptions *options = accuracy->options;
    Work work = {.accuracy = accuracy};
    Result result = list_points(&work, error);
    if (result == RESULT_OK) result = find_errors(&work, error);
    for (int i = 0; i < SET_COUNT && !options->set && !options->tfx && result == RESULT_OK; ++i)
        result = use_set(&work, SETS[i], NULL, error);
    if (result == RESULT_OK && options->set) result = use_set(&work, options->set, NULL, error);
    if (result == RESULT_OK && options->tfx) result = use_set(&work, NULL, options->tfx, error);
    for (int i = 0; i < options->file_count && result == RESULT_OK; ++i)
        result = use_set(&work, NULL, options->files[i], error);
    free(work.points);
    return result;
}
