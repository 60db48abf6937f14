// SPDX-License-Identifier: MIT
#include "support/reference_dftl.h"

#include <math.h>
#include <string.h>

// The published rule. `correction[j]`: the correction that gave particle j its distance from its
// leader.
static void follow(TwinStrand *strand, const TwinStep *step, const SectionParams *params,
                   Vec *correction)
{
    double acts = step->first ? step->dt / 2 : step->dt;
    for (int i = 1; i < strand->n; ++i) {
        twin_kick(strand->v[i], step, acts);
        vec_add_scaled(strand->x[i], step->dt, strand->v[i], strand->x[i]);
    }
    twin_style(strand, &step->head, 0, strand->x[0]);
    twin_pull_to_style(strand, step, step->dt, acts, params);
    for (int i = 1; i < strand->n; ++i) {
        Vec predicted, r;
        vec_copy(strand->x[i], predicted);
        vec_add_scaled(predicted, -1, strand->x[i - 1], r);
        vec_add_scaled(strand->x[i - 1], strand->length[i] / vec_norm(r), r, strand->x[i]);
        vec_add_scaled(strand->x[i], -1, predicted, correction[i]);
    }
}

void reference_dftl_step(TwinStrand *strand, const TwinStep *step, const SectionParams *params)
{
    double s = (double)params->ftl_damping;
    Vec old[TWIN_MAX], correction[TWIN_MAX + 1] = {{0}};
    memcpy(old, strand->x, sizeof old);
    follow(strand, step, params, correction);
    for (int i = 1; i < strand->n; ++i)
        for (int k = 0; k < 3; ++k)
            strand->v[i][k] =
                (strand->x[i][k] - old[i][k]) / step->dt - s * correction[i + 1][k] / step->dt;
}

// Where the drawn strand with velocities `u` would be without length constraints.
static void fly(const TwinStrand *strand, const TwinStep *step, const SectionParams *params,
                const Vec *u, Vec *flown)
{
    double acts = step->first ? step->dt / 2 : step->dt;
    TwinStrand free = *strand;
    twin_style(strand, &step->head, 0, free.x[0]);
    for (int j = 1; j < strand->n; ++j) {
        vec_copy(u[j], free.v[j]);
        twin_kick(free.v[j], step, acts);
        vec_add_scaled(strand->x[j], step->dt, free.v[j], free.x[j]);
    }
    twin_pull_to_style(&free, step, step->dt, acts, params);
    memcpy(flown, free.x, sizeof free.x);
}

// sum (k m - u dt - (f - u dt)).(k m + u dt)/2/dt^2 as a k^2 + b k + c, where m is the motion from
// `old` to the strand and f the motion to `flown`. All are relative to the root's motion in this
// step and in the previous one.
static void account(const TwinStrand *strand, const Vec *old, const Vec *flown, const Vec *u,
                    double dt, double *a, double *b, double *c)
{
    *a = *b = *c = 0;
    for (int j = 1; j < strand->n; ++j) {
        Vec now, forced, before;
        for (int k = 0; k < 3; ++k) {
            double root = strand->x[0][k] - old[0][k];
            now[k] = (strand->x[j][k] - old[j][k] - root) / dt;
            forced[k] = (flown[j][k] - old[j][k] - root) / dt;
            before[k] = u[j][k] - u[0][k];
        }
        *a += vec_dot(now, now) / 2;
        *b += (vec_dot(now, before) - vec_dot(forced, now)) / 2;
        *c -= vec_dot(forced, before) / 2;
    }
}

// Moves the strand by only a share of its way; each segment keeps its direction of motion.
static void slow_down(TwinStrand *strand, const Vec *old, double share)
{
    Vec went[TWIN_MAX];
    memcpy(went, strand->x, sizeof went);
    for (int j = 1; j < strand->n; ++j) {
        Vec way;
        for (int k = 0; k < 3; ++k)
            way[k] =
                (1 - share) * (old[j][k] - old[j - 1][k]) + share * (went[j][k] - went[j - 1][k]);
        vec_add_scaled(strand->x[j - 1], strand->length[j] / vec_norm(way), way, strand->x[j]);
    }
}

static double fall(const TwinStrand *strand, const TwinStep *step)
{
    double length = 0;
    Vec acceleration;
    for (int j = 1; j < strand->n; ++j) length += strand->length[j];
    vec_add_scaled(step->gravity, step->drag, step->wind, acceleration);
    return (strand->n - 1) * length / 2 * vec_norm(acceleration);
}

static double kinetic_energy(const TwinStrand *strand)
{
    double sum = 0;
    for (int j = 1; j < strand->n; ++j) {
        Vec v;
        vec_add_scaled(strand->v[j], -1, strand->v[0], v);
        sum += vec_dot(v, v) / 2;
    }
    return sum;
}

static void find_velocities(TwinStrand *strand, const Vec *old, double dt)
{
    for (int j = 0; j < strand->n; ++j)
        for (int k = 0; k < 3; ++k) strand->v[j][k] = (strand->x[j][k] - old[j][k]) / dt;
}

// Slows the strand down if corrections have given more than 0.003 of the energy that it may have.
// Returns the energy that they gave in this step.
static double guard(TwinStrand *strand, const TwinStep *step, const Vec *old, const Vec *flown,
                    const Vec *u)
{
    const double allowed = 0.003;
    double a, b, c, falls = allowed * fall(strand, step);
    account(strand, old, flown, u, step->dt, &a, &b, &c);
    const double given = a + b + c;
    c += strand->gained;
    strand->gained = fmax(a + b + c, 0);
    if (!(strand->gained > falls + allowed * a) || !(a > 0)) return given;
    double free = (1 - allowed) * a, discriminant = fmax(b * b - 4 * free * (c - falls), 0),
           share = fmin(fmax((sqrt(discriminant) - b) / (2 * free), 0), 1);
    double kinetic = share * share * a, gained = kinetic + share * b + c;
    double over = fmin(fmax(gained - falls - allowed * kinetic, 0), kinetic);
    double kept = kinetic > 0 ? sqrt(1 - over / kinetic) : 1;
    slow_down(strand, old, share);
    find_velocities(strand, old, step->dt);
    // Segments that rotate move slightly farther than by the share of their way.
    gained += kept * kept * (kinetic_energy(strand) - kinetic) - over;
    for (int j = 1; j < strand->n; ++j) {
        Vec v;
        vec_add_scaled(strand->v[j], -1, strand->v[0], v);
        vec_add_scaled(strand->v[0], kept, v, strand->v[j]);
    }
    strand->gained = fmax(gained, 0);
    return given;
}

// The energy that the next step removes from the velocities: the gain above 0.001 of the energy
// that the strand may have, and as much again as this step gave.
static void charge(TwinStrand *strand, const TwinStep *step, double given)
{
    double kinetic = kinetic_energy(strand),
           over = strand->gained + fmax(given, 0) - 0.001 * (fall(strand, step) + kinetic);
    over = fmin(fmax(over, 0), kinetic);
    strand->gained -= over;
    strand->paid = over > 0 ? 1 - sqrt(1 - over / kinetic) : 0;
}

void reference_dftl_guarded_step(TwinStrand *strand, const TwinStep *step,
                                 const SectionParams *params)
{
    double s = (double)params->ftl_damping;
    Vec old[TWIN_MAX], u[TWIN_MAX], flown[TWIN_MAX], correction[TWIN_MAX + 1] = {{0}};
    memcpy(old, strand->x, sizeof old);
    for (int j = 1; j < strand->n; ++j)
        for (int k = 0; k < 3; ++k)
            strand->v[j][k] += strand->paid * (strand->v[0][k] - strand->v[j][k]);
    memcpy(u, strand->v, sizeof u);
    fly(strand, step, params, (const Vec *)u, flown);
    for (int j = 1; j + 1 < strand->n; ++j) { // gives back along the current segment
        Vec segment;
        vec_add_scaled(strand->x[j + 1], -1, strand->x[j], segment);
        vec_add_scaled(strand->v[j], -strand->carried[j], segment, strand->v[j]);
    }
    follow(strand, step, params, correction);
    for (int j = 1; j + 1 < strand->n; ++j) {
        Vec segment;
        vec_add_scaled(strand->x[j + 1], -1, strand->x[j], segment);
        strand->carried[j] =
            s * vec_dot(correction[j + 1], segment) / vec_dot(segment, segment) / step->dt;
    }
    find_velocities(strand, (const Vec *)old, step->dt);
    charge(strand, step, guard(strand, step, (const Vec *)old, (const Vec *)flown, (const Vec *)u));
}
