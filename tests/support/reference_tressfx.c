// SPDX-License-Identifier: MIT
#include "support/reference_tressfx.h"

#include <math.h>
#include <string.h>

static void cross(const Vec a, const Vec b, Vec c)
{
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}

static void subtract(const Vec a, const Vec b, Vec c)
{
    for (int k = 0; k < 3; ++k) c[k] = a[k] - b[k];
}

// Rotates x by the smallest rotation that takes the direction of `from` to that of `to`.
static void turn_between(const Vec from, const Vec to, const Vec x, Vec result)
{
    Vec axis, side;
    cross(from, to, axis);
    double sine = vec_norm(axis), angle = atan2(sine, vec_dot(from, to));
    if (sine < 1e-12 * vec_norm(from) * vec_norm(to)) {
        memcpy(result, x, sizeof(Vec));
        return;
    }
    for (int k = 0; k < 3; ++k) axis[k] /= sine;
    cross(axis, x, side);
    double along = vec_dot(axis, x) * (1 - cos(angle));
    for (int k = 0; k < 3; ++k)
        result[k] = cos(angle) * x[k] + sin(angle) * side[k] + along * axis[k];
}

// Solves the dense system. `matrix` and `right` (3 columns) are overwritten; `right` becomes the
// solution.
static void solve(int size, double (*matrix)[TWIN_MAX], Vec *right)
{
    for (int p = 0; p < size; ++p)
        for (int i = p + 1; i < size; ++i) {
            double factor = matrix[i][p] / matrix[p][p];
            if (factor == 0) continue;
            for (int j = p; j < size; ++j) matrix[i][j] -= factor * matrix[p][j];
            for (int k = 0; k < 3; ++k) right[i][k] -= factor * right[p][k];
        }
    for (int i = size - 1; i >= 0; --i)
        for (int k = 0; k < 3; ++k) {
            for (int j = i + 1; j < size; ++j) right[i][k] -= matrix[i][j] * right[j][k];
            right[i][k] /= matrix[i][i];
        }
}

// The motion of a strand with the head in a step.
typedef struct Carried {
    Vec style[TWIN_MAX]; // positions of the style at the step's end
    Vec rest[TWIN_MAX];  // segments of the style
    double shock;        // share of the root's rigid motion that is applied to the whole strand
    Vec root_old, first_old;
} Carried;

// `threshold` is in metres.
static void carry(Carried *carried, const TwinStrand *strand, const TwinStep *step,
                  double coefficient, double threshold)
{
    Vec before, jerk;
    for (int j = 0; j < strand->n; ++j) {
        twin_style(strand, &step->head, j, carried->style[j]);
        if (j > 0) subtract(carried->style[j], carried->style[j - 1], carried->rest[j]);
    }
    twin_style(strand, &step->head_old, 0, carried->root_old);
    twin_style(strand, &step->head_old, 1, before);
    subtract(before, carried->root_old, carried->first_old);
    for (int k = 0; k < 3; ++k)
        jerk[k] = carried->style[1][k] - before[k] - step->dt * strand->v[1][k];
    carried->shock = vec_norm(jerk) > threshold ? 1 : coefficient;
}

// Moves a point by the strand's share of the root's motion.
static void shake(const Carried *carried, const Vec x, Vec result)
{
    Vec offset, turned;
    subtract(x, carried->root_old, offset);
    turn_between(carried->first_old, carried->rest[1], offset, turned);
    for (int k = 0; k < 3; ++k)
        result[k] =
            (1 - carried->shock) * x[k] + carried->shock * (carried->style[0][k] + turned[k]);
}

// v becomes the displacement of the step over dt; vertex 1 has the head's velocity.
static void finish(TwinStrand *strand, const Carried *carried, const Vec *from, const Vec *x,
                   double dt, double clamp, int power)
{
    for (int k = 0; k < 3; ++k) {
        double before = carried->root_old[k] + carried->first_old[k];
        strand->v[1][k] = (carried->style[1][k] - before) / dt;
    }
    for (int j = 2; j < strand->n; ++j) {
        Vec delta;
        subtract(x[j], from[j], delta);
        double excess = vec_norm(delta) / clamp, cut = excess > 1 ? pow(excess, -power) : 1;
        for (int k = 0; k < 3; ++k) strand->v[j][k] = cut * delta[k] / dt;
    }
    memcpy(strand->x, x, (size_t)strand->n * sizeof(Vec));
}

// A vertex between a segment and a segment more than twice as long moves less.
static double lever(double here, double next)
{
    return fmin(1, 2 * here / next);
}

static void keep_local_shape(const Carried *carried, int n, const double shares[2], Vec *x)
{
    for (int j = 1; j < n - 1; ++j) {
        Vec last, wanted;
        subtract(x[j], x[j - 1], last);
        turn_between(carried->rest[j], last, carried->rest[j + 1], wanted);
        double back = lever(vec_norm(carried->rest[j]), vec_norm(carried->rest[j + 1]));
        for (int k = 0; k < 3; ++k) {
            double delta = shares[j > 1] * (x[j][k] + wanted[k] - x[j + 1][k]);
            if (j > 1) x[j][k] -= delta * back;
            x[j + 1][k] += delta;
        }
    }
}

// The share of itself by which each segment must draw its ends together (or push them apart, if
// negative): Newton's step towards the lengths, J J^T lambda = (|s_j|^2 - l_j |s_j|).
static void find_tensions(const TwinStrand *strand, const Vec *s, double *lambda)
{
    static double matrix[TWIN_MAX][TWIN_MAX];
    Vec right[TWIN_MAX] = {{0}};
    int n = strand->n;
    memset(matrix, 0, sizeof matrix);
    for (int j = 2; j < n; ++j) {
        matrix[j - 2][j - 2] = (j > 2 ? 2 : 1) * vec_dot(s[j], s[j]);
        if (j > 2) matrix[j - 2][j - 3] = matrix[j - 3][j - 2] = -vec_dot(s[j], s[j - 1]);
        right[j - 2][0] = vec_norm(s[j]) * (vec_norm(s[j]) - strand->length[j]);
    }
    solve(n - 2, matrix, right);
    for (int j = 2; j < n; ++j) lambda[j] = right[j - 2][0];
}

// Contractions act along the new segments, (I + K) y' = y - pushes; pushes act along the current
// segments.
static void reach_lengths(const TwinStrand *strand, Vec *y)
{
    static double matrix[TWIN_MAX][TWIN_MAX];
    double lambda[TWIN_MAX] = {0};
    Vec s[TWIN_MAX];
    int n = strand->n;
    for (int j = 2; j < n; ++j) subtract(y[j], y[j - 1], s[j]);
    find_tensions(strand, (const Vec *)s, lambda);
    memset(matrix, 0, sizeof matrix);
    for (int j = 2; j < n; ++j) {
        double tension = fmax(lambda[j], 0), push = fmin(lambda[j], 0);
        matrix[j - 2][j - 2] += 1 + tension;
        if (j > 2) {
            matrix[j - 3][j - 3] += tension;
            matrix[j - 2][j - 3] = matrix[j - 3][j - 2] = -tension;
            vec_add_scaled(y[j - 1], push, s[j], y[j - 1]);
        }
        vec_add_scaled(y[j], -push, s[j], y[j]);
        if (j == 2) vec_add_scaled(y[2], tension, y[1], y[2]);
    }
    solve(n - 2, matrix, y + 2);
}

// The local stiffness: k at style 0.5; at another style, k/(1 - 3k/4) is multiplied by the odds
// style/(1 - style).
static double local_stiffness(const SectionParams *params)
{
    double odds = (double)params->style / (1 - (double)params->style);
    double k =
        fmin((double)params->tressfx_local_constraint_stiffness, (double)params->tressfx_local_max);
    double firm = odds * k / (1 - 0.75 * k);
    return fmin(firm / (1 + 0.75 * firm), (double)params->tressfx_local_max);
}

static double global_spring(const SectionParams *params)
{
    double k = (double)params->tressfx_global_constraint_stiffness;
    return k / (1 - k) * (double)params->style / (1 - (double)params->style);
}

static double damping(const TwinStep *step, const SectionParams *params)
{
    return step->drag + (double)params->tressfx_damping * (double)params->tressfx_damping_rate;
}

// Neighbours exchange a share of the difference of their velocities. Vertex 1 has the head's
// velocity; the others' velocities are relative to the strand's share of the root's motion.
static void exchange_velocities(TwinStrand *strand, double shock, double share)
{
    for (int k = 0; k < 3; ++k) strand->v[1][k] *= 1 - shock;
    for (int j = 1; j < strand->n - 1; ++j)
        for (int k = 0; k < 3; ++k) {
            double given = share * lever(strand->length[j], strand->length[j + 1]) *
                           (strand->v[j + 1][k] - strand->v[j][k]);
            strand->v[j][k] += given, strand->v[j + 1][k] -= given;
        }
}

// The shares of a pass at the first joint and at the others. Their stiffness is `times` that of a
// pass with the share `published`: the sag of a strand under its weight, found by summing up the
// bends of its joints.
static void find_shares(int n, double published, double times, const SectionParams *params,
                        double shares[2])
{
    double most = (double)params->tressfx_local_share * (double)params->tressfx_local_max,
           slope = 0, less = 1, own = (n - 2) * (n - 2); // the sag is slope/share - less
    for (int j = 1; j <= n - 2; ++j) {
        double arm = n - 1 - j;
        slope += arm * arm;
        if (j == 2) less += arm * 2 * (arm + 1);
        if (j > 2) less += arm * (3 * (arm + 1) - (arm + 2));
    }
    double firm = times * published / fmax(1 - published * less / slope, 0.05);
    shares[0] = fmin(firm, 2 * most);
    shares[1] = fmin((slope - own) / fmax(slope / firm + less - own / shares[0], 1e-6), most);
}

void reference_tressfx_steady(TwinStrand *strand, const TwinStep *step, const SectionParams *params)
{
    Carried carried;
    Vec from[TWIN_MAX], x[TWIN_MAX];
    int n = strand->n;
    double dt = step->dt, h = step->first ? dt / 2 : dt;
    double frames = dt * (double)params->tressfx_damping_rate;
    double c = damping(step, params), decay = exp(-c * h), gain = c > 0 ? -expm1(-c * h) / c : h;
    double local = local_stiffness(params);
    int passes = params->tressfx_local_constraints_iterations;
    double shares[2];
    find_shares(n, local * (double)params->tressfx_local_share, 2 * frames * frames / passes,
                params, shares);
    double shape = global_spring(params) * frames * frames;
    // The threshold is an acceleration and the clamp a speed, and both are defined for frames of
    // 1/60 s.
    carry(&carried, strand, step, (double)params->tressfx_vsp_coeff,
          0.01 * (double)params->tressfx_vsp_accel_threshold * frames * frames);
    exchange_velocities(strand, carried.shock,
                        fmin(sqrt(2 * passes * shares[1]), 0.5) / fmax(pow(frames, 3), 1));
    memcpy(x[0], carried.style[0], 2 * sizeof(Vec));
    for (int j = 2; j < n; ++j) {
        Vec predicted;
        for (int k = 0; k < 3; ++k) {
            double force = step->gravity[k] + step->drag * step->wind[k];
            predicted[k] = strand->x[j][k] + dt * (strand->v[j][k] * decay + force * gain);
        }
        shake(&carried, strand->x[j], from[j]);
        shake(&carried, predicted, x[j]);
        if (j < (double)params->tressfx_global_constraints_range * n)
            for (int k = 0; k < 3; ++k) {
                double force = dt * gain * (step->gravity[k] + step->drag * step->wind[k]),
                       style = carried.style[j][k],
                       net = (force - shape * (from[j][k] - style)) / (1 + shape);
                x[j][k] = (x[j][k] + shape * style) / (1 + shape) +
                          (fmin(1 + shape, 1.5 * (1 + shape) / shape) - 1) * net;
            }
    }
    for (int i = 0; i < passes; ++i) keep_local_shape(&carried, n, shares, x);
    for (int i = 0; i < 2; ++i) reach_lengths(strand, x);
    memcpy(strand->x, x, (size_t)n * sizeof(Vec));
    twin_rebuild(strand, x);
    finish(strand, &carried, (const Vec *)from, (const Vec *)x, dt,
           0.01 * (double)params->tressfx_clamp_position_delta * frames, 1);
}

static void keep_edge(Vec a, Vec b, double length, double share_a, double share_b)
{
    Vec delta;
    subtract(b, a, delta);
    double stretch = 1 - length / fmax(vec_norm(delta), 1e-9);
    for (int k = 0; k < 3; ++k)
        a[k] += share_a * stretch * delta[k], b[k] -= share_b * stretch * delta[k];
}

// (t x w) x t. TressFX's unit of length is the centimetre here.
static void blow(const TwinStep *step, int n, Vec *x)
{
    for (int j = 2; j < n - 1; ++j) {
        Vec t, side, force;
        subtract(x[j + 1], x[j], t);
        cross(t, step->wind, side);
        cross(side, t, force);
        vec_add_scaled(x[j], 1e4 * step->dt * step->dt, force, x[j]);
    }
}

static void predict_4(const TwinStrand *strand, const Carried *carried, const TwinStep *step,
                      const SectionParams *params, Vec *from, Vec *x)
{
    double dt = step->dt, decay = exp(-damping(step, params) * dt);
    double range = (double)params->tressfx_global_constraints_range * strand->n,
           global = global_spring(params) / (1 + global_spring(params));
    memcpy(x[0], carried->style[0], 2 * sizeof(Vec));
    for (int j = 2; j < strand->n; ++j) {
        for (int k = 0; k < 3; ++k) {
            double v = decay * strand->v[j][k] + dt * step->gravity[k];
            x[j][k] = strand->x[j][k] + dt * v;
            if (j < range) x[j][k] += global * (carried->style[j][k] - x[j][k]);
        }
        shake(carried, strand->x[j], from[j]);
        shake(carried, x[j], x[j]);
    }
}

void reference_tressfx_4(TwinStrand *strand, const TwinStep *step, const SectionParams *params)
{
    Carried carried;
    Vec from[TWIN_MAX], x[TWIN_MAX];
    int n = strand->n;
    double local = local_stiffness(params);
    carry(&carried, strand, step, (double)params->tressfx_vsp_coeff,
          0.01 * (double)params->tressfx_vsp_accel_threshold);
    predict_4(strand, &carried, step, params, from, x);
    const double share = (double)params->tressfx_local_share * local;
    for (int i = 0; i < params->tressfx_local_constraints_iterations; ++i)
        keep_local_shape(&carried, n, (double[]){share, share}, x);
    blow(step, n, x);
    for (int i = 0; i < params->tressfx_length_constraints_iterations; ++i)
        for (int odd = 0; odd < 2; ++odd)
            for (int j = 1 + odd; j < n; j += 2)
                if (j > 1)
                    keep_edge(x[j - 1], x[j], strand->length[j], j > 2 ? 0.5 : 0, j > 2 ? 0.5 : 1);
    finish(strand, &carried, (const Vec *)from, (const Vec *)x, step->dt,
           0.01 * (double)params->tressfx_clamp_position_delta, 2);
}
