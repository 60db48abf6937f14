// SPDX-License-Identifier: MIT
#include "bench/cpu_split.h"
#include "base/clock.h"
#include "base/parallel.h"
#include "base/simd.h"

#include "glsl/common/shared_math.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

// The rows of a tile of ends: three each for root, tip and velocity, one for the reach.
enum { W = CPU_SPLIT_WIDTH, ROOT = 0, TIP = 3, VELOCITY = 6, REACH = 9, END_ROWS = 10 };
enum { LINK_ROWS = 4, PASSES = 4 };

static const float LOG2_E = 1.44269504f, MAX_EXPONENT = 60;

// --- Setting up.

static void place_strand(CpuSplit *split, const Strands *strands, uint32_t strand, uint32_t slot)
{
    uint32_t n = split->link_count, lane = slot % W;
    const float(*q)[3] = (const float(*)[3])strands->position + strands->first[strand];
    float *link = split->links + (size_t)(slot / W) * n * LINK_ROWS * W + lane;
    float *end = split->ends + (size_t)(slot / W) * END_ROWS * W + lane;
    for (uint32_t j = 0; j < n; ++j, link += LINK_ROWS * W) {
        float l = 0;
        for (int k = 0; k < 3; ++k)
            link[k * W] = q[j + 1][k] - q[j][k], l += link[k * W] * link[k * W];
        l = sqrtf(l);
        for (int k = 0; k < 3; ++k) link[k * W] /= l;
        link[3 * W] = l;
        end[REACH * W] += l;
    }
    for (int k = 0; k < 3; ++k) end[(ROOT + k) * W] = q[0][k], end[(TIP + k) * W] = q[n][k];
}

Result cpu_split_create(CpuSplit *split, const Strands *strands, Error *error)
{
    *split = (CpuSplit){.strand_count = strands->strand_count,
                        .link_count = strands->first[1] - 1,
                        .gravity = {0, -9.81f, 0}};
    for (uint32_t s = 0; s < strands->strand_count; ++s)
        if (strands->first[s + 1] - strands->first[s] != split->link_count + 1)
            return error_set(error, RESULT_USAGE,
                             "part c: strands have different numbers of vertices: expected the "
                             "same number in all");
    split->tile_count = (split->strand_count + W - 1) / W;
    split->links = calloc((size_t)split->tile_count * split->link_count * LINK_ROWS * W, 4);
    split->ends = calloc((size_t)split->tile_count * END_ROWS * W, 4);
    if (!split->links || !split->ends)
        return error_set(error, RESULT_FAILED, "no memory for strands");
    // Copies of the last strand fill the last tile.
    for (uint32_t slot = 0; slot < split->tile_count * W; ++slot)
        place_strand(split, strands, slot < split->strand_count ? slot : split->strand_count - 1,
                     slot);
    return RESULT_OK;
}

void cpu_split_destroy(CpuSplit *split)
{
    free(split->links);
    free(split->ends);
    *split = (CpuSplit){0};
}

void cpu_split_time(CpuSplit *split, double dt, double drag, bool first)
{
    double h = first ? dt / 2 : dt, x = drag * h;
    split->dt = (float)dt;
    split->decay = (float)exp(-x);
    split->gain = (float)(x > 0 ? -expm1(-x) / drag : h);
}

void cpu_split_read(const CpuSplit *split, float (*positions)[3])
{
    uint32_t n = split->link_count;
    for (uint32_t s = 0; s < split->strand_count; ++s) {
        const float *link = split->links + (size_t)(s / W) * n * LINK_ROWS * W + s % W;
        const float *end = split->ends + (size_t)(s / W) * END_ROWS * W + s % W;
        float(*q)[3] = positions + (size_t)s * (n + 1);
        for (int k = 0; k < 3; ++k) q[0][k] = end[(ROOT + k) * W];
        for (uint32_t j = 0; j < n; ++j, link += LINK_ROWS * W)
            for (int k = 0; k < 3; ++k) q[j + 1][k] = q[j][k] + link[3 * W] * link[k * W];
    }
}

// --- One strand: locals as in glsl/sim/split.comp and glsl/sim/tractrix.glsl.

typedef struct Float3 {
    float x, y, z;
} Float3;

SIMD_INLINE float dot(Float3 a, Float3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
SIMD_INLINE Float3 add(Float3 a, float s, Float3 b)
{
    return (Float3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}
SIMD_INLINE Float3 scale(float s, Float3 a)
{
    return (Float3){s * a.x, s * a.y, s * a.z};
}

// One link of the tractrix. simd_max and simd_min compile to one instruction; fmaxf would also have
// to handle NaN.
SIMD_INLINE Float3 turn(Float3 d, float l, Float3 *move, bool inlined)
{
    float ss = simd_max(dot(*move, *move), 1e-36f);
    float inverse = 1 / sqrtf(ss);
    Float3 e = scale(inverse, *move);
    float x = -simd_min(ss * inverse * (LOG2_E / l), MAX_EXPONENT);
    float E = inlined ? SHARED_EXP2(x) : exp2f(x);
    Float3 m = add(d, -1, e);
    float M = dot(m, m), A = 4 * E - M * (1 + E), B = A + 2 * M, D = M + E * E * (4 - M);
    Float3 change = scale((1 - E) / D, add(scale(A, d), -B, e));
    *move = add(*move, l, change);
    return add(d, 1, change);
}

// The point to which the tip is moved, and its new velocity: the tip is a mass on a string of
// length R. `push`: the change of velocity by forces.
SIMD_INLINE Float3 tip_target(Float3 tip, Float3 *velocity, Float3 push, Float3 root, float R,
                              float dt)
{
    Float3 target = add(tip, dt, *velocity), s = add(target, -1, root), r = add(tip, -1, root);
    float ss = dot(s, s), rr = dot(r, r), sr = dot(s, r), excess = ss - R * R;
    Float3 pushed = scale(dt, push), middle = add(s, -0.5f, pushed);
    pushed = add(pushed, -dot(pushed, r) / rr, r);
    middle = add(middle, -dot(middle, r) / rr, r);
    float bent = dot(middle, middle) / (R * R);
    bool swings = excess > 0 && rr > 0.99f * R * R && sr > 0 && bent < 1;
    Float3 turned = add(add(s, -bent / 6, pushed), -dot(pushed, middle) / (3 * R * R), middle);
    if (swings) s = turned, target = add(root, 1, s);
    ss = dot(s, s), sr = dot(s, r), excess = ss - R * R;
    float disc = sr * sr - rr * excess;
    bool taut = rr > 0.99f * R * R && sr > 0 && disc > 0.1f * sr * sr;
    float along = taut ? excess / (sr + sqrtf(simd_max(disc, 0))) : 0;
    Float3 slid = add(s, -along, r);
    slid = scale(R / sqrtf(simd_max(dot(slid, slid), 1e-36f)), slid);
    if (excess > 0) target = add(root, 1, slid);
    *velocity = scale(1 / dt, add(target, -1, tip));
    return target;
}

SIMD_INLINE Float3 load(const float *row)
{
    return (Float3){row[0], row[W], row[2 * W]};
}
SIMD_INLINE void store(float *row, Float3 a)
{
    row[0] = a.x, row[W] = a.y, row[2 * W] = a.z;
}

// Applies forces to the tip and moves it. Returns the vector from the strand's end to the tip.
SIMD_INLINE Float3 begin_strand(const CpuSplit *split, float *end, Float3 span)
{
    Float3 g = {split->gravity[0], split->gravity[1], split->gravity[2]};
    Float3 root = load(end + ROOT * W), tip = load(end + TIP * W);
    Float3 v = add(scale(split->decay, load(end + VELOCITY * W)), split->gain, g);
    Float3 target = tip_target(tip, &v, scale(split->gain, g), root, end[REACH * W], split->dt);
    store(end + TIP * W, add(tip, split->dt, v));
    store(end + VELOCITY * W, v);
    return add(add(target, -1, root), -1, span);
}

// Pulls a link from its end (sign -1) or from its beginning (sign 1).
SIMD_INLINE void pull_link(float *row, float sign, Float3 *move, bool inlined)
{
    store(row, scale(sign, turn(scale(sign, load(row)), row[3 * W], move, inlined)));
}

// Makes the length of a direction 1 with one Newton step, which is enough for rounding errors.
SIMD_INLINE void renormalise(float *row)
{
    Float3 d = load(row);
    store(row, scale(1.5f - 0.5f * dot(d, d), d));
}

static void step_strand(const CpuSplit *split, float *links, float *end)
{
    int n = (int)split->link_count;
    Float3 span = {0, 0, 0};
    for (int j = 0; j < n; ++j)
        span = add(span, links[(j * LINK_ROWS + 3) * W], load(links + j * LINK_ROWS * W));
    Float3 move = begin_strand(split, end, span);
    for (int pass = 0; pass < PASSES; ++pass) {
        for (int i = 0; i < n; ++i) {
            int j = pass % 2 ? i : n - 1 - i;
            pull_link(links + j * LINK_ROWS * W, pass % 2 ? 1 : -1, &move, false);
        }
        move = scale(-1, move);
    }
    for (int j = 0; j < n; ++j) renormalise(links + j * LINK_ROWS * W);
}

// --- W strands at once: the same step with the loop over strands innermost.

SIMD_INLINE void step_tile(const CpuSplit *split, float *links, float *ends)
{
    int n = (int)split->link_count;
    float x[W] = {0}, y[W] = {0}, z[W] = {0};
    for (int j = 0; j < n; ++j)
        for (int k = 0; k < W; ++k) {
            const float *row = links + j * LINK_ROWS * W + k;
            x[k] += row[3 * W] * row[0], y[k] += row[3 * W] * row[W],
                z[k] += row[3 * W] * row[2 * W];
        }
    for (int k = 0; k < W; ++k) {
        Float3 move = begin_strand(split, ends + k, (Float3){x[k], y[k], z[k]});
        x[k] = move.x, y[k] = move.y, z[k] = move.z;
    }
    for (int pass = 0; pass < PASSES; ++pass) {
        float sign = pass % 2 ? 1 : -1;
        for (int i = 0; i < n; ++i) {
            float *row = links + (pass % 2 ? i : n - 1 - i) * LINK_ROWS * W;
            for (int k = 0; k < W; ++k) {
                Float3 move = {x[k], y[k], z[k]};
                pull_link(row + k, sign, &move, true);
                x[k] = move.x, y[k] = move.y, z[k] = move.z;
            }
        }
        for (int k = 0; k < W; ++k) x[k] = -x[k], y[k] = -y[k], z[k] = -z[k];
    }
    for (int j = 0; j < n; ++j)
        for (int k = 0; k < W; ++k) renormalise(links + j * LINK_ROWS * W + k);
}

SIMD_FOR_ANY static void step_tile_baseline(const CpuSplit *split, float *links, float *ends)
{
    step_tile(split, links, ends);
}

SIMD_FOR_AVX2 static void step_tile_avx2(const CpuSplit *split, float *links, float *ends)
{
    step_tile(split, links, ends);
}

const char *cpu_split_lanes(void)
{
    return simd_level() >= SIMD_AVX2 ? "AVX2" : "baseline";
}

void cpu_split_step(CpuSplit *split, CpuSplitForm form, uint32_t first, uint32_t last)
{
    void (*tile)(const CpuSplit *, float *, float *) =
        simd_level() >= SIMD_AVX2 ? step_tile_avx2 : step_tile_baseline;
    for (uint32_t t = first; t < last; ++t) {
        float *links = split->links + (size_t)t * split->link_count * LINK_ROWS * W;
        float *ends = split->ends + (size_t)t * END_ROWS * W;
        if (form == CPU_SPLIT_LANES)
            tile(split, links, ends);
        else
            for (int k = 0; k < W; ++k) step_strand(split, links + k, ends + k);
    }
}

double cpu_split_length(const CpuSplit *split)
{
    return (double)split->ends[REACH * W];
}

// --- Timing.

// Threads that step together: a barrier before and after each step, timed by the first of them.
typedef struct March {
    CpuSplit *split;
    CpuSplitForm form;
    int threads, steps, warm_up;
    double *samples;
    pthread_mutex_t gate; // locked until all threads have been started
    int begun;
    pthread_barrier_t barrier;
} March;

static void *march(void *data)
{
    March *m = data;
    pthread_mutex_lock(&m->gate);
    uint32_t tiles = m->split->tile_count, threads = (uint32_t)m->threads, t = (uint32_t)m->begun++;
    pthread_mutex_unlock(&m->gate);
    for (int i = -m->warm_up; i < m->steps; ++i) {
        double begin = clock_ms();
        pthread_barrier_wait(&m->barrier);
        cpu_split_step(m->split, m->form, tiles * t / threads, tiles * (t + 1) / threads);
        pthread_barrier_wait(&m->barrier);
        if (i >= 0 && t == 0) m->samples[i] = clock_ms() - begin;
    }
    return NULL;
}

// parallel_run does not promise that parts run at the same time, as a barrier needs.
static Result run_threads(March *m, Error *error)
{
    pthread_t threads[PARALLEL_MOST];
    int started = 0, reason = 0;
    pthread_mutex_lock(&m->gate);
    while (started < m->threads && reason == 0) {
        reason = parallel_start(&threads[started], march, m);
        started += reason == 0;
    }
    if (reason) m->steps = m->warm_up = 0;
    pthread_mutex_unlock(&m->gate);
    for (int i = 0; i < started; ++i) pthread_join(threads[i], NULL);
    return reason == 0 ? RESULT_OK
                       : error_set(error, RESULT_FAILED, "cannot start %d threads: %s", m->threads,
                                   strerror(reason));
}

Result cpu_split_time_steps(Times *times, CpuSplit *split, CpuSplitForm form, int threads,
                            int steps, int warm_up, Error *error)
{
    March m = {.split = split,
               .form = form,
               .threads = threads,
               .steps = steps,
               .warm_up = warm_up,
               .gate = PTHREAD_MUTEX_INITIALIZER};
    m.samples = calloc((size_t)steps, sizeof *m.samples);
    if (!m.samples) return error_set(error, RESULT_FAILED, "no memory for samples");
    pthread_barrier_init(&m.barrier, NULL, (unsigned)threads);
    Result result = run_threads(&m, error);
    pthread_barrier_destroy(&m.barrier);
    if (result == RESULT_OK) *times = table_times(m.samples, steps);
    free(m.samples);
    return result;
}

enum { ELEMENTS = 16 << 20, RUNS = 12 }; // 64 MiB for each array

typedef struct Arrays {
    float *a, *b, *c;
    int parts;
    bool filled;
} Arrays;

static void add_arrays(void *data, int part)
{
    const Arrays *arrays = data;
    size_t first = (size_t)part * ELEMENTS / (size_t)arrays->parts,
           last = (size_t)(part + 1) * ELEMENTS / (size_t)arrays->parts;
    for (size_t i = first; i < last && !arrays->filled; ++i)
        arrays->b[i] = (float)i, arrays->c[i] = 1;
    for (size_t i = first; i < last; ++i) arrays->a[i] = arrays->b[i] + 3 * arrays->c[i];
}

Result cpu_split_time_memory(Times *times, double *bytes, int *threads, Error *error)
{
    size_t size = ELEMENTS * sizeof(float);
    double samples[RUNS];
    Arrays arrays = {malloc(size), malloc(size), malloc(size), parallel_threads(), false};
    bool good = arrays.a && arrays.b && arrays.c;
    if (good) {
        parallel_run(arrays.parts, add_arrays, &arrays);
        arrays.filled = true;
        for (int i = 0; i < RUNS; ++i) {
            double begin = clock_ms();
            parallel_run(arrays.parts, add_arrays, &arrays);
            samples[i] = clock_ms() - begin;
        }
        *times = table_times(samples, RUNS);
    }
    *bytes = 3.0 * (double)size, *threads = arrays.parts;
    free(arrays.a);
    free(arrays.b);
    free(arrays.c);
    return good ? RESULT_OK : error_set(error, RESULT_FAILED, "no memory to measure it");
}
