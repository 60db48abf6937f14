// SPDX-License-Identifier: MIT
#include "support/reference_hybrid.h"
#include "support/reference_chain.h"
#include "support/reference_split.h"

#include <math.h>
#include <string.h>

// A step by the midpoint rule, in the frame that moves with the root: positions and velocities are
// relative to the root's.
typedef struct Middle {
    double h, decay;         // half a step, s; share of velocity that drag leaves in it
    double stiffness;        // stiffness of the style springs, 1/s^2
    Vec root, root_velocity; // position at the step's end; mean velocity in the step
    Vec force;               // gravity and wind, m/s^2
    Vec push;                // change of velocity by `force` in half a step, m/s
    Vec q[TWIN_MAX], style[TWIN_MAX];
    Vec w[TWIN_MAX], aim[TWIN_MAX], u[TWIN_MAX];
    double gained;
} Middle;

static void open_middle(Middle *m, const TwinStrand *strand, const TwinStep *step,
                        const SectionParams *params)
{
    double c = step->drag, share = (double)params->style;
    double gain = c > 0 ? -expm1(-c * step->dt / 2) / c : step->dt / 2;
    Vec style_root;
    *m = (Middle){.h = step->dt / 2,
                  .decay = exp(-c * step->dt / 2),
                  .stiffness = (double)params->style_stiffness * share / (1 - share)};
    twin_style(strand, &step->head, 0, m->root);
    vec_copy(m->root, style_root);
    for (int k = 0; k < 3; ++k) {
        m->root_velocity[k] = (m->root[k] - strand->x[0][k]) / step->dt;
        m->force[k] = step->gravity[k] + c * step->wind[k];
        m->push[k] = gain * m->force[k];
    }
    for (int j = 0; j < strand->n; ++j) {
        vec_add_scaled(strand->x[j], -1, strand->x[0], m->q[j]);
        twin_style(strand, &step->head, j, m->style[j]);
        vec_add_scaled(m->style[j], -1, style_root, m->style[j]);
    }
}

// Applies forces and drag to an absolute velocity for half a step.
static void kick_half(const Middle *m, const Vec v, Vec r)
{
    for (int k = 0; k < 3; ++k) r[k] = m->decay * v[k] + m->push[k] - m->root_velocity[k];
}

// Velocities after half a kick and half a step of the springs, whose factors are exact around rest.
static void spring_half(const Middle *m, int n, const Vec *kicked, Vec *vs)
{
    double gain = m->h, decay = m->decay;
    if (m->decay < 1) gain = vec_norm(m->push) / vec_norm(m->force);
    double z = m->stiffness * m->h * gain * (1 + decay) / (1 + decay * decay);
    double keep = 1 / (1 + 2 * z);
    memset(vs[0], 0, sizeof(Vec));
    for (int j = 1; j < n; ++j)
        for (int k = 0; k < 3; ++k)
            vs[j][k] = keep * (kicked[j][k] + z / m->h * (m->style[j][k] - m->q[j][k]));
}

// J^T lambda without the root: r_j += lambda_j d_j - lambda_(j+1) d_(j+1), times `scale`.
static void add_impulses(int n, double scale, const double *lambda, const Vec *d, Vec *r)
{
    for (int j = 1; j < n; ++j) {
        vec_add_scaled(r[j], scale * lambda[j], d[j], r[j]);
        if (j < n - 1) vec_add_scaled(r[j], -scale * lambda[j + 1], d[j + 1], r[j]);
    }
}

// The tensions at the middle of the step, from velocities without them: lambda along directions d.
static void find_tensions(const Middle *m, const TwinStrand *strand, const Vec *vs, Vec *d,
                          double *lambda)
{
    double right[TWIN_MAX] = {0};
    Vec ahead[TWIN_MAX] = {{0}};
    for (int j = 1; j < strand->n; ++j) {
        Vec v, relative;
        vec_add_scaled(strand->v[j], -1, m->root_velocity, v);
        vec_add_scaled(m->q[j], m->h, v, ahead[j]);
        vec_add_scaled(ahead[j], -1, ahead[j - 1], d[j]);
        double size = vec_norm(d[j]);
        for (int k = 0; k < 3; ++k) d[j][k] /= size;
        vec_add_scaled(vs[j], -1, vs[j - 1], relative);
        right[j] = vec_dot(d[j], relative);
    }
    reference_solve_lengths((const Vec *)d, strand->n, right, lambda);
}

// (I + h Laplacian(T)) w = vs - J^T lambda- - Laplacian(T) q.
static void find_middle(Middle *m, const TwinStrand *strand, const Vec *vs)
{
    const int n = strand->n;
    Vec d[TWIN_MAX] = {{0}}, r[TWIN_MAX] = {{0}};
    double lambda[TWIN_MAX] = {0}, pull[TWIN_MAX] = {0}, push[TWIN_MAX] = {0};
    double lower[TWIN_MAX] = {0}, diagonal[TWIN_MAX] = {0}, upper[TWIN_MAX] = {0}, right[TWIN_MAX];
    find_tensions(m, strand, vs, d, lambda);
    for (int j = 1; j < n; ++j) {
        pull[j] = fmax(lambda[j], 0) / strand->length[j];
        push[j] = fmin(lambda[j], 0);
        vec_add_scaled(m->q[j], -1, m->q[j - 1], r[j]);
    }
    memcpy(m->w, vs, (size_t)n * sizeof *vs);
    add_impulses(n, -1, push, (const Vec *)d, m->w);
    add_impulses(n, -1, pull, (const Vec *)r, m->w);
    for (int k = 0; k < 3; ++k) {
        for (int j = 1; j < n; ++j) {
            double beyond = j < n - 1 ? pull[j + 1] : 0;
            lower[j] = -m->h * pull[j], upper[j] = -m->h * beyond;
            diagonal[j] = 1 + m->h * (pull[j] + beyond);
            right[j] = m->w[j][k];
        }
        reference_solve_tridiagonal(n - 1, lower, diagonal, upper, right);
        for (int j = 1; j < n; ++j) m->w[j][k] = right[j];
    }
}

// The middle of the step: the aims of particles and their velocities.
static void middle(Middle *m, const TwinStrand *strand, const TwinStep *step,
                   const SectionParams *params)
{
    const int n = strand->n;
    Vec kicked[TWIN_MAX] = {{0}}, vs[TWIN_MAX];
    open_middle(m, strand, step, params);
    for (int j = 1; j < n; ++j) kick_half(m, strand->v[j], kicked[j]);
    spring_half(m, n, (const Vec *)kicked, vs);
    find_middle(m, strand, (const Vec *)vs);
    for (int j = 1; j < n; ++j) {
        Vec tension;
        vec_add_scaled(m->w[j], -1, vs[j], tension);
        m->gained += 2 * vec_dot(m->w[j], tension);
        vec_add_scaled(m->q[j], 2 * m->h, m->w[j], m->aim[j]);
        for (int k = 0; k < 3; ++k) m->u[j][k] = 2 * m->w[j][k] - kicked[j][k];
    }
}

// Energy that the step may end with beyond that of u: minus the energy gained before, plus the work
// of forces from the aims to x, plus what float32 could make of that work.
static double budget(const Middle *m, const TwinStrand *strand, const Vec *x)
{
    const int n = strand->n;
    double length = 0, sum = -m->gained;
    for (int j = 1; j < n; ++j) length += strand->length[j];
    sum += (n - 1) * 6e-8 * length * vec_norm(m->force);
    for (int j = 1; j < n; ++j)
        for (int k = 0; k < 3; ++k) {
            double spring = m->stiffness * (m->style[j][k] - (x[j][k] + m->aim[j][k]) / 2);
            sum += (m->force[k] + spring) * (x[j][k] - m->aim[j][k]);
        }
    return sum;
}

static double kinetic(int n, const Vec *v)
{
    double sum = 0;
    for (int j = 1; j < n; ++j) sum += vec_dot(v[j], v[j]) / 2;
    return sum;
}

// Ends the step with the strand at x, relative to the root: projects velocities to those that the
// shape allows, and reduces them by energy that was created.
static void finish(TwinStrand *strand, Middle *m, const Vec *x)
{
    const int n = strand->n;
    Vec d[TWIN_MAX] = {{0}};
    double right[TWIN_MAX] = {0}, lambda[TWIN_MAX], may = budget(m, strand, x);
    for (int j = 1; j < n; ++j) {
        Vec relative, absolute;
        vec_add_scaled(m->u[j], 1, m->root_velocity, absolute);
        kick_half(m, absolute, m->u[j]);
        vec_add_scaled(x[j], -1, x[j - 1], d[j]);
        for (int k = 0; k < 3; ++k) d[j][k] /= strand->length[j];
        vec_add_scaled(m->u[j], -1, m->u[j - 1], relative);
        right[j] = vec_dot(d[j], relative);
    }
    may += kinetic(n, (const Vec *)m->u);
    reference_solve_lengths((const Vec *)d, n, right, lambda);
    add_impulses(n, -1, lambda, (const Vec *)d, m->u);
    double has = kinetic(n, (const Vec *)m->u), scale = has > may ? sqrt(fmax(may, 0) / has) : 1;
    for (int j = 0; j < n; ++j) {
        vec_add_scaled(m->root_velocity, scale, m->u[j], strand->v[j]);
        vec_add_scaled(m->root, 1, x[j], strand->x[j]);
    }
}

// In the two passes the root stands still at the strand's particle 0.
void reference_hybrid_step(TwinStrand *strand, const TwinStep *step, const SectionParams *params)
{
    static Middle m;
    Vec x[TWIN_MAX];
    TwinStrand seen = *strand;
    middle(&m, strand, step, params);
    memcpy(seen.x, m.q, sizeof seen.x);
    reference_two_pass(&seen, (const Vec *)m.aim, m.q[0], x);
    finish(strand, &m, (const Vec *)x);
}

static uint32_t hash(uint32_t id) // lowbias32
{
    id = (id ^ (id >> 16)) * 0x7feb352dU;
    id = (id ^ (id >> 15)) * 0x846ca68bU;
    return id ^ (id >> 16);
}

// A random order of 1 .. count: a bijection on numbers with as many bits; numbers beyond count are
// left out.
static void shuffle(uint32_t seed, int count, int *order)
{
    int bits = 1, found = 0;
    while (1 << bits < count) ++bits;
    for (uint32_t at = 0; found < count; ++at) {
        uint32_t number = at;
        for (uint32_t i = 0; i < 3; ++i) {
            number =
                (number * (hash(seed + 2 * i) | 1) + hash(seed + 2 * i + 1)) & ((1U << bits) - 1);
            number ^= number >> ((bits + 1) / 2);
        }
        if (number < (uint32_t)count) order[found++] = (int)number + 1;
    }
}

// Moves particle i to `target`; both sides of the strand follow.
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

// As published, from root to tip: v = (x - q)/dt, with an explicit spring to the style.
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

// The first pull: particle i moves to its aim, and every segment follows in the frame of its tail's
// own aim.
static void pull_along(const TwinStrand *strand, const Middle *m, Vec *x, int i)
{
    vec_copy(m->aim[i], x[i]);
    for (int side = -1; side <= 1; side += 2)
        for (int j = i + side; j >= 0 && j < strand->n; j += side) {
            Vec move, head;
            vec_add_scaled(m->aim[j], -1, m->q[j], move);
            vec_add_scaled(m->q[j - side], 1, move, head);
            reference_tractrix(head, m->aim[j], x[j - side], strand->length[side > 0 ? j : j + 1],
                               x[j]);
        }
}

void reference_emulation_step(TwinStrand *strand, const TwinStep *step, const SectionParams *params)
{
    static Middle m;
    Vec x[TWIN_MAX];
    int order[TWIN_MAX];
    middle(&m, strand, step, params);
    shuffle(1, strand->n - 1, order);
    pull_along(strand, &m, x, order[0]);
    for (int k = 1; k < strand->n - 1; ++k) pull(strand, x, order[k], m.aim[order[k]]);
    pull(strand, x, 0, m.q[0]);
    finish(strand, &m, (const Vec *)x);
}
