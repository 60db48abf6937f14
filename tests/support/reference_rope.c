// SPDX-License-Identifier: MIT
#include "support/reference_rope.h"

#include <math.h>

// The displacement of a link's ends for each m/s^2 of inverse mass (1 kg each) and m of distance
// between them.
typedef double (*Correction)(double distance, double length, double inverse_masses,
                             double softness);

static double bullet(double distance, double length, double inverse_masses, double softness)
{
    (void)softness;
    double ll = length * length, mm = distance * distance;
    return (ll - mm) / (inverse_masses * (ll + mm));
}

static double xpbd(double distance, double length, double inverse_masses, double softness)
{
    return (length - distance) / (distance * (inverse_masses + softness));
}

static void sweep(TwinStrand *strand, Correction correction, double softness)
{
    for (int j = 1; j < strand->n; ++j) {
        double *a = strand->x[j - 1], *b = strand->x[j], w = j == 1 ? 0 : 1;
        Vec r;
        vec_add_scaled(b, -1, a, r);
        double c = correction(vec_norm(r), strand->length[j], w + 1, softness);
        vec_add_scaled(a, -w * c, r, a);
        vec_add_scaled(b, c, r, b);
    }
}

// A step of h seconds that ends with the root at `root` and `sweeps` sweeps. Forces act for `acts`
// seconds; the share `kept` of the velocity remains.
static void small_step(TwinStrand *strand, const TwinStep *step, double h, double acts,
                       const Vec root, double kept, int sweeps, Correction correction,
                       double softness, const SectionParams *params)
{
    Vec old[TWIN_MAX];
    for (int j = 0; j < strand->n; ++j) {
        vec_copy(strand->x[j], old[j]);
        twin_kick(strand->v[j], step, acts);
        vec_add_scaled(strand->x[j], h, strand->v[j], strand->x[j]);
    }
    vec_copy(root, strand->x[0]);
    twin_pull_to_style(strand, step, h, acts, params);
    for (int i = 0; i < sweeps; ++i) sweep(strand, correction, softness);
    for (int j = 0; j < strand->n; ++j)
        for (int k = 0; k < 3; ++k) strand->v[j][k] = kept * (strand->x[j][k] - old[j][k]) / h;
}

void reference_rope_bullet_step(TwinStrand *strand, const TwinStep *step,
                                const SectionParams *params)
{
    double h = step->dt * (double)params->rope_time_scale;
    Vec root;
    twin_style(strand, &step->head, 0, root);
    small_step(strand, step, h, step->first ? h / 2 : h, root, 1 - (double)params->rope_damping,
               params->rope_iterations, bullet, 0, params);
}

void reference_rope_xpbd_step(TwinStrand *strand, const TwinStep *step, const SectionParams *params)
{
    int count = params->rope_iterations;
    double h = step->dt * (double)params->rope_time_scale / count;
    Vec from, to, way, root;
    twin_style(strand, &step->head_old, 0, from);
    twin_style(strand, &step->head, 0, to);
    vec_add_scaled(to, -1, from, way);
    for (int i = 1; i <= count; ++i) {
        vec_add_scaled(from, (double)i / count, way, root);
        small_step(strand, step, h, step->first && i == 1 ? h / 2 : h, root,
                   pow(1 - (double)params->rope_damping, 1.0 / count), 1, xpbd,
                   (double)params->rope_compliance / (h * h), params);
    }
}
