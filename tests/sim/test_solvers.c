// SPDX-License-Identifier: MIT
// Invariants of every solver. Tests of single solvers are in test_solver_<name>.c, energy in
// test_solvers_energy.c, convergence in test_solvers_convergent.c.
#include "formats/strands_read.h"
#include "support/every_solver.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

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
        double error = every_solver_length_error((const Vec *)&start[s * N], (const Vec *)q, N);
        every_solver_require(error < 1e-5, type, variant, "a segment's length is off by %.2g",
                             error);
    }
    fixture_destroy(&fixture);
}

static void lengths_are_kept(void **state)
{
    (void)state;
    every_solver_run(check_lengths, LENGTHS);
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
    every_solver_require(off < 1e-5, type, variant, "hanging hair has moved by %.2g of its length",
                         off);
    fixture_destroy(&fixture);
}

static void hanging_hair_stays_at_rest(void **state)
{
    (void)state;
    every_solver_run(check_rest, REST);
}

// --- Curls at rest.

// Solvers that tremble from frame to frame by more than 1e-4 of the length at 60 Hz, from which
// particle count on, and by how much at most: twice the largest value measured with the curls in
// assets/ with drag 1 and 5/s (docs/solvers.md).
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

// Four of the curls in assets/, with all their vertices (48) or every third (16).
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

// The largest distance a particle moves per frame during the following second, m.
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
        every_solver_require(most < allowed_tremor(type, variant, n), type, variant,
                             "curls at rest move by %.2g of their length a frame", most);
    }
}

static void curls_come_to_rest(void **state)
{
    (void)state;
    every_solver_run(check_tremor, 0);
}

// --- Symmetries. The two runs round differently. Half a second with drag keeps the difference
// below 1e-4 of the length, also in solvers that whip.

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
    every_solver_require(off < 1e-4, type, variant, "a turned scene moves otherwise, by %.2g", off);
    fixture_destroy(&plain);
    fixture_destroy(&other);
}

static void turning_the_whole_scene_turns_the_result(void **state)
{
    (void)state;
    every_solver_run(check_turn, TURN);
}

// Multiplies parameters that are lengths, or accelerations of them, for a scene `scale` times as
// large.
static void scale_params(SectionParams *params, float scale)
{
    params->tressfx_vsp_accel_threshold *= scale;
    params->tressfx_clamp_position_delta *= scale;
    params->spring_angular *= scale;
    params->hair_radius *= scale * scale; // B/(rho A) is in m^4/s^2
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
    every_solver_require(off < 1e-4, type, variant,
                         "a scene 100 times as large moves otherwise, by %.2g", off);
    fixture_destroy(&plain);
    fixture_destroy(&other);
}

static void the_unit_of_length_does_not_matter(void **state)
{
    (void)state;
    every_solver_run(check_unit, UNIT);
}

// --- Strands among other strands.

enum { CROWD = 37, CROWD_N = 12 };

// Fills a crowd and steps it; strand `at` is always the same curl, and the others depend on
// `other`.
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
    every_solver_require(memcmp(a, b, sizeof a) == 0, type, variant,
                         "a strand moves otherwise among other strands, by %.2g of its length",
                         twin_rms((const Vec *)a, (const Vec *)b, CROWD_N, 0.21));
}

static void strands_do_not_depend_on_each_other(void **state)
{
    (void)state;
    every_solver_run(check_neighbours, 0);
}

static void check_order(const SolverType *type, const char *variant)
{
    Vec a[CROWD_N], b[CROWD_N];
    step_crowd(type, variant, 3, 0, a);
    step_crowd(type, variant, CROWD - 1, 0, b);
    every_solver_require(
        memcmp(a, b, sizeof a) == 0, type, variant,
        "a strand moves otherwise in another place of the file, by %.2g of its length",
        twin_rms((const Vec *)a, (const Vec *)b, CROWD_N, 0.21));
}

static void the_order_of_strands_does_not_matter(void **state)
{
    (void)state;
    every_solver_run(check_order, ORDER);
}

// --- Extreme input.

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
                every_solver_require(isfinite(vec_norm(q[j])), type, variant,
                                     "violence %.0f: a position is not finite", (double)v);
        }
        fixture_destroy(&fixture);
    }
}

static void no_finite_input_gives_a_nan(void **state)
{
    (void)state;
    every_solver_run(check_violence, 0);
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
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
