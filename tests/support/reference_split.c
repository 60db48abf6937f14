// SPDX-License-Identifier: MIT
#include "support/reference_split.h"

#include <math.h>
#include <string.h>

typedef double Vec[3];

static double dot(const Vec a, const Vec b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double norm(const Vec a)
{
    return sqrt(dot(a, a));
}

// r = a + s b
static void add_scaled(const Vec a, double s, const Vec b, Vec r)
{
    for (int k = 0; k < 3; ++k) r[k] = a[k] + s * b[k];
}

void reference_start(ReferenceStrand *strand, int n, const double (*positions)[3])
{
    *strand = (ReferenceStrand){.n = n};
    memcpy(strand->q, positions, (size_t)n * sizeof *positions);
    for (int j = 1; j < n; ++j) {
        Vec r;
        add_scaled(positions[j], -1, positions[j - 1], r);
        strand->length[j] = norm(r);
    }
    memcpy(strand->tip, positions[n - 1], sizeof strand->tip);
}

// In the plane of the motion the tail moves on a tractrix whose asymptote is the head's line. Its
// distance y to the line gives the parameter P (y = L sech(P/L)). If the tail trails behind, P
// grows by s. If it is pushed ahead, P falls by s and may pass the cusp, after which it trails.
// Signed: P1 = P0 + s, with P0 < 0 ahead; the tail is L tanh(P1/L) behind the head.
void reference_tractrix(const double h[3], const double t[3], const double p[3], double L,
                        double result[3])
{
    Vec S, T, e, across;
    add_scaled(p, -1, h, S);
    double s = norm(S);
    if (s == 0) {
        memcpy(result, t, sizeof(Vec));
        return;
    }
    for (int k = 0; k < 3; ++k) e[k] = S[k] / s;
    add_scaled(t, -1, h, T);
    double along = dot(T, e);
    add_scaled(T, -along, e, across);
    double y = norm(across);
    if (y <= 1e-300) { // the tail is on the line and moves along it
        add_scaled(t, 1, S, result);
        return;
    }
    // asech(y/L) = log((L + |along|)/y), with |along| = sqrt(L^2 - y^2)
    double reach = fabs(along), asech = log((L + reach) / y);
    double P = (along > 0 ? -asech : asech) + s / L;
    double sech = 1 / cosh(P);
    for (int k = 0; k < 3; ++k) result[k] = p[k] - L * tanh(P) * e[k] + L * sech * across[k] / y;
}

static void follow(Vec *q, int from, int to, const double *length, const Vec old_head)
{
    int step = to > from ? 1 : -1;
    Vec old;
    memcpy(old, old_head, sizeof old);
    for (int j = from + step; j != to + step; j += step) {
        Vec tail, moved;
        memcpy(tail, q[j], sizeof tail);
        reference_tractrix(old, tail, q[j - step], length[step > 0 ? j : j + 1], moved);
        memcpy(q[j], moved, sizeof moved);
        memcpy(old, tail, sizeof old);
    }
}

static void pull(ReferenceStrand *strand, int end, const Vec target)
{
    Vec old;
    memcpy(old, strand->q[end], sizeof old);
    memcpy(strand->q[end], target, sizeof(Vec));
    follow(strand->q, end, end == 0 ? strand->n - 1 : 0, strand->length, old);
}

// The change of velocity by forces.
static void find_push(const ReferenceForces *forces, Vec push)
{
    double h = forces->first ? forces->dt / 2 : forces->dt, c = forces->drag;
    double gain = c > 0 ? -expm1(-c * h) / c : h;
    for (int k = 0; k < 3; ++k) push[k] = (forces->gravity[k] + c * forces->wind[k]) * gain;
}

// Forces rotate the string by the angles that they push it sideways, as in glsl/sim/split.comp.
static void push_by_arcs(const ReferenceForces *forces, const Vec r, double R, Vec s)
{
    Vec push, middle;
    double rr = dot(r, r);
    find_push(forces, push);
    for (int k = 0; k < 3; ++k) push[k] *= forces->dt;
    add_scaled(s, -0.5, push, middle);
    add_scaled(push, -dot(push, r) / rr, r, push);
    add_scaled(middle, -dot(middle, r) / rr, r, middle);
    double bent = dot(middle, middle) / (R * R), along = dot(push, middle) / (3 * R * R);
    if (!(rr > 0.99 * R * R && dot(s, r) > 0 && bent < 1)) return;
    add_scaled(s, -bent / 6, push, s);
    add_scaled(s, -along, middle, s);
}

static void kick(ReferenceStrand *strand, const ReferenceForces *forces)
{
    double h = forces->first ? forces->dt / 2 : forces->dt, c = forces->drag;
    double decay = exp(-c * h), gain = c > 0 ? (1 - decay) / c : h;
    for (int k = 0; k < 3; ++k)
        strand->velocity[k] =
            strand->velocity[k] * decay + (forces->gravity[k] + c * forces->wind[k]) * gain;
}

// The tip is a mass on a string of the strand's length. `target`: where it moves.
static void fly(ReferenceStrand *strand, const double root[3], const ReferenceForces *forces,
                bool arcs, Vec target)
{
    Vec s, r;
    double R = 0;
    for (int j = 1; j < strand->n; ++j) R += strand->length[j];
    kick(strand, forces);
    add_scaled(strand->tip, forces->dt, strand->velocity, target);
    add_scaled(target, -1, root, s);
    add_scaled(strand->tip, -1, strand->q[0], r);
    if (norm(s) > R && arcs) {
        push_by_arcs(forces, r, R, s);
        add_scaled(root, 1, s, target);
    }
    if (norm(s) > R) {
        double rr = dot(r, r), sr = dot(s, r), disc = sr * sr - rr * (dot(s, s) - R * R);
        if (rr > 0.99 * R * R && sr > 0 && disc > 0.1 * sr * sr)
            add_scaled(s, -(dot(s, s) - R * R) / (sr + sqrt(disc)), r, s);
        add_scaled(root, R / norm(s), s, target);
    }
    for (int k = 0; k < 3; ++k) strand->velocity[k] = (target[k] - strand->tip[k]) / forces->dt;
    memcpy(strand->tip, target, sizeof(Vec));
}

static void pull_twice(ReferenceStrand *strand, const double root[3], const Vec target)
{
    for (int round = 0; round < 2; ++round) {
        pull(strand, strand->n - 1, target);
        pull(strand, 0, root);
    }
}

void reference_ball_step(ReferenceStrand *strand, const double root[3],
                         const ReferenceForces *forces)
{
    Vec target, home;
    fly(strand, root, forces, true, target);
    add_scaled(root, -1, strand->q[0], home);
    for (int j = 0; j < strand->n; ++j) add_scaled(strand->q[j], 1, home, strand->q[j]);
    pull_twice(strand, root, target);
}

void reference_dragged_step(ReferenceStrand *strand, const double root[3],
                            const ReferenceForces *forces)
{
    Vec target;
    fly(strand, root, forces, false, target);
    pull_twice(strand, root, target);
}

void reference_thesis_step(ReferenceStrand *strand, const double root[3],
                           const ReferenceForces *forces)
{
    Vec old, target;
    int end = strand->n - 1;
    memcpy(old, strand->q[end], sizeof old);
    kick(strand, forces);
    add_scaled(old, forces->dt, strand->velocity, target);
    pull(strand, end, target);
    pull(strand, 0, root);
    for (int k = 0; k < 3; ++k) strand->velocity[k] = (strand->q[end][k] - old[k]) / forces->dt;
    memcpy(strand->tip, strand->q[end], sizeof(Vec));
}

static void slerp(const Vec a, const Vec b, double share, Vec r)
{
    double angle = acos(fmax(-1, fmin(1, dot(a, b))));
    double sine = sin(angle);
    double wa = sine > 1e-12 ? sin((1 - share) * angle) / sine : 1;
    double wb = sine > 1e-12 ? sin(share * angle) / sine : 0;
    for (int k = 0; k < 3; ++k) r[k] = wa * a[k] + wb * b[k];
}

void reference_pose(const ReferenceStrand *strand, const double (*style)[3], double share,
                    double (*positions)[3])
{
    memcpy(positions[0], strand->q[0], sizeof(Vec));
    for (int j = 1; j < strand->n; ++j) {
        Vec d, mixed;
        add_scaled(strand->q[j], -1, strand->q[j - 1], d);
        for (int k = 0; k < 3; ++k) d[k] /= strand->length[j];
        slerp(d, style[j], share, mixed);
        add_scaled(positions[j - 1], strand->length[j], mixed, positions[j]);
    }
}
