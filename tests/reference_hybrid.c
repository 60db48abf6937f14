// SPDX-License-Identifier: MIT
#include "reference_hybrid.h"
#include "reference_chain.h"
#include "reference_split.h"

#include <math.h>
#include <string.h>

// The share of realised velocities, see glsl/project.glsl.
static double realised_share(const TwinStrand *strand, const TwinStep *step)
{
    Vec g;
    double length = 0;
    vec_add_scaled(step->gravity, step->drag, step->wind, g);
    for (int j = 1; j < strand->n; ++j) length += strand->length[j];
    double sigma = step->dt * (strand->n - 1) * sqrt(vec_norm(g) / length);
    return fmin(fmin(fmax(0.1 * (sigma - 1.2), 0), 0.07 + 0.01 * sigma), 1);
}

// The strand is now at x; velocities are projected on what its shape allows.
static void finish(TwinStrand *strand, const TwinStep *step, const Vec *predicted, const Vec *x)
{
    const int n = strand->n;
    const double share = realised_share(strand, step);
    Vec u[TWIN_MAX], d[TWIN_MAX];
    double right[TWIN_MAX], lambda[TWIN_MAX];
    for (int j = 0; j < n; ++j)
        for (int k = 0; k < 3; ++k) {
            double wanted =
                j == 0 ? x[j][k] : predicted[j][k] + share * (x[j][k] - predicted[j][k]);
            u[j][k] = (wanted - strand->x[j][k]) / step->dt;
        }
    for (int j = 1; j < n; ++j) {
        Vec r, relative;
        vec_add_scaled(x[j], -1, x[j - 1], r);
        for (int k = 0; k < 3; ++k) d[j][k] = r[k] / strand->length[j];
        vec_add_scaled(u[j], -1, u[j - 1], relative);
        right[j] = vec_dot(d[j], relative);
    }
    reference_solve_lengths((const Vec *)d, n, right, lambda);
    for (int j = 1; j < n; ++j) {
        vec_add_scaled(u[j], -lambda[j], d[j], u[j]);
        if (j < n - 1) vec_add_scaled(u[j], lambda[j + 1], d[j + 1], u[j]);
    }
    memcpy(strand->v, u, sizeof u);
    memcpy(strand->x, x, (size_t)n * sizeof *x);
}

void reference_hybrid_step(TwinStrand *strand, const TwinStep *step, const SectionParams *params)
{
    Vec predicted[TWIN_MAX], x[TWIN_MAX];
    reference_predict(strand, step, params, predicted);
    reference_two_pass(strand, (const Vec *)predicted, predicted[0], x);
    finish(strand, step, (const Vec *)predicted, (const Vec *)x);
}
