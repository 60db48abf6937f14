// SPDX-License-Identifier: MIT
// What must hold for every solver that is in the table, whatever its method. A solver's own tests
// are in test_solver_<name>.c.
#include "particle_solver.h"
#include "strands_read.h"
#include "twin.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// What can be promised ...
enum {
    LENGTHS = 1, // segments as long as in the style
    REST = 2,    // hair that hangs straight down stays so
    ENERGY = 4,  // never more than at the start
    UNIT = 8,    // a scene in centimetres moves like one in metres
    ORDER = 16,  // strands move alike wherever they stand in the file
    TURN = 32,   // a turned scene moves like the scene
    RIGID = 64,  // not only what is drawn has the style's lengths, but what is simulated
};

// ... and who does not, from how many particles a strand on, and why. `variant` NULL: all of them.
static const struct {
    const char *algo, *variant;
    unsigned lacks;
    int from;
    const char *why;
} EXCEPTIONS[] = {
    {"split", NULL, ENERGY, 0, "only its tip has mass (test_solver_split): the strand follows"},
    {"emulation", "thesis", REST | ENERGY | TURN, 0, "unstable without much drag, as published"},
    {"spring", NULL, RIGID, 0, "its segments are springs"},
    {"rope", NULL, RIGID, 0, "its iterations leave it stretched"},
    {"tressfx", "tressfx4", LENGTHS | REST | RIGID, 0,
     "two passes leave it stretched under gravity"},
};

// Who gains more energy than 1 % of what can be lost by falling, from how many particles on and by
// how much at most, as measured.
static const struct {
    const char *algo;
    int from;
    double most;
    const char *why;
} RISES[] = {
    {"dftl", 64, 0.12, "its corrections go into velocities, not into what is drawn"},
    {"dftl", 16, 0.04, "so do they here, at 30 Hz"},
};

static double allowed_rise(const SolverType *type, int n)
{
    for (size_t i = 0; i < sizeof RISES / sizeof *RISES; ++i)
        if (strcmp(RISES[i].algo, type->name) == 0 && n >= RISES[i].from) return RISES[i].most;
    return 0.01;
}

static unsigned promises(const SolverType *type, const char *variant, int n)
{
    unsigned all = LENGTHS | REST | ENERGY | UNIT | ORDER | TURN | RIGID;
    for (size_t i = 0; i < sizeof EXCEPTIONS / sizeof *EXCEPTIONS; ++i)
        if (strcmp(EXCEPTIONS[i].algo, type->name) == 0 && n >= EXCEPTIONS[i].from &&
            (!EXCEPTIONS[i].variant || strcmp(EXCEPTIONS[i].variant, variant) == 0))
            all &= ~EXCEPTIONS[i].lacks;
    return all;
}

typedef void (*Check)(const SolverType *type, const char *variant);

// Runs `check` for each solver that steps (TEST_ALGO: only that one) and each of its variants that
// promises `needed` for short strands.
static void for_each(Check check, unsigned needed)
{
    const char *only = getenv("TEST_ALGO");
    for (const SolverType *const *type = SOLVER_TYPES; *type; ++type)
        for (int v = 0; (*type)->calls->step && (v == 0 || (*type)->variants[v]); ++v) {
            const char *variant = (*type)->variants[v] ? (*type)->variants[v] : "";
            if (only && strcmp(only, (*type)->name) != 0) continue;
            if ((promises(*type, variant, 0) & needed) == needed) check(*type, variant);
        }
}

static void require(bool holds, const SolverType *type, const char *variant, const char *format,
                    double value)
{
    char text[128];
    snprintf(text, sizeof text, format, value);
    if (!holds) fail_msg("%s %s: %s", type->name, variant, text);
}

// Greatest error of a length, less what the rounding of stored positions explains: each coordinate
// is off by at most 2^-24 of its size, so a difference by twice that, a length by sqrt(3) times as
// much.
static double length_error(const Vec *style, const Vec *q, int n)
{
    double worst = 0;
    for (int j = 1; j < n; ++j) {
        Vec before, now;
        double size = 0;
        for (int k = 0; k < 3; ++k) {
            before[k] = (double)(float)style[j][k] - (double)(float)style[j - 1][k];
            now[k] = q[j][k] - q[j - 1][k];
            size = fmax(size, fabs(q[j][k]));
        }
        double length = vec_norm(before), rounding = 2 * 1.8 * 0x1p-24 * size;
        worst = fmax(worst, (fabs(vec_norm(now) - length) - rounding) / length);
    }
    return worst;
}

// --- Lengths, rest.

static void check_lengths(const SolverType *type, const char *variant)
{
    enum { N = 16 };
    Vec start[3 * N], q[N];
    HairFixture fixture;
    for (int s = 0; s < 3; ++s) twin_make_curl(&start[s * N], N, 0.01 * s, 1 + s);
    fixture_create(&fixture, (const Vec *)start, 3, N, type->name, variant, 0, 1);
    for (int i = 1; i <= 120; ++i) {
        fixture.step.head.translation[0] = (float)(0.03 * sin(0.2 * i));
        fixture_step(&fixture);
    }
    for (int s = 0; s < 3; ++s) {
        twin_read_strand(&fixture, s, q);
        double error = length_error((const Vec *)&start[s * N], (const Vec *)q, N);
        require(error < 1e-5, type, variant, "a segment's length is off by %.2g", error);
    }
    fixture_destroy(&fixture);
}

static void lengths_are_kept(void **state)
{
    (void)state;
    for_each(check_lengths, LENGTHS);
}

static void check_rest(const SolverType *type, const char *variant)
{
    enum { N = 16 };
    Vec start[N], q[N];
    HairFixture fixture;
    for (int j = 0; j < N; ++j) start[j][0] = 0.1, start[j][1] = 0.3 - 0.016 * j, start[j][2] = 0;
    fixture_create(&fixture, (const Vec *)start, 1, N, type->name, variant, 0, 1);
    for (int i = 0; i < 300; ++i) fixture_step(&fixture);
    twin_read_strand(&fixture, 0, q);
    double off = twin_rms((const Vec *)q, (const Vec *)start, N, 0.24);
    require(off < 1e-5, type, variant, "hanging hair has moved by %.2g of its length", off);
    fixture_destroy(&fixture);
}

static void hanging_hair_stays_at_rest(void **state)
{
    (void)state;
    for_each(check_rest, REST);
}

// --- Curls that have come to rest.

// Who trembles from frame to frame by more than 1e-4 of the length at 60 Hz, from how many
// particles on and by how much at most: twice the most that was measured over the curls in assets/
// with drag 1 and 5/s (docs/solvers.md).
static const struct {
    const char *algo, *variant;
    int from;
    double most;
} TREMORS[] = {
    {"split", "thesis", 16, 3e-4},
    {"emulation", "thesis", 16, 1},
    {"emulation", "projected", 48, 8e-3},
    {"hybrid", "", 48, 8e-3},
    {"chain", "", 48, 0.02},
    {"chain", "", 16, 3e-3},
    {"tressfx", "steady", 48, 0.04},
};

static double allowed_tremor(const SolverType *type, const char *variant, int n)
{
    for (size_t i = 0; i < sizeof TREMORS / sizeof *TREMORS; ++i)
        if (strcmp(TREMORS[i].algo, type->name) == 0 && n >= TREMORS[i].from &&
            strcmp(TREMORS[i].variant, variant) == 0)
            return TREMORS[i].most;
    return 1e-4;
}

enum { CURLS = 4, CURL_MOST = 48 };

// Four of the curls in assets/, by every vertex (48) or every third (16).
static void read_curls(Vec *q, int n)
{
    const StrandsReadOptions options = {.unit = 1};
    Error error;
    Strands strands = {0};
    if (strands_read(&strands, "assets/curls.tfx", &options, NULL, &error) != RESULT_OK)
        fail_msg("%s", error.text);
    for (uint32_t s = 0; s < CURLS; ++s) {
        uint32_t root = strands.first[s * strands.strand_count / CURLS];
        for (uint32_t j = 0; j < (uint32_t)n; ++j)
            for (int k = 0; k < 3; ++k)
                q[s * (uint32_t)n + j][k] =
                    (double)strands.position[root + j * (CURL_MOST / (uint32_t)n)][k];
    }
    strands_destroy(&strands);
}

// The farthest that a particle goes in a frame of the second that follows, in metres.
static double find_tremor(HairFixture *fixture)
{
    const HairBatch *batch = &fixture->hair.batches[0];
    double most = 0;
    float(*before)[4] = fixture_positions(fixture, 0);
    for (int i = 0; i < 60; ++i) {
        fixture_step(fixture);
        float(*now)[4] = fixture_positions(fixture, 0);
        for (uint32_t s = 0; s < CURLS; ++s)
            for (uint32_t j = 0; j < batch->vertex_count; ++j) {
                uint32_t at = hair_address(batch, s, j);
                Vec moved;
                for (int k = 0; k < 3; ++k) moved[k] = (double)now[at][k] - (double)before[at][k];
                most = fmax(most, vec_norm(moved));
            }
        free(before);
        before = now;
    }
    free(before);
    return most;
}

static void check_tremor(const SolverType *type, const char *variant)
{
    for (int n = 16; n <= CURL_MOST; n *= 3) {
        static Vec start[CURLS * CURL_MOST];
        HairFixture fixture;
        read_curls(start, n);
        fixture_create(&fixture, (const Vec *)start, CURLS, n, type->name, variant, 0.5f, 5);
        for (int i = 0; i < 480; ++i) fixture_step(&fixture);
        double most = find_tremor(&fixture) / 0.3;
        fixture_destroy(&fixture);
        printf("%s %s, n = %d: moves by %.2g of its length a frame\n", type->name, variant, n,
               most);
        require(most < allowed_tremor(type, variant, n), type, variant,
                "curls at rest move by %.2g of their length a frame", most);
    }
}

static void curls_come_to_rest(void **state)
{
    (void)state;
    for_each(check_tremor, 0);
}

// --- Symmetries. Rounding differs between the two runs; half a second with drag keeps what grows
// from it below 1e-4 of the length, in solvers that whip too.

enum { SYMMETRY_STEPS = 30 };

static void check_turn(const SolverType *type, const char *variant)
{
    enum { N = 16 };
    const double c = cos(0.5235987756), s = sin(0.5235987756);
    Vec start[N], turned[N], a[N], b[N];
    HairFixture plain, other;
    twin_make_curl(start, N, 0, 2);
    for (int j = 0; j < N; ++j)
        turned[j][0] = c * start[j][0] - s * start[j][1],
        turned[j][1] = s * start[j][0] + c * start[j][1], turned[j][2] = start[j][2];
    fixture_create(&plain, (const Vec *)start, 1, N, type->name, variant, 0.4f, 4);
    fixture_create(&other, (const Vec *)turned, 1, N, type->name, variant, 0.4f, 4);
    other.step.gravity[0] = (float)(9.81 * s), other.step.gravity[1] = (float)(-9.81 * c);
    for (int i = 0; i < SYMMETRY_STEPS; ++i) fixture_step(&plain), fixture_step(&other);
    twin_read_strand(&plain, 0, a);
    twin_read_strand(&other, 0, b);
    for (int j = 0; j < N; ++j) {
        Vec r = {c * a[j][0] - s * a[j][1], s * a[j][0] + c * a[j][1], a[j][2]};
        memcpy(a[j], r, sizeof r);
    }
    double off = twin_rms((const Vec *)a, (const Vec *)b, N, 0.21);
    require(off < 1e-4, type, variant, "a turned scene moves otherwise, by %.2g", off);
    fixture_destroy(&plain);
    fixture_destroy(&other);
}

static void turning_the_whole_scene_turns_the_result(void **state)
{
    (void)state;
    for_each(check_turn, TURN);
}

// Parameters that are lengths, or accelerations of them, in a scene that is `scale` times as large.
static void scale_params(SectionParams *params, float scale)
{
    params->tressfx_vsp_accel_threshold *= scale;
    params->tressfx_clamp_position_delta *= scale;
    params->spring_angular *= scale;
}

static void check_unit(const SolverType *type, const char *variant)
{
    enum { N = 16 };
    const double scale = 100;
    Vec start[N], larger[N], a[N], b[N];
    HairFixture plain, other;
    twin_make_curl(start, N, 0, 2);
    for (int j = 0; j < N; ++j)
        for (int k = 0; k < 3; ++k) larger[j][k] = scale * start[j][k];
    fixture_create(&plain, (const Vec *)start, 1, N, type->name, variant, 0.4f, 4);
    fixture_create(&other, (const Vec *)larger, 1, N, type->name, variant, 0.4f, 4);
    scale_params(&other.params, (float)scale);
    other.step.gravity[1] *= (float)scale;
    for (int i = 0; i < SYMMETRY_STEPS; ++i) fixture_step(&plain), fixture_step(&other);
    twin_read_strand(&plain, 0, a);
    twin_read_strand(&other, 0, b);
    for (int j = 0; j < N; ++j)
        for (int k = 0; k < 3; ++k) b[j][k] /= scale;
    double off = twin_rms((const Vec *)a, (const Vec *)b, N, 0.21);
    require(off < 1e-4, type, variant, "a scene 100 times as large moves otherwise, by %.2g", off);
    fixture_destroy(&plain);
    fixture_destroy(&other);
}

static void the_unit_of_length_does_not_matter(void **state)
{
    (void)state;
    for_each(check_unit, UNIT);
}

// --- Strands among others.

enum { CROWD = 37, CROWD_N = 12 };

// Fills a crowd and steps it; strand `at` is always the same curl, the others come from `other`.
static void step_crowd(const SolverType *type, const char *variant, int at, int other, Vec *q)
{
    static Vec start[CROWD * CROWD_N];
    HairFixture fixture;
    for (int s = 0; s < CROWD; ++s)
        twin_make_curl(&start[s * CROWD_N], CROWD_N, s == at ? 0 : 0.01 * (s + other),
                       s == at ? 2 : 1 + (s + other) % 7);
    fixture_create(&fixture, (const Vec *)start, CROWD, CROWD_N, type->name, variant, 0.3f, 1);
    for (int i = 0; i < 40; ++i) fixture_step(&fixture);
    twin_read_strand(&fixture, at, q);
    fixture_destroy(&fixture);
}

static void check_neighbours(const SolverType *type, const char *variant)
{
    Vec a[CROWD_N], b[CROWD_N];
    step_crowd(type, variant, 21, 0, a);
    step_crowd(type, variant, 21, 5, b);
    require(memcmp(a, b, sizeof a) == 0, type, variant,
            "a strand moves otherwise among other strands, by %.2g of its length",
            twin_rms((const Vec *)a, (const Vec *)b, CROWD_N, 0.21));
}

static void strands_do_not_depend_on_each_other(void **state)
{
    (void)state;
    for_each(check_neighbours, 0);
}

static void check_order(const SolverType *type, const char *variant)
{
    Vec a[CROWD_N], b[CROWD_N];
    step_crowd(type, variant, 3, 0, a);
    step_crowd(type, variant, CROWD - 1, 0, b);
    require(memcmp(a, b, sizeof a) == 0, type, variant,
            "a strand moves otherwise in another place of the file, by %.2g of its length",
            twin_rms((const Vec *)a, (const Vec *)b, CROWD_N, 0.21));
}

static void the_order_of_strands_does_not_matter(void **state)
{
    (void)state;
    for_each(check_order, ORDER);
}

// --- Violence.

static void check_violence(const SolverType *type, const char *variant)
{
    // gravity, wind, head jump (m), drag
    const float violence[][4] = {
        {1e6f, 0, 0, 0},      {0, 1e6f, 0, 1e6f}, {-9.81f, 0, 1e3f, 0},
        {-9.81f, 0, 1e8f, 1}, {0, 0, 1e-30f, 0},  {1e6f, 1e6f, 1e6f, 1e-6f},
    };
    enum { N = 24, COUNT = 4 };
    static Vec start[COUNT * N];
    for (int s = 0; s < COUNT; ++s) twin_make_curl(&start[s * N], N, 0.01 * s, s);
    for (size_t v = 0; v < sizeof violence / sizeof *violence; ++v) {
        HairFixture fixture;
        fixture_create(&fixture, (const Vec *)start, COUNT, N, type->name, variant, 0.5f,
                       violence[v][3]);
        fixture.step.gravity[1] = violence[v][0];
        for (int i = 0; i < 4; ++i) fixture.step.wind[i][0] = violence[v][1];
        for (int i = 0; i < 20; ++i) {
            fixture.step.head.translation[1] = i % 2 ? violence[v][2] : 0;
            fixture_step(&fixture);
        }
        for (int s = 0; s < COUNT; ++s) {
            Vec q[N];
            twin_read_strand(&fixture, s, q);
            for (int j = 0; j < N; ++j)
                require(isfinite(vec_norm(q[j])), type, variant,
                        "violence %.0f: a position is not finite", (double)v);
        }
        fixture_destroy(&fixture);
    }
}

static void no_finite_input_gives_a_nan(void **state)
{
    (void)state;
    for_each(check_violence, 0);
}

// --- A long run without anything that moves the hair but gravity.

enum { LONG_MOST = 64, LONG_KINDS = 2 };
static const int LONG_COUNTS[] = {4, 16, 64};
enum { LONG_SIZES = sizeof LONG_COUNTS / sizeof *LONG_COUNTS };

typedef struct LongRun {
    HairFixture fixture;
    Vec start[LONG_SIZES][LONG_KINDS][LONG_MOST];
    Vec before[LONG_SIZES][LONG_KINDS][LONG_MOST];
    Vec v[LONG_SIZES][LONG_KINDS]
         [LONG_MOST]; // the solver's own velocities; else displacements / dt
} LongRun;

// Of each vertex count a straight strand held horizontally and a curl.
static void long_run_create(LongRun *run, const SolverType *type, double per_second, float style,
                            float drag)
{
    Strands strands;
    uint32_t count = LONG_SIZES * LONG_KINDS, vertices = 0, at = 0;
    for (int i = 0; i < LONG_SIZES; ++i) vertices += LONG_KINDS * (uint32_t)LONG_COUNTS[i];
    assert_int_equal(strands_create(&strands, count, vertices, NULL), RESULT_OK);
    for (int i = 0; i < LONG_SIZES; ++i)
        for (int kind = 0; kind < LONG_KINDS; ++kind) {
            Vec *q = run->start[i][kind];
            strands.first[i * LONG_KINDS + kind] = at;
            twin_make_curl(q, LONG_COUNTS[i], 0, 1);
            for (int j = 0; j < LONG_COUNTS[i]; ++j, ++at)
                for (int k = 0; k < 3; ++k) {
                    if (kind == 0) q[j][k] = k == 0 ? 0.25 * j / (LONG_COUNTS[i] - 1) : 0;
                    q[j][k] = (double)(strands.position[at][k] = (float)q[j][k]);
                }
        }
    strands.first[count] = at;
    fixture_create_strands(&run->fixture, &strands, type->name, "", style, drag);
    run->fixture.params.stretch_drawn = true; // the strand that has the energy
    run->fixture.step.dt = 1 / per_second;
    strands_destroy(&strands);
}

// Positions of all strands; batches lie in the order of vertex counts.
static void long_run_read(LongRun *run, Vec positions[LONG_SIZES][LONG_KINDS][LONG_MOST])
{
    for (uint32_t i = 0; i < LONG_SIZES; ++i) {
        const HairBatch *batch = &run->fixture.hair.batches[i];
        float(*read)[4] = fixture_positions(&run->fixture, i);
        for (uint32_t kind = 0; kind < LONG_KINDS; ++kind)
            for (uint32_t j = 0; j < batch->vertex_count; ++j)
                for (int k = 0; k < 3; ++k)
                    positions[i][kind][j][k] = (double)read[hair_address(batch, kind, j)][k];
        free(read);
    }
}

// Whether a solver's own velocities are those of its strand. Those of dftl also hold the
// corrections that are to come: at 60 Hz and at rest 3 m/s in a strand of 64.
static bool has_velocities(const SolverType *type)
{
    return type->calls == &PARTICLE_SOLVER && strcmp(type->name, "dftl") != 0;
}

// Seconds of the steps that the solver really takes.
static double small_step(const HairFixture *fixture)
{
    const ParticleRecipe *recipe = fixture->solver.type->recipes[0];
    int count = recipe && recipe->substeps
                    ? recipe->substeps(&fixture->step, &fixture->params, &fixture->hair)
                    : 1;
    return fixture->step.dt / count;
}

// The velocities that a step has led to: the solver's own where it keeps them.
static void long_run_velocities(LongRun *run, Vec now[LONG_SIZES][LONG_KINDS][LONG_MOST])
{
    const Solver *solver = &run->fixture.solver;
    for (uint32_t i = 0; i < LONG_SIZES; ++i) {
        const HairBatch *batch = &run->fixture.hair.batches[i];
        float(*own)[4] = NULL;
        if (has_velocities(solver->type)) {
            const GpuBuffer *buffer = particle_solver_velocities(solver->state, i);
            own = malloc((size_t)buffer->size);
            assert_non_null(own);
            glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer->buffer);
            glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)buffer->size, own);
        }
        for (uint32_t kind = 0; kind < LONG_KINDS; ++kind)
            for (uint32_t j = 1; j < batch->vertex_count; ++j)
                for (int k = 0; k < 3; ++k)
                    run->v[i][kind][j][k] =
                        own ? (double)own[hair_address(batch, kind, j)][k]
                            : (now[i][kind][j][k] - run->before[i][kind][j][k]) /
                                  run->fixture.step.dt;
        free(own);
    }
}

// Whether a solver's velocities are those at a step's end, by the midpoint rule; else they lie in
// the middle of the way that led there.
static bool ends_with_velocities(const SolverType *type)
{
    return strcmp(type->name, "hybrid") == 0 || strcmp(type->name, "emulation") == 0;
}

// Kinetic and potential energy over what the strand could lose, less what it had: 0 at the start,
// -1 when it hangs at rest. `v` are the velocities of the last dt seconds, `q` where they led to;
// dt = 0: the velocities there.
static double energy(const Vec *start, const Vec *q, const Vec *v, double dt, int n)
{
    const double g = 9.81;
    double sum = 0, budget = 0, length = 0;
    for (int j = 1; j < n; ++j) {
        Vec segment;
        vec_add_scaled(start[j], -1, start[j - 1], segment);
        length += vec_norm(segment);
        sum += vec_dot(v[j], v[j]) / 2 + g * (q[j][1] - v[j][1] * dt / 2 - start[j][1]);
        budget += g * (start[j][1] - start[0][1] + length);
    }
    return sum / budget;
}

// `most`: the greatest energy of each size so far.
static void check_frame(LongRun *run, const SolverType *type, double most[LONG_SIZES])
{
    static Vec now[LONG_SIZES][LONG_KINDS][LONG_MOST];
    const char *variant = type->variants[0] ? type->variants[0] : "";
    long_run_read(run, now);
    long_run_velocities(run, now);
    for (int i = 0; i < LONG_SIZES; ++i)
        for (int kind = 0; kind < LONG_KINDS; ++kind) {
            const Vec *start = (const Vec *)run->start[i][kind], *q = (const Vec *)now[i][kind];
            int n = LONG_COUNTS[i];
            double dt = ends_with_velocities(type) ? 0 : small_step(&run->fixture);
            double e = energy(start, q, (const Vec *)run->v[i][kind], dt, n);
            double error = length_error(start, q, n);
            require(isfinite(e), type, variant, "n = %.0f: a position is not finite", n);
            require(error < 1e-5 || !(promises(type, variant, n) & RIGID), type, variant,
                    "a length is off by %.2g", error);
            most[i] = fmax(most[i], e);
        }
}

// Energy is looked at every step in the first second, when hair falls, and 4 times a second then.
static int check_run(const SolverType *type, double per_second, float style, float drag,
                     double seconds)
{
    static LongRun run;
    double most[LONG_SIZES] = {-1, -1, -1};
    int failures = 0;
    long_run_create(&run, type, per_second, style, drag);
    int steps = (int)(seconds * per_second), sparse = (int)(per_second / 4);
    memcpy(run.before, run.start, sizeof run.before);
    for (int i = 1; i <= steps; ++i) {
        bool look = i <= (int)per_second || i % sparse == 0;
        if (look && i > 1) long_run_read(&run, run.before);
        fixture_step(&run.fixture);
        if (look) check_frame(&run, type, most);
    }
    fixture_destroy(&run.fixture);
    const char *variant = type->variants[0] ? type->variants[0] : "";
    for (int i = 0; i < LONG_SIZES; ++i) {
        if (most[i] < allowed_rise(type, LONG_COUNTS[i]) ||
            !(promises(type, variant, LONG_COUNTS[i]) & ENERGY))
            continue;
        printf("%s, n = %d at %g Hz, drag %g, style %g: energy rises by %.2g of what could be "
               "lost\n",
               type->name, LONG_COUNTS[i], per_second, (double)drag, (double)style, most[i]);
        ++failures;
    }
    return failures;
}

static int long_failures; // of all solvers, so that all are told

// TEST_SECONDS=60 makes it the minute that the solvers' figures are stated for.
static void check_long(const SolverType *type, const char *variant)
{
    const char *asked = getenv("TEST_SECONDS");
    int failures = 0;
    if (type->variants[0] && strcmp(variant, type->variants[0]) != 0) return;
    for (double per_second = 30; per_second <= 240; per_second *= 2)
        for (int drag = 0; drag < 2; ++drag)
            for (int styled = 0; styled < 2; ++styled)
                failures += check_run(type, per_second, styled ? 0.5f : 0, (float)drag,
                                      asked ? strtod(asked, NULL) : 240 / per_second);
    long_failures += failures;
}

static void energy_and_lengths_hold_in_the_long_run(void **state)
{
    (void)state;
    long_failures = 0;
    for_each(check_long, 0);
    assert_int_equal(long_failures, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lengths_are_kept),
        cmocka_unit_test(hanging_hair_stays_at_rest),
        cmocka_unit_test(curls_come_to_rest),
        cmocka_unit_test(turning_the_whole_scene_turns_the_result),
        cmocka_unit_test(the_unit_of_length_does_not_matter),
        cmocka_unit_test(strands_do_not_depend_on_each_other),
        cmocka_unit_test(the_order_of_strands_does_not_matter),
        cmocka_unit_test(no_finite_input_gives_a_nan),
        cmocka_unit_test(energy_and_lengths_hold_in_the_long_run),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
