// SPDX-License-Identifier: MIT
// Short steps converge, at any distance from the origin: what a step adds to a position or a
// velocity must not get lost in the rounding of coordinates.
#include "support/twin.h"

#include <cglm/cglm.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { N = 16, FRAMES = 12 };
static const double LENGTH = 0.21;
static const Vec FAR = {10, 10, -10}, NEAR = {0, 0, 0};

// The head at time t: it nods about `middle`, where the root is.
static void nod(SolverStep *step, const Vec middle, double t)
{
    HeadPose *head = &step->head;
    vec3 away;
    glm_quatv(head->rotation, (float)(0.5 * sin(6 * t)), (vec3){0, 0.6f, 0.8f});
    for (int k = 0; k < 3; ++k) away[k] = (float)-middle[k];
    glm_quat_rotatev(head->rotation, away, head->translation);
    for (int k = 0; k < 3; ++k) head->translation[k] += (float)middle[k];
    step_set_move(step, (float[]){(float)middle[0], (float)middle[1], (float)middle[2]}, (Vec){0});
}

// Where a strand is after FRAMES frames of 1/60 s with `substeps` steps each, relative to `middle`,
// where it begins.
static void run(const char *algo, const char *variant, const Vec middle, int substeps, bool nods,
                Vec *q)
{
    Vec start[N];
    HairFixture fixture;
    twin_make_curl(start, N, 0, 2);
    for (int j = N - 1; j >= 0; --j)
        for (int k = 0; k < 3; ++k) start[j][k] += middle[k] - start[0][k];
    fixture_create(&fixture, (const Vec *)start, 1, N, algo, variant, 0.3f, 1);
    fixture.step.dt = 1.0 / 60 / substeps;
    for (int i = 0; i < 4; ++i) fixture.step.wind[i][0] = 2;
    for (int i = 1; i <= FRAMES * substeps; ++i) {
        if (nods) nod(&fixture.step, middle, i * fixture.step.dt);
        fixture_step(&fixture);
    }
    twin_read_strand(&fixture, 0, q);
    fixture_destroy(&fixture);
    for (int j = 0; j < N; ++j)
        for (int k = 0; k < 3; ++k) q[j][k] -= middle[k];
}

// A method of order p has the error c/n^p with n sub-steps. So 1,000 differ from 100 by
// (1 - 10^-p)/(2^p - 1) of what 100 differ from 50. `split` has an order of 1/3, the others at
// least
// 1. Beside that, positions are rounded by up to 2^-24 of the length in each of 12,000 steps.
static void converges(const char *algo, const char *variant, bool nods)
{
    Vec coarse[N], fine[N], finest[N];
    run(algo, variant, NEAR, 50, nods, coarse);
    run(algo, variant, NEAR, 100, nods, fine);
    run(algo, variant, FAR, 1000, nods, finest);
    double order = strcmp(algo, "split") == 0 ? 1.0 / 3 : 1,
           share = (1 - pow(10, -order)) / (pow(2, order) - 1),
           step = twin_rms((const Vec *)coarse, (const Vec *)fine, N, LENGTH),
           off = twin_rms((const Vec *)finest, (const Vec *)fine, N, LENGTH);
    if (!(off < share * step + FRAMES * 1000 * 0x1p-24))
        fail_msg(
            "%s %s%s: 1,000 sub-steps differ from 100 by %.2g of the length, 100 from 50 by %.2g",
            algo, variant, nods ? ", nodding" : "", off, step);
}

// Published rules that docs/solvers.md says do not converge.
static bool may_converge(const char *variant)
{
    return strcmp(variant, "thesis") != 0 && strcmp(variant, "tressfx4") != 0;
}

static void a_thousand_substeps_converge_far_from_the_origin(void **state)
{
    (void)state;
    for (const SolverType *const *type = SOLVER_TYPES; *type; ++type)
        for (int v = 0; !solver_is_static(*type) && (v == 0 || (*type)->variants[v]); ++v) {
            const char *variant = (*type)->variants[v] ? (*type)->variants[v] : "";
            for (int nods = 0; nods < 2 && may_converge(variant); ++nods)
                converges((*type)->name, variant, nods);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_thousand_substeps_converge_far_from_the_origin),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
