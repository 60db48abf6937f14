// SPDX-License-Identifier: MIT
#include "support/reference_chain.h"
#include "support/reference_split.h"

#include <math.h>
#include <string.h>

static void subtract(const Vec a, const Vec b, Vec r)
{
    vec_add_scaled(a, -1, b, r);
}

void reference_predict(TwinStrand *strand, const TwinStep *step, const SectionParams *params,
                       Vec *predicted)
{
    double h = step->first ? step->dt / 2 : step->dt, c = step->drag;
    double f = c > 0 ? -expm1(-c * h) / (c * h) : 1;
    double share = (double)params->style;
    double k = (double)params->style_stiffness * share / (1 - share), w = k * step->dt * h * f;
    twin_style(strand, &step->head, 0, predicted[0]);
    for (int j = 1; j < strand->n; ++j) {
        Vec style;
        twin_kick(strand->v[j], step, h);
        twin_style(strand, &step->head, j, style);
        for (int i = 0; i < 3; ++i)
            predicted[j][i] =
                (strand->x[j][i] + step->dt * strand->v[j][i] + w * style[i]) / (1 + w);
    }
}

void reference_solve_tridiagonal(int count, const double *lower, double *diagonal,
                                 const double *upper, double *right)
{
    for (int i = 2; i <= count; ++i) {
        double share = lower[i] / diagonal[i - 1];
        diagonal[i] -= share * upper[i - 1];
        right[i] -= share * right[i - 1];
    }
    for (int i = count; i >= 1; --i) {
        if (i < count) right[i] -= upper[i] * right[i + 1];
        right[i] /= diagonal[i];
    }
}

void reference_solve_lengths(const Vec *r, int n, const double *right, double *lambda)
{
    double diagonal[TWIN_MAX] = {0}, upper[TWIN_MAX] = {0}, lower[TWIN_MAX] = {0};
    for (int j = 1; j < n; ++j) {
        diagonal[j] = (j == 1 ? 1 : 2) * vec_dot(r[j], r[j]);
        lower[j] = j > 1 ? -vec_dot(r[j], r[j - 1]) : 0;
        upper[j] = j < n - 1 ? -vec_dot(r[j], r[j + 1]) : 0;
        lambda[j] = right[j];
    }
    reference_solve_tridiagonal(n - 1, lower, diagonal, upper, lambda);
}

// x_j -= g_j, x_{j-1} += g_j for every segment j; the root stays.
static void apply(Vec *x, int n, const Vec *g)
{
    for (int j = 1; j < n; ++j) {
        vec_add_scaled(x[j], -1, g[j], x[j]);
        if (j > 1) vec_add_scaled(x[j - 1], 1, g[j], x[j - 1]);
    }
}

static void find_tensions(const TwinStrand *strand, const Vec *r, const Vec *x, double *lambda)
{
    double right[TWIN_MAX] = {0};
    for (int j = 1; j < strand->n; ++j) {
        Vec s;
        subtract(x[j], x[j - 1], s);
        right[j] = strand->length[j] * (vec_norm(s) - strand->length[j]);
    }
    reference_solve_lengths(r, strand->n, right, lambda);
}

static void pull_implicitly(const TwinStrand *strand, const Vec *v_old, const TwinStep *step,
                            Vec *x)
{
    const double least = 0.25, stiff_from = 8;
    const int n = strand->n;
    Vec r[TWIN_MAX], g[TWIN_MAX];
    double right[TWIN_MAX] = {0}, lambda[TWIN_MAX], stiff[TWIN_MAX + 1] = {0};
    double diagonal[TWIN_MAX] = {0}, upper[TWIN_MAX] = {0}, lower[TWIN_MAX] = {0};
    for (int j = 1; j < n; ++j) subtract(strand->x[j], strand->x[j - 1], r[j]);
    find_tensions(strand, (const Vec *)r, (const Vec *)x, lambda);
    for (int j = 1; j < n; ++j) {
        double tension = fmax(lambda[j], 0), beyond = fmax(tension - stiff_from, 0);
        double theta = least + least * beyond / (beyond + stiff_from);
        stiff[j] = theta * tension;
        for (int i = 0; i < 3; ++i) {
            double before = r[j][i] - step->dt * (v_old[j][i] - v_old[j - 1][i]);
            g[j][i] = (lambda[j] - tension) * r[j][i] +
                      tension * ((1 - 2 * theta) * r[j][i] + theta * before);
        }
    }
    apply(x, n, (const Vec *)g);
    for (int i = 0; i < 3; ++i) {
        for (int j = 1; j < n; ++j) {
            diagonal[j] = 1 + stiff[j] + stiff[j + 1];
            lower[j] = -stiff[j];
            upper[j] = -stiff[j + 1];
            right[j] = x[j][i] + (j == 1 ? stiff[1] * x[0][i] : 0);
        }
        reference_solve_tridiagonal(n - 1, lower, diagonal, upper, right);
        for (int j = 1; j < n; ++j) x[j][i] = right[j];
    }
}

static void correct(const TwinStrand *strand, Vec *x, double *lambda)
{
    Vec s[TWIN_MAX], g[TWIN_MAX];
    double right[TWIN_MAX] = {0};
    for (int j = 1; j < strand->n; ++j) {
        subtract(x[j], x[j - 1], s[j]);
        right[j] = vec_norm(s[j]) * (vec_norm(s[j]) - strand->length[j]);
    }
    reference_solve_lengths((const Vec *)s, strand->n, right, lambda);
    for (int j = 1; j < strand->n; ++j)
        for (int i = 0; i < 3; ++i) g[j][i] = lambda[j] * s[j][i];
    apply(x, strand->n, (const Vec *)g);
}

void reference_two_pass(const TwinStrand *strand, const Vec *predicted, const Vec root, Vec *x)
{
    const int n = strand->n;
    Vec old_head, new_head;
    memcpy(x, predicted, (size_t)n * sizeof *x);
    vec_copy(strand->x[0], x[0]);
    for (int i = n - 1; i > 0; --i) {
        const double *tail = i > 1 ? predicted[i - 1] : strand->x[0];
        Vec moved, head, y;
        subtract(tail, strand->x[i - 1], moved);
        vec_add_scaled(strand->x[i], 1, moved, head);
        reference_tractrix(head, tail, x[i], strand->length[i], y);
        vec_copy(y, x[i - 1]);
    }
    vec_copy(x[0], old_head);
    vec_copy(root, new_head);
    vec_copy(root, x[0]);
    for (int j = 1; j < n; ++j) {
        Vec tail, y;
        vec_copy(x[j], tail);
        reference_tractrix(old_head, tail, new_head, strand->length[j], y);
        vec_copy(tail, old_head);
        vec_copy(y, new_head);
        vec_copy(y, x[j]);
    }
}

// Velocities relative to the root's current velocity.
static void subtract_root(int n, const Vec *v, Vec *u)
{
    for (int j = 0; j < n; ++j) subtract(v[j], v[0], u[j]);
}

// Motion relative to the root: velocities before and after the step, and the changes by forces
// (including the root's acceleration).
typedef struct Motion {
    Vec before[TWIN_MAX], now[TWIN_MAX], forced[TWIN_MAX];
} Motion;

// Changes of velocity by forces: in a step that solves, to the predicted positions; in a rescued
// step, only by uniform forces.
static void find_forced(const TwinStep *step, const Vec *x_old, const Vec *v_old,
                        const Vec *predicted, const Vec root, bool rescued, int n, Vec *forced)
{
    Vec fall = {0};
    twin_kick(fall, step, step->first ? step->dt / 2 : step->dt);
    for (int j = 1; j < n; ++j)
        for (int i = 0; i < 3; ++i) {
            double change = (predicted[j][i] - x_old[j][i]) / step->dt - v_old[j][i];
            forced[j][i] = (rescued ? fall[i] : change) - (root[i] - v_old[0][i]);
        }
}

// Sets the strand to x with exact lengths.
static void rebuild(TwinStrand *strand, const Vec *x, double dt)
{
    Vec old[TWIN_MAX];
    memcpy(old, strand->x, sizeof old);
    vec_copy(x[0], strand->x[0]);
    for (int j = 1; j < strand->n; ++j) {
        Vec s;
        subtract(x[j], x[j - 1], s);
        vec_add_scaled(strand->x[j - 1], strand->length[j] / vec_norm(s), s, strand->x[j]);
    }
    for (int j = 0; j < strand->n; ++j)
        for (int i = 0; i < 3; ++i) strand->v[j][i] = (strand->x[j][i] - old[j][i]) / dt;
}

// The kinetic energy gained in a step minus the work of the forces, which is the energy that
// constraints gave, if the strand had moved by the share k of its way: a k^2 + b k + c.
static void account(const Motion *motion, int n, double *a, double *b, double *c)
{
    *a = *b = *c = 0;
    for (int j = 1; j < n; ++j) {
        *a += vec_dot(motion->now[j], motion->now[j]) / 2;
        *b -= vec_dot(motion->forced[j], motion->now[j]) / 2;
        *c -= (vec_dot(motion->before[j], motion->before[j]) +
               vec_dot(motion->forced[j], motion->before[j])) /
              2;
    }
}

// The largest k in 0 .. 1 for which a k^2 + b k + c <= 0, or the nearest k to that.
static double share_within(double a, double b, double c)
{
    double discriminant = b * b - 4 * a * c;
    return fmin(fmax((sqrt(fmax(discriminant, 0)) - b) / (2 * a), 0), 1);
}

// Moves the strand by only a share of its way; each segment keeps its direction of motion.
static void slow_down(TwinStrand *strand, const Vec *x_old, double share, double dt)
{
    Vec x[TWIN_MAX];
    vec_copy(strand->x[0], x[0]);
    for (int j = 1; j < strand->n; ++j) {
        Vec from, to;
        subtract(x_old[j], x_old[j - 1], from);
        subtract(strand->x[j], strand->x[j - 1], to);
        vec_add_scaled(x[j - 1], 1 - share, from, x[j]);
        vec_add_scaled(x[j], share, to, x[j]);
    }
    memcpy(strand->x, x_old, (size_t)strand->n * sizeof *x_old);
    rebuild(strand, (const Vec *)x, dt);
}

static double allowed(const TwinStrand *strand, const TwinStep *step, double kinetic)
{
    double length = 0;
    Vec acceleration;
    for (int j = 1; j < strand->n; ++j) length += strand->length[j];
    vec_add_scaled(step->gravity, step->drag, step->wind, acceleration);
    return 0.005 * ((strand->n - 1) * length / 2 * vec_norm(acceleration) + kinetic);
}

// Slows the strand down if it has gained more energy than is allowed. `stored`: the rise of the
// springs' energy in the step.
static void guard(TwinStrand *strand, const TwinStep *step, const Motion *motion, const Vec *x_old)
{
    const int n = strand->n;
    double kinetic, linear, constant;
    account(motion, n, &kinetic, &linear, &constant);
    constant += strand->gained;
    strand->gained = fmax(kinetic + linear + constant, 0);
    if (!(strand->gained > allowed(strand, step, kinetic)) || !(kinetic > 0)) return;
    double share = share_within(0.995 * kinetic, linear, constant - allowed(strand, step, 0)),
           squares = 0;
    kinetic *= share * share;
    double slowed = kinetic + share * linear + constant;
    double over = fmin(fmax(slowed - allowed(strand, step, kinetic), 0), kinetic);
    double kept = kinetic > 0 ? sqrt(1 - over / kinetic) : 1;
    slow_down(strand, x_old, share, step->dt);
    for (int j = 1; j < n; ++j) {
        Vec now;
        subtract(strand->v[j], strand->v[0], now);
        squares += vec_dot(now, now) / 2;
        vec_add_scaled(strand->v[0], kept, now, strand->v[j]);
    }
    // Segments that rotate move slightly farther than by the share of their way.
    slowed += kept * kept * (squares - kinetic);
    strand->gained = fmax(slowed - over, 0);
}

static bool is_violent(const TwinStrand *strand, const Vec *x)
{
    return !(twin_length_error(strand, x) <= 0.5);
}

void reference_chain_step(TwinStrand *strand, const TwinStep *step, const SectionParams *params)
{
    const int n = strand->n;
    Vec x_old[TWIN_MAX], v_old[TWIN_MAX], predicted[TWIN_MAX], x[TWIN_MAX];
    double lambda[TWIN_MAX], again[TWIN_MAX];
    Motion motion = {0};
    memcpy(x_old, strand->x, sizeof x_old);
    memcpy(v_old, strand->v, sizeof v_old);
    reference_predict(strand, step, params, predicted);
    memcpy(x, predicted, sizeof x);
    pull_implicitly(strand, (const Vec *)v_old, step, x);
    correct(strand, x, lambda);
    correct(strand, x, again);
    bool violent = is_violent(strand, (const Vec *)x);
    if (violent) reference_two_pass(strand, (const Vec *)predicted, predicted[0], x);
    rebuild(strand, (const Vec *)x, step->dt);

    subtract_root(n, (const Vec *)v_old, motion.before);
    subtract_root(n, (const Vec *)strand->v, motion.now);
    find_forced(step, (const Vec *)x_old, (const Vec *)v_old, (const Vec *)predicted, strand->v[0],
                violent, n, motion.forced);
    guard(strand, step, &motion, (const Vec *)x_old);
}
