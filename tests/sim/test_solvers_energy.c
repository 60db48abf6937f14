// SPDX-License-Identifier: MIT
// Energy and lengths of every solver in long runs with gravity as the only force.
#include "support/every_solver.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const double ALLOWED_RISE = 0.01; // relative to what falling can release

enum { LONG_MOST = 64, LONG_KINDS = 2 };
static const int LONG_COUNTS[] = {4, 16, 64};
enum { LONG_SIZES = sizeof LONG_COUNTS / sizeof *LONG_COUNTS };

typedef struct LongRun {
    HairFixture fixture;
    Vec start[LONG_SIZES][LONG_KINDS][LONG_MOST];
    Vec before[LONG_SIZES][LONG_KINDS][LONG_MOST];
    // the solver's own velocities, or displacements / dt
    Vec v[LONG_SIZES][LONG_KINDS][LONG_MOST];
} LongRun;

// For each vertex count, a straight strand held horizontally and a curl.
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
    // energy is that of the strand without stretch correction
    run->fixture.params.stretch_drawn = true;
    run->fixture.step.dt = 1 / per_second;
    strands_destroy(&strands);
}

// Positions of all strands; batches are in the order of vertex counts.
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

// Whether a solver stores velocities of the strand that is drawn.
static bool has_velocities(const SolverType *type)
{
    return !solver_is_static(type) && strcmp(type->name, "split") != 0;
}

// Duration of the sub-steps that the solver takes.
static double small_step(const HairFixture *fixture)
{
    return fixture->step.dt / solver_substeps(&fixture->solver, &fixture->step);
}

// The velocities after a step: the solver's own if it stores them.
static void long_run_velocities(LongRun *run, Vec now[LONG_SIZES][LONG_KINDS][LONG_MOST])
{
    const Solver *solver = &run->fixture.solver;
    for (uint32_t i = 0; i < LONG_SIZES; ++i) {
        const HairBatch *batch = &run->fixture.hair.batches[i];
        float(*own)[4] = NULL;
        if (has_velocities(solver->type)) {
            SolverBuffer buffers[SOLVER_MAX_BUFFERS];
            solver_buffers(solver, i, buffers);
            assert_int_equal(buffers[1].kind, SOLVER_VELOCITIES);
            const GpuBuffer *buffer = buffers[1].buffer;
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

// Whether a solver's velocities belong to the step's end, by the midpoint rule; otherwise they
// belong to its middle.
static bool ends_with_velocities(const SolverType *type)
{
    return strcmp(type->name, "hybrid") == 0 || strcmp(type->name, "emulation") == 0 ||
           strcmp(type->name, "rod") == 0;
}

// Kinetic and potential energy minus the start's energy, relative to what the strand can lose: 0 at
// the start, -1 when it hangs at rest. `v` are the velocities of the last dt seconds that led to
// the positions `q`; dt = 0: the velocities at `q`. `tip`: the mass of the tip; the others have 1.
static double energy(const Vec *start, const Vec *q, const Vec *v, double dt, int n, double tip)
{
    const double g = 9.81;
    double sum = 0, budget = 0, length = 0;
    for (int j = 1; j < n; ++j) {
        Vec segment;
        vec_add_scaled(start[j], -1, start[j - 1], segment);
        length += vec_norm(segment);
        double mass = j == n - 1 ? tip : 1;
        sum += mass * (vec_dot(v[j], v[j]) / 2 + g * (q[j][1] - v[j][1] * dt / 2 - start[j][1]));
        budget += mass * g * (start[j][1] - start[0][1] + length);
    }
    return sum / budget;
}

// `most`: the largest energy of each size so far.
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
            double e = energy(start, q, (const Vec *)run->v[i][kind], dt, n,
                              strcmp(type->name, "rod") == 0 ? 0.5 : 1);
            double error = every_solver_length_error(start, q, n);
            every_solver_require(isfinite(e), type, variant, "n = %.0f: a position is not finite",
                                 n);
            every_solver_require(error < 1e-5 || !(every_solver_promises(type, variant, n) & RIGID),
                                 type, variant, "a length is off by %.2g", error);
            most[i] = fmax(most[i], e);
        }
}

// Energy is checked every step in the first second, while hair falls, and then 4 times a second.
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
        if (most[i] < ALLOWED_RISE ||
            !(every_solver_promises(type, variant, LONG_COUNTS[i]) & ENERGY))
            continue;
        printf("%s, n = %d at %g Hz, drag %g, style %g: energy rises by %.2g of what could be "
               "lost\n",
               type->name, LONG_COUNTS[i], per_second, (double)drag, (double)style, most[i]);
        ++failures;
    }
    return failures;
}

static int long_failures; // of all solvers, so that all are reported

// TEST_SECONDS=60 runs the one minute for which the documentation states the solvers' figures.
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
    every_solver_run(check_long, 0);
    assert_int_equal(long_failures, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(energy_and_lengths_hold_in_the_long_run),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
