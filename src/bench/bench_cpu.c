// SPDX-License-Identifier: MIT
#include "bench/bench_cpu.h"
#include "base/clock.h"
#include "bench/cpu_split.h"
#include "bench/trial.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MOST_THREADS = 64 };

static int processors(void)
{
    long count = sysconf(_SC_NPROCESSORS_ONLN);
    return count < 1 ? 1 : count > MOST_THREADS ? MOST_THREADS : (int)count;
}

// Calls `work` on `count` threads, this one among them, with each one's number; waits for all.
typedef struct Team {
    void (*work)(void *data, int number, int count);
    void *data;
    int number, count;
} Team;

static void *join_team(void *pointer)
{
    const Team *team = pointer;
    team->work(team->data, team->number, team->count);
    return NULL;
}

static void run_team(int count, void (*work)(void *data, int number, int count), void *data)
{
    pthread_t threads[MOST_THREADS];
    Team team[MOST_THREADS];
    bool started[MOST_THREADS] = {false};
    for (int i = 0; i < count; ++i) team[i] = (Team){work, data, i, count};
    for (int i = 1; i < count; ++i)
        started[i] = pthread_create(&threads[i], NULL, join_team, &team[i]) == 0;
    for (int i = 0; i < count; ++i)
        if (!started[i]) join_team(&team[i]);
    for (int i = 1; i < count; ++i)
        if (started[i]) pthread_join(threads[i], NULL);
}

// --- Memory.

enum { ELEMENTS = 16 << 20, RUNS = 12 }; // 64 MiB an array

typedef struct Arrays {
    float *a, *b, *c;
} Arrays;

static void add_arrays(void *data, int number, int count)
{
    const Arrays *arrays = data;
    size_t first = (size_t)number * ELEMENTS / (size_t)count,
           last = (size_t)(number + 1) * ELEMENTS / (size_t)count;
    for (size_t i = first; i < last; ++i) arrays->a[i] = arrays->b[i] + 3 * arrays->c[i];
}

static void fill_arrays(void *data, int number, int count)
{
    const Arrays *arrays = data;
    size_t first = (size_t)number * ELEMENTS / (size_t)count,
           last = (size_t)(number + 1) * ELEMENTS / (size_t)count;
    for (size_t i = first; i < last; ++i)
        arrays->a[i] = 0, arrays->b[i] = (float)i, arrays->c[i] = 1;
}

Result cpu_run_memory(Speed *speed, Error *error)
{
    size_t size = ELEMENTS * sizeof(float);
    Arrays arrays = {malloc(size), malloc(size), malloc(size)};
    double samples[RUNS];
    Result result = arrays.a && arrays.b && arrays.c
                        ? RESULT_OK
                        : error_set(error, RESULT_FAILED, "no memory to measure it");
    if (result == RESULT_OK) {
        SpeedRow row = speed_row("memory", NULL);
        run_team(processors(), fill_arrays, &arrays);
        for (int i = 0; i < RUNS; ++i) {
            double begin = clock_ms();
            run_team(processors(), add_arrays, &arrays);
            samples[i] = clock_ms() - begin;
        }
        row.result.step = table_times(samples, RUNS);
        speed->bandwidth = 3.0 * (double)size / row.result.step.minimum * 1e-6;
        row.gigabytes_s = speed->bandwidth;
        row.threads = processors();
        row.remark = "a = b + 3 c, 3 x 64 MiB";
        speed_add(speed, &row);
    }
    free(arrays.a);
    free(arrays.b);
    free(arrays.c);
    return result;
}

// --- split in C.

#define RATE    60.0
#define DRAG    1.0
#define STATED  1e-4
#define SECONDS 1

// Steps by a team that stays together: one clock, a barrier before and after each.
typedef struct March {
    CpuSplit *split;
    CpuSplitForm form;
    int steps, warm_up;
    double *samples;
    pthread_barrier_t barrier;
} March;

static void march(void *data, int number, int count)
{
    March *m = data;
    uint64_t tiles = m->split->tile_count;
    uint32_t first = (uint32_t)(tiles * (uint64_t)number / (uint64_t)count),
             last = (uint32_t)(tiles * (uint64_t)(number + 1) / (uint64_t)count);
    for (int i = -m->warm_up; i < m->steps; ++i) {
        double begin = clock_ms();
        pthread_barrier_wait(&m->barrier);
        cpu_split_step(m->split, m->form, first, last);
        pthread_barrier_wait(&m->barrier);
        if (i >= 0 && number == 0) m->samples[i] = clock_ms() - begin;
    }
}

static Result measure_march(Times *times, CpuSplit *split, CpuSplitForm form, int threads,
                            const BenchOptions *options, Error *error)
{
    March m = {.split = split,
               .form = form,
               .steps = options->steps,
               .warm_up = options->warm_up,
               .samples = calloc((size_t)options->steps, sizeof(double))};
    if (!m.samples) return error_set(error, RESULT_FAILED, "no memory for samples");
    cpu_split_time(split, 1 / RATE, DRAG, false);
    pthread_barrier_init(&m.barrier, NULL, (unsigned)threads);
    run_team(threads, march, &m);
    pthread_barrier_destroy(&m.barrier);
    *times = table_times(m.samples, options->steps);
    free(m.samples);
    return RESULT_OK;
}

// RMS over the length, of all particles but roots, after a second from rest.
static Result compare(const Speed *speed, const SpeedSubject *subject, CpuSplit *split,
                      CpuSplitForm form, double *off, Error *error)
{
    const Method method = {"split", "", "--style 0 --drag 1"};
    SectionParams params = {0};
    Trial trial = {0};
    float(*own)[3] = calloc(subject->strands->vertex_count, sizeof *own);
    double sum = 0, length = (double)split->ends[9 * CPU_SPLIT_WIDTH];
    Result result = own ? method_params(&params, &method, "", error)
                        : error_set(error, RESULT_FAILED, "no memory for positions");
    if (result == RESULT_OK)
        result = trial_create(&trial, speed->gpu, subject->strands, 0, &params, RATE, error);
    for (int i = 0; i < SECONDS * (int)RATE && result == RESULT_OK; ++i) {
        trial_step(&trial);
        cpu_split_time(split, 1 / RATE, DRAG, i == 0);
        cpu_split_step(split, form, 0, split->tile_count);
    }
    if (result == RESULT_OK) result = trial_read(&trial, error);
    if (result == RESULT_OK) cpu_split_read(split, own);
    uint64_t count = result == RESULT_OK ? trial.hair.particle_count : 0;
    for (uint64_t i = 0; i < count; ++i)
        for (int k = 0; k < 3; ++k) sum += pow((double)own[i][k] - (double)trial.points[i][k], 2);
    *off = sqrt(sum / (double)(count - trial.hair.strand_count)) / length;
    trial_destroy(&trial);
    params_destroy_section(&params);
    free(own);
    return result;
}

static Result measure_form(Speed *speed, const SpeedSubject *subject, CpuSplitForm form,
                           Error *error)
{
    static char lanes[64];
    SpeedRow row = speed_row("c", subject);
    CpuSplit split;
    snprintf(lanes, sizeof lanes, "plain C, %d strands side by side, %s", CPU_SPLIT_WIDTH,
             cpu_split_lanes());
    row.remark = form == CPU_SPLIT_LANES ? lanes : "plain C, scalar";
    Result result = cpu_split_create(&split, subject->strands, error);
    if (result == RESULT_OK) result = compare(speed, subject, &split, form, &row.off, error);
    row.off_bound = STATED;
    for (int threads = 1; threads <= 2 && result == RESULT_OK; ++threads) {
        row.threads = threads;
        result = measure_march(&row.result.step, &split, form, threads, speed->options, error);
        row.result.bytes = 8 * (uint64_t)split.tile_count * CPU_SPLIT_WIDTH * 4 * split.link_count;
        if (result == RESULT_OK) speed_add(speed, &row);
    }
    cpu_split_destroy(&split);
    return result;
}

static bool are_alike(const Strands *strands)
{
    for (uint32_t s = 0; s < strands->strand_count; ++s)
        if (strands->first[s + 1] - strands->first[s] != strands->first[1]) return false;
    return true;
}

static Result use_hair(Speed *speed, const SpeedSubject *subject, Error *error)
{
    bool plain = strcmp(subject->method.algo, "split") == 0 && !*subject->method.variant &&
                 !*subject->method.settings;
    if (!plain || !are_alike(subject->strands)) return RESULT_OK;
    Result result = measure_form(speed, subject, CPU_SPLIT_SCALAR, error);
    return result == RESULT_OK ? measure_form(speed, subject, CPU_SPLIT_LANES, error) : result;
}

Result cpu_run_split(Speed *speed, Error *error)
{
    return speed_for_each(speed, use_hair, error);
}
