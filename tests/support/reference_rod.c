// SPDX-License-Identifier: MIT
#include "support/reference_rod.h"

#include <math.h>
#include <string.h>

typedef double Matrix[3][3];

static void cross(const Vec a, const Vec b, Vec r)
{
    for (int k = 0; k < 3; ++k)
        r[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static void subtract(const Vec a, const Vec b, Vec r)
{
    vec_add_scaled(a, -1, b, r);
}

static void unit(const Vec a, Vec r)
{
    double size = vec_norm(a);
    for (int k = 0; k < 3; ++k) r[k] = a[k] / size;
}

// M += s a b^T.
static void add_outer(Matrix M, double s, const Vec a, const Vec b)
{
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) M[i][k] += s * a[i] * b[k];
}

static void add_both(Matrix M, double s, const Vec a, const Vec b)
{
    add_outer(M, s, a, b);
    add_outer(M, s, b, a);
}

static void add_diagonal(Matrix M, double s)
{
    for (int i = 0; i < 3; ++i) M[i][i] += s;
}

// M v -> h x v.
static void add_across(Matrix M, double s, const Vec h)
{
    for (int i = 0; i < 3; ++i) {
        int x = (i + 1) % 3, y = (i + 2) % 3;
        M[x][y] -= s * h[i], M[y][x] += s * h[i];
    }
}

static void multiply(Matrix A, Matrix B, bool transposed, Matrix R)
{
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) {
            R[i][k] = 0;
            for (int m = 0; m < 3; ++m) R[i][k] += (transposed ? A[m][i] : A[i][m]) * B[m][k];
        }
}

static void apply(Matrix A, bool transposed, const Vec v, Vec r)
{
    for (int i = 0; i < 3; ++i) {
        r[i] = 0;
        for (int m = 0; m < 3; ++m) r[i] += (transposed ? A[m][i] : A[i][m]) * v[m];
    }
}

static double determinant(Matrix M)
{
    Vec c;
    cross(M[1], M[2], c);
    return vec_dot(M[0], c);
}

static bool is_positive(Matrix M)
{
    double minor = M[0][0] * M[1][1] - M[0][1] * M[1][0], trace = M[0][0] + M[1][1] + M[2][2];
    return M[0][0] > 0 && minor > 0 && determinant(M) > 1e-5 * trace * minor;
}

// R = M^-1 of a symmetric matrix.
static void invert(Matrix M, Matrix R)
{
    double det = determinant(M);
    for (int i = 0; i < 3; ++i) cross(M[(i + 1) % 3], M[(i + 2) % 3], R[i]);
    for (int i = 0; i < 9; ++i) R[i / 3][i % 3] /= det;
}

// --- Joints.

typedef struct Joints {
    double beta[TWIN_MAX], mass[TWIN_MAX], ratio; // ratio: gamma/beta
    Vec t[TWIN_MAX], a[TWIN_MAX], r[TWIN_MAX];    // directions, unloaded directions, segments
} Joints;

static double bending(const SectionParams *params)
{
    double radius = (double)params->hair_radius * 1e-6;
    return (double)params->youngs_modulus * 1e9 * radius * radius /
           (4 * (double)params->hair_density);
}

static void find_material(const TwinStrand *strand, const SectionParams *params, Joints *joints)
{
    for (int j = 1; j < strand->n; ++j) {
        double l = strand->length[j], before = j > 1 ? strand->length[j - 1] : 0,
               beyond = j + 1 < strand->n ? strand->length[j + 1] : 0;
        joints->beta[j] = 2 * bending(params) / (before + l);
        joints->mass[j] = (l + beyond) / 2;
    }
    joints->ratio = 1 / (1 + (double)params->poisson);
}

// Rodrigues' rotation of v about the unit vector k.
static void rotate_about(const Vec k, double cosine, double sine, Vec v)
{
    Vec kv;
    double along = vec_dot(k, v) * (1 - cosine);
    cross(k, v, kv);
    for (int i = 0; i < 3; ++i) v[i] = cosine * v[i] + sine * kv[i] + along * k[i];
}

// The head's axes in the world; with two poses, of the rotation at `share` between them, as
// quaternions are mixed and normalised.
static void clamp_axes(const HeadPose *from, const HeadPose *to, double share, Matrix axes)
{
    double q[4], side = 0, size = 0;
    for (int i = 0; i < 4; ++i) side += (double)from->rotation[i] * (double)to->rotation[i];
    for (int i = 0; i < 4; ++i) {
        q[i] = (1 - share) * (side < 0 ? -1 : 1) * (double)from->rotation[i] +
               share * (double)to->rotation[i];
        size += q[i] * q[i];
    }
    for (int i = 0; i < 4; ++i) q[i] /= sqrt(size);
    for (int k = 0; k < 3; ++k) {
        Vec v = {k == 0, k == 1, k == 2}, t, u = {q[0], q[1], q[2]}, ut;
        cross(u, v, t);
        for (int i = 0; i < 3; ++i) t[i] *= 2;
        cross(u, t, ut);
        for (int i = 0; i < 3; ++i) axes[k][i] = v[i] + q[3] * t[i] + ut[i];
    }
}

// Directions t of the segments r and unloaded directions a, from the clamp's axes on.
static void find_frames(const TwinStrand *strand, const double *twist, Matrix axes, Joints *joints)
{
    for (int j = 1; j < strand->n; ++j) {
        Vec natural, axis;
        double *a = joints->a[j], *t = joints->t[j];
        subtract(strand->style[j], strand->style[j - 1], natural);
        unit(natural, natural);
        for (int i = 0; i < 3; ++i)
            a[i] = axes[0][i] * natural[0] + axes[1][i] * natural[1] + axes[2][i] * natural[2];
        unit(joints->r[j], t);
        cross(a, t, axis);
        double sine = vec_norm(axis), cosine = vec_dot(a, t);
        for (int k = 0; k < 3; ++k) {
            Vec about;
            if (sine > 0) {
                unit(axis, about);
                rotate_about(about, cosine, sine, axes[k]);
            }
            rotate_about(t, cos(twist[j]), sin(twist[j]), axes[k]);
        }
    }
}

static double find_energy(const TwinStrand *strand, const double *twist, const Joints *joints)
{
    double energy = 0;
    for (int j = 1; j < strand->n; ++j)
        energy += joints->beta[j] * (1 - vec_dot(joints->t[j], joints->a[j]) +
                                     joints->ratio * twist[j] * twist[j] / 2);
    return energy;
}

// The gradient by the segments, and the moments G[j]: of the frame j, from what lies beyond.
static void find_gradient(const TwinStrand *strand, const Joints *joints, Vec *by, Vec *G)
{
    double most = 0;
    memset(G[strand->n - 1], 0, sizeof *G);
    for (int j = strand->n - 1; j >= 1; --j) {
        const double *a = joints->a[j], *t = joints->t[j];
        double beta = joints->beta[j], k = vec_dot(G[j], t) / fmax(1 + vec_dot(a, t), 0.1);
        Vec part, moment;
        vec_add_scaled(G[j], -k, a, part);
        cross(part, t, by[j]);
        vec_add_scaled(by[j], -beta, a, by[j]);
        vec_add_scaled(by[j], -vec_dot(by[j], t), t, by[j]);
        cross(a, t, moment);
        most += 2 * beta;
        for (int i = 0; i < 3; ++i) {
            by[j][i] /= strand->length[j];
            G[j - 1][i] = k * (a[i] + t[i]) - beta * moment[i];
        }
        double shorter = fmin(most / fmax(vec_norm(G[j - 1]), 1e-15), 1);
        for (int i = 0; i < 3; ++i) G[j - 1][i] *= shorter;
    }
}

double reference_rod_energy(const TwinStrand *strand, const HeadPose *head,
                            const SectionParams *params, Vec *gradient)
{
    Joints joints;
    Matrix axes;
    Vec by[TWIN_MAX], G[TWIN_MAX];
    find_material(strand, params, &joints);
    for (int j = 1; j < strand->n; ++j) subtract(strand->x[j], strand->x[j - 1], joints.r[j]);
    clamp_axes(head, head, 1, axes);
    find_frames(strand, strand->twist, axes, &joints);
    if (!gradient) return find_energy(strand, strand->twist, &joints);
    find_gradient(strand, &joints, by, G);
    for (int j = 1; j < strand->n; ++j)
        for (int i = 0; i < 3; ++i)
            gradient[j][i] = by[j][i] - (j + 1 < strand->n ? by[j + 1][i] : 0);
    return find_energy(strand, strand->twist, &joints);
}

void reference_rod_untwist(TwinStrand *strand, const HeadPose *head, const SectionParams *params,
                           int rounds)
{
    Joints joints;
    Vec by[TWIN_MAX], G[TWIN_MAX];
    find_material(strand, params, &joints);
    for (int j = 1; j < strand->n; ++j) subtract(strand->x[j], strand->x[j - 1], joints.r[j]);
    for (int round = 0; round < rounds; ++round) {
        Matrix axes;
        clamp_axes(head, head, 1, axes);
        find_frames(strand, strand->twist, axes, &joints);
        find_gradient(strand, &joints, by, G);
        for (int j = 1; j < strand->n; ++j)
            strand->twist[j] +=
                0.2 *
                (-vec_dot(G[j], joints.t[j]) / (joints.ratio * joints.beta[j]) - strand->twist[j]);
    }
}

// --- The step.

typedef struct RodStep {
    const TwinStep *step;
    int n;
    double share, stiffness, gain; // stiffness: of the style's springs
    Vec root, root_gain, root_before, root_after;
    Vec q[TWIN_MAX], v[TWIN_MAX], u[TWIN_MAX], style[TWIN_MAX]; // in the root's frame
    double twist[TWIN_MAX];
    Joints joints;
    Matrix U[TWIN_MAX], W[TWIN_MAX];
    Vec solved[TWIN_MAX], moment; // of the clamp
} RodStep;

static void open(RodStep *rod, const TwinStrand *strand, const TwinStep *step,
                 const SectionParams *params)
{
    double c = step->drag, share = (double)params->style, dt = step->dt;
    rod->step = step, rod->n = strand->n;
    rod->share = 0.5 + fmin((double)params->bend_damping * 1e-3, fmax(dt / 2, 2e-3)) / dt;
    rod->stiffness = (double)params->style_stiffness * share / (1 - share);
    rod->gain = c > 0 ? -expm1(-c * dt) / c : dt;
    twin_style(strand, &step->head, 0, rod->root);
    for (int i = 0; i < 3; ++i) {
        double mean = (rod->root[i] - strand->x[0][i]) / dt;
        rod->root_before[i] = strand->v[0][i];
        rod->root_gain[i] = mean - strand->v[0][i];
        rod->root_after[i] = strand->v[0][i] + 1.95 * rod->root_gain[i];
    }
    for (int j = 0; j < strand->n; ++j) {
        subtract(strand->x[j], strand->x[0], rod->q[j]);
        subtract(strand->v[j], strand->v[0], rod->v[j]);
        twin_style(strand, &step->head, j, rod->style[j]);
        subtract(rod->style[j], rod->root, rod->style[j]);
    }
    memcpy(rod->twist, strand->twist, sizeof rod->twist);
    find_material(strand, params, &rod->joints);
}

// Sets the change of segment j, scaled to the exact length.
static void place(RodStep *rod, const TwinStrand *strand, int j, const Vec change)
{
    Vec r, e;
    subtract(rod->q[j], rod->q[j - 1], r);
    vec_add_scaled(r, 1, change, e);
    double scale = strand->length[j] / vec_norm(e);
    for (int i = 0; i < 3; ++i) rod->u[j][i] = rod->u[j - 1][i] + scale * e[i] - r[i];
}

static void find_goals(RodStep *rod, const TwinStrand *strand)
{
    Matrix axes;
    for (int j = 1; j < rod->n; ++j)
        for (int i = 0; i < 3; ++i)
            rod->joints.r[j][i] =
                rod->q[j][i] - rod->q[j - 1][i] + rod->share * (rod->u[j][i] - rod->u[j - 1][i]);
    clamp_axes(&rod->step->head_old, &rod->step->head, rod->share, axes);
    find_frames(strand, rod->twist, axes, &rod->joints);
}

static void predict(RodStep *rod, const TwinStrand *strand)
{
    memset(rod->u[0], 0, sizeof rod->u[0]);
    for (int j = 1; j < rod->n; ++j) {
        Vec change;
        for (int i = 0; i < 3; ++i) change[i] = rod->step->dt * (rod->v[j][i] - rod->v[j - 1][i]);
        place(rod, strand, j, change);
    }
    find_goals(rod, strand);
}

// The residual of particle j without joints; returns its derivative by u.
static double residual(const RodStep *rod, int j, Vec r)
{
    const TwinStep *step = rod->step;
    double mass = rod->joints.mass[j], stiff = 2 / (step->dt * rod->gain), k = rod->stiffness;
    for (int i = 0; i < 3; ++i) {
        double push = step->gravity[i] + step->drag * step->wind[i];
        r[i] = stiff * rod->u[j][i] - (2 / rod->gain - step->drag) * rod->v[j][i] - push +
               (2 / rod->gain - 0.05 / step->dt) * rod->root_gain[i] +
               step->drag * rod->root_before[i] +
               k * (rod->q[j][i] + rod->u[j][i] - rod->style[j][i]);
        r[i] *= mass;
    }
    return mass * (stiff + k);
}

typedef struct Front {
    Matrix A, C, E;
    Vec p, s;
} Front;

// M w = A (w x e).
static void after_turn(Matrix A, const Vec e, Matrix M)
{
    for (int i = 0; i < 3; ++i) cross(e, A[i], M[i]);
}

static void eliminate(RodStep *rod, int j, const Vec e, Matrix G, Matrix before, double stiffness,
                      Front *f)
{
    Matrix K, H, B = {{0}}, part, inverse, transposed;
    Vec b, moment;
    after_turn(f->A, e, K);
    for (int i = 0; i < 9; ++i) K[i / 3][i % 3] += f->C[i / 3][i % 3];
    add_across(B, -1, e); // w x e
    multiply(B, K, true, H);
    multiply(f->C, B, true, part);
    for (int i = 0; i < 9; ++i) H[i / 3][i % 3] += f->E[i / 3][i % 3] + part[i / 3][i % 3];
    if (!is_positive(H)) add_diagonal(H, stiffness);
    if (!is_positive(H)) {
        double size = fabs(H[0][0]) + fabs(H[1][1]) + fabs(H[2][2]) + stiffness;
        memset(H, 0, sizeof H);
        add_diagonal(H, size);
    }
    cross(e, f->p, moment);
    vec_add_scaled(moment, 1, f->s, b);
    invert(H, inverse);
    for (int i = 0; i < 9; ++i) transposed[i / 3][i % 3] = K[i % 3][i / 3];
    multiply(inverse, transposed, false, rod->U[j]);
    multiply(inverse, G, false, rod->W[j]);
    apply(inverse, false, b, rod->solved[j]);
    multiply(K, rod->U[j], false, part);
    for (int i = 0; i < 9; ++i) f->A[i / 3][i % 3] -= part[i / 3][i % 3];
    multiply(K, rod->W[j], false, part);
    for (int i = 0; i < 9; ++i) f->C[i / 3][i % 3] = -part[i / 3][i % 3];
    multiply(G, rod->W[j], true, part);
    for (int i = 0; i < 9; ++i) f->E[i / 3][i % 3] = before[i / 3][i % 3] - part[i / 3][i % 3];
    apply(K, false, rod->solved[j], moment);
    vec_add_scaled(f->p, -1, moment, f->p);
    apply(G, true, rod->solved[j], moment);
    for (int i = 0; i < 3; ++i) f->s[i] = -moment[i];
}

static void solve(RodStep *rod, const TwinStrand *strand)
{
    Front front = {0};
    Vec by[TWIN_MAX], G[TWIN_MAX], N = {0};
    const Joints *joints = &rod->joints;
    find_gradient(strand, joints, by, G);
    vec_copy(G[0], rod->moment);
    for (int j = rod->n - 1; j >= 1; --j) {
        const double *a = joints->a[j], *t = joints->t[j];
        Vec R, e, h, k;
        Matrix coupling = {{0}}, before = {{0}};
        double stiff = residual(rod, j, R), c = vec_dot(a, t), kb = rod->share * joints->beta[j],
               gamma = joints->ratio * joints->beta[j], M = gamma * rod->twist[j],
               off = M + vec_dot(G[j], t), kt = rod->share * gamma, m = rod->share * M / 2;
        for (int i = 0; i < 3; ++i) {
            R[i] += by[j][i] - (j + 1 < rod->n ? by[j + 1][i] : 0);
            e[i] = rod->q[j][i] - rod->q[j - 1][i] + (rod->u[j][i] - rod->u[j - 1][i]) / 2;
            N[i] += R[i], front.p[i] -= R[i];
            h[i] = (a[i] + t[i]) / fmax(1 + c, 0.1);
        }
        cross(t, a, k);
        for (int i = 0; i < 3; ++i) k[i] /= fmax(1 + c, 0.1);
        add_diagonal(front.A, stiff);
        double ee = vec_dot(e, e), tension = fmax(-vec_dot(N, e) / ee, 0) / 2;
        add_diagonal(front.E, tension * ee + kb);
        add_outer(front.E, 1e-4 * stiff - tension, e, e);
        add_both(front.E, -kb / 2, a, t);
        add_both(front.E, -rod->share / 2, e, by[j]);
        add_outer(coupling, kb, a, t);
        add_diagonal(coupling, -kb * c);
        add_diagonal(before, kb);
        add_both(before, -kb / 2, a, t);
        for (int part = 0; part < 3; ++part) {
            double sign = part == 2 ? -1 : 1;
            double(*to)[3] = part == 0 ? front.E : part == 1 ? before : coupling;
            add_outer(to, sign * kt, h, h);
            add_both(to, -sign * m, h, k);
        }
        add_across(coupling, -m, h);
        vec_add_scaled(front.s, -off, h, front.s);
        eliminate(rod, j, e, coupling, before, 2 * kb + stiff * ee, &front);
        vec_add_scaled(front.s, off, h, front.s);
    }
}

// Applies the solution. Returns the largest turn.
static double advance(RodStep *rod, const TwinStrand *strand)
{
    Vec dx = {0}, w_before = {0}, before = {0};
    double most = 0;
    for (int j = 1; j < rod->n; ++j) {
        Vec e, w, z, part, h, change, old;
        double l = strand->length[j];
        const double *a = rod->joints.a[j], *t = rod->joints.t[j];
        vec_copy(rod->u[j], old);
        for (int i = 0; i < 3; ++i) {
            change[i] = rod->u[j][i] - before[i];
            e[i] = rod->q[j][i] - rod->q[j - 1][i] + change[i] / 2;
            h[i] = (a[i] + t[i]) / fmax(1 + vec_dot(a, t), 0.1);
        }
        apply(rod->U[j], false, dx, part);
        subtract(rod->solved[j], part, w);
        apply(rod->W[j], false, w_before, part);
        subtract(w, part, w);
        cross(w, e, z);
        double turned = vec_norm(z) / l, cut = turned > 0.3 ? 0.3 / turned : 1;
        most = fmax(most, turned);
        for (int i = 0; i < 3; ++i) w[i] *= cut, z[i] *= cut;
        subtract(w, w_before, part);
        rod->twist[j] += rod->share * vec_dot(h, part);
        vec_add_scaled(change, 1, z, change);
        vec_add_scaled(dx, 1, z, dx);
        vec_copy(old, before);
        vec_copy(w, w_before);
        place(rod, strand, j, change);
    }
    find_goals(rod, strand);
    return most;
}

static void clamp_turn(const TwinStep *step, Vec turn)
{
    double a[4], b[4], side = 0;
    Vec u, v;
    for (int i = 0; i < 4; ++i) {
        a[i] = (double)step->head_old.rotation[i], b[i] = (double)step->head.rotation[i];
        side += a[i] * b[i];
    }
    for (int i = 0; i < 4 && side < 0; ++i) a[i] = -a[i];
    for (int i = 0; i < 3; ++i) u[i] = a[i], v[i] = b[i];
    cross(v, u, turn);
    for (int i = 0; i < 3; ++i) turn[i] = 2 * (a[3] * v[i] - b[3] * u[i] - turn[i]);
}

void reference_rod_step(TwinStrand *strand, const TwinStep *step, const SectionParams *params)
{
    static RodStep rod; // large
    Vec turn, push;
    double worked, kinetic = 0, length = 0;
    double before = reference_rod_energy(strand, &step->head_old, params, NULL);
    open(&rod, strand, step, params);
    predict(&rod, strand);
    for (int round = 0; round < 3; ++round) {
        solve(&rod, strand);
        if (advance(&rod, strand) <= 0.1 && round == 1) break;
    }
    clamp_turn(step, turn);
    worked = -vec_dot(rod.moment, turn);
    vec_copy(rod.root, strand->x[0]);
    vec_copy(rod.root_after, strand->v[0]);
    for (int j = 1; j < rod.n; ++j) {
        Vec R, now;
        residual(&rod, j, R);
        worked += vec_dot(rod.u[j], R);
        length += strand->length[j];
        for (int i = 0; i < 3; ++i) {
            now[i] = 2 / step->dt * rod.u[j][i] - rod.v[j][i];
            strand->x[j][i] = rod.root[i] + rod.q[j][i] + rod.u[j][i];
            strand->v[j][i] = rod.root_after[i] + now[i];
        }
        kinetic += rod.joints.mass[j] * vec_dot(now, now) / 2;
    }
    memcpy(strand->twist, rod.twist, sizeof rod.twist);
    double energy = reference_rod_energy(strand, &step->head, params, NULL);
    double gained = strand->gained + energy - before + worked;
    vec_add_scaled(step->gravity, step->drag, step->wind, push);
    double speed = 1e-6 * length / step->dt;
    double over = gained - length * (0.005 * length * vec_norm(push) / 2 + speed * speed / 2);
    if (over > 0) {
        double paid = fmin(over, kinetic), kept = sqrt(1 - paid / fmax(kinetic, 1e-30));
        for (int j = 1; j < rod.n; ++j)
            for (int i = 0; i < 3; ++i)
                strand->v[j][i] = rod.root_after[i] + kept * (strand->v[j][i] - rod.root_after[i]);
        gained -= paid;
    }
    strand->gained = fmax(gained, 0);
}
