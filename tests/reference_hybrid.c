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

static uint32_t hash(uint32_t id) // lowbias32
{
    id = (id ^ (id >> 16)) * 0x7feb352dU;
    id = (id ^ (id >> 15)) * 0x846ca68bU;
    return id ^ (id >> 16);
}

// The order in which 1 .. count are moved: upwards, within each four by exclusive or with a random
// number.
static void shuffle(uint32_t seed, int count, int *order)
{
    int flip = (int)(hash(seed) >> 30), found = 0;
    for (int at = 0; found < count; ++at)
        if ((at ^ flip) < count) order[found++] = (at ^ flip) + 1;
}

// Particle i goes to `target`, both sides follow.
static void pull(TwinStrand *strand, Vec *x, int i, const Vec target)
{
    for (int side = -1; side <= 1; side += 2) {
        Vec old;
        vec_copy(x[i], old);
        Vec before;
        vec_copy(target, before);
        for (int j = i + side; j >= 0 && j < strand->n; j += side) {
            Vec moved, tail;
            vec_copy(x[j], tail);
            reference_tractrix(old, tail, before, strand->length[side > 0 ? j : j + 1], moved);
            vec_copy(tail, old);
            vec_copy(moved, before);
            vec_copy(moved, x[j]);
        }
    }
    vec_copy(target, x[i]);
}

// As published, from root to tip: v = (x - q)/dt, and an explicit spring to the style.
void reference_thesis_emulation_step(TwinStrand *strand, const TwinStep *step,
                                     const SectionParams *params)
{
    SectionParams free = *params;
    Vec predicted[TWIN_MAX], x[TWIN_MAX];
    double k =
        (double)params->style_stiffness * (double)params->style / (1 - (double)params->style);
    free.style = 0;
    memcpy(x, strand->x, sizeof x);
    reference_predict(strand, step, &free, predicted);
    for (int i = 1; i < strand->n; ++i) pull(strand, x, i, predicted[i]);
    pull(strand, x, 0, predicted[0]);
    for (int j = 0; j < strand->n; ++j) {
        Vec style;
        twin_style(strand, &step->head, j, style);
        for (int i = 0; i < 3; ++i) {
            strand->v[j][i] =
                (x[j][i] - strand->x[j][i]) / step->dt + k * (style[i] - x[j][i]) * step->dt;
            strand->x[j][i] = x[j][i];
        }
    }
}

void reference_emulation_step(TwinStrand *strand, const TwinStep *step, const SectionParams *params)
{
    Vec predicted[TWIN_MAX], x[TWIN_MAX];
    int order[TWIN_MAX];
    shuffle(step->shuffle, strand->n - 1, order);
    memcpy(x, strand->x, sizeof x);
    reference_predict(strand, step, params, predicted);
    for (int k = 0; k < strand->n - 1; ++k) pull(strand, x, order[k], predicted[order[k]]);
    pull(strand, x, 0, predicted[0]);
    finish(strand, step, (const Vec *)predicted, (const Vec *)x);
}
