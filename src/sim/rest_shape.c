// SPDX-License-Identifier: MIT
#include "sim/rest_shape.h"

#include <math.h>
#include <string.h>

static const double MOST_TORQUE = 0.9; // of beta: joints bend by at most 64 degrees
// Greiner's load of a heavy upright column: w s^3/B = 7.837 (Greenhill 1881); half of it.
static const double MOST_COMPRESSION = 3.9;
// Share of a frame's stiffness that must be left; rounding, and the step's error at rest.
static const double LEAST_PIVOT = 1e-3;
enum { ROUNDS = 12, HALVINGS = 6 };

typedef double Matrix[3][3];

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double r[3])
{
    double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2],
           z = a[0] * b[1] - a[1] * b[0];
    r[0] = x, r[1] = y, r[2] = z;
}

static void add(double a[3], double s, const double b[3])
{
    for (int k = 0; k < 3; ++k) a[k] += s * b[k];
}

// Holds particle j so that its segment is not compressed too much and the torque T at its joint is
// not too large; `limit` reduces both bounds. Adds the force to W, the force on everything beyond,
// and its torque to T.
static void hold(RestJoint *joint, double reach, double limit, double W[3], double T[3])
{
    double l = joint->length, along = dot(T, joint->t), across[3], size, force[3];
    double most = limit * MOST_TORQUE * joint->beta;
    memcpy(across, T, sizeof across);
    add(across, -along, joint->t);
    size = sqrt(dot(across, across));
    if (size * size + along * along > most * most && size > 0) {
        double left = sqrt(fmax(most * most - along * along, 0)), less = 1 - left / size;
        cross(across, joint->t, force); // t x (across x t) = across
        for (int k = 0; k < 3; ++k) force[k] *= -less / l;
        add(joint->held, 1, force);
        add(W, 1, force);
        add(T, -less, across);
    }
    double compression =
        -dot(W, joint->t) - limit * MOST_COMPRESSION * joint->bend / (reach * reach);
    if (compression > 0) {
        add(joint->held, compression, joint->t);
        add(W, compression, joint->t);
    }
}

// The unloaded direction and twist of a joint that balances the torque T: by fixed-point rounds, in
// which the bend follows from the part of T that the twist leaves.
static void unload(RestJoint *joint, const double T[3], double gamma)
{
    memcpy(joint->a, joint->t, sizeof joint->a);
    joint->twist = 0;
    for (int round = 0; round < ROUNDS && joint->beta > 0; ++round) {
        double middle[3], bending[3], turned[3];
        for (int k = 0; k < 3; ++k) middle[k] = joint->a[k] + joint->t[k];
        double one_cosine = 1 + dot(joint->a, joint->t), twist = dot(T, middle) / (2 * gamma);
        memcpy(bending, T, sizeof bending);
        add(bending, -gamma * twist / one_cosine, middle);
        add(bending, -dot(bending, joint->t), joint->t);
        double sine = sqrt(dot(bending, bending)) / joint->beta;
        if (sine > 0.99) sine = 0.99;
        // beta a x t = bending
        cross(joint->t, bending, turned);
        double size = sqrt(dot(turned, turned)), cosine = sqrt(1 - sine * sine);
        for (int k = 0; k < 3; ++k)
            joint->a[k] = cosine * joint->t[k] + (size > 0 ? sine / size * turned[k] : 0);
        joint->twist = -twist;
    }
}

static void balance(RestJoint *joints, int n, double ratio, double limit)
{
    double W[3] = {0}, T[3] = {0}, reach = 0;
    for (int j = n; j >= 1; --j) {
        RestJoint *joint = &joints[j];
        double torque[3];
        memset(joint->held, 0, sizeof joint->held);
        add(W, 1, joint->weight);
        reach += joint->length;
        cross(joint->t, W, torque);
        add(T, joint->length, torque);
        hold(joint, reach, limit, W, T);
        unload(joint, T, ratio * joint->beta);
    }
}

// --- Whether the shape is a minimum of energy.
//
// Frame j turns by the rotation vector w_j: t_j = exp(w_j) t_j, and a_j = exp(v) a_j with v =
// w_{j-1}. The second order of the joint's bending, of its twist (M = gamma (tau - tau0)), and of
// the force W on everything beyond:
//     bend: beta/2 (c |w|^2 - (w.a)(w.t) + c |v|^2 - (v.a)(v.t)) - beta (c w.v - (w.a)(v.t)),
//     twist: gamma/2 (h.(w - v))^2 + M/2 (v.(h x w) - (h.(w - v)) (k.(w - v))),
//     weight: l/2 ((W.t) |w|^2 - (w.t)(w.W)),
//     c = a.t, h = (a + t)/(1 + c), k = t x a/(1 + c)
// The twist follows from dtau = h.(w - v) along the turn. Constant forces couple no frames, so the
// elimination from tip to root needs only the frame itself.

static void add_outer(Matrix M, double s, const double a[3], const double b[3])
{
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) M[i][k] += s * a[i] * b[k];
}

static void add_symmetric(Matrix M, double s, const double a[3], const double b[3])
{
    add_outer(M, 0.5 * s, a, b);
    add_outer(M, 0.5 * s, b, a);
}

static void add_diagonal(Matrix M, double s)
{
    for (int i = 0; i < 3; ++i) M[i][i] += s;
}

// M -= R^T H^-1 R by Cholesky's factors of H. False if H is not positive.
static bool condense(Matrix H, Matrix R, Matrix M)
{
    double L[3][3] = {{0}}, scale = fabs(H[0][0]) + fabs(H[1][1]) + fabs(H[2][2]);
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k <= i; ++k) {
            double sum = H[i][k];
            for (int m = 0; m < k; ++m) sum -= L[i][m] * L[k][m];
            if (i == k && !(sum > LEAST_PIVOT * scale)) return false;
            L[i][k] = i == k ? sqrt(sum) : sum / L[k][k];
        }
    for (int c = 0; c < 3; ++c)
        for (int i = 0; i < 3; ++i) {
            for (int m = 0; m < i; ++m) R[i][c] -= L[i][m] * R[m][c];
            R[i][c] /= L[i][i];
        }
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            for (int m = 0; m < 3; ++m) M[i][k] -= R[m][i] * R[m][k];
    return true;
}

// Eliminates frame j: E becomes that of frame j - 1.
static bool eliminate(const RestJoint *joint, double ratio, const double W[3], Matrix E)
{
    const double *t = joint->t, *a = joint->a;
    double l = joint->length, beta = joint->beta, gamma = ratio * beta, c = dot(a, t), h[3], k[3],
           moment = -gamma * joint->twist;
    Matrix G = {{0}}, before = {{0}};
    cross(t, a, k);
    for (int i = 0; i < 3; ++i) h[i] = (a[i] + t[i]) / (1 + c), k[i] /= 1 + c;
    add_diagonal(E, beta * c + l * dot(W, t));
    add_symmetric(E, -beta, a, t);
    add_symmetric(E, -l, t, W);
    add_diagonal(before, beta * c);
    add_symmetric(before, -beta, a, t);
    add_diagonal(G, -beta * c);
    add_outer(G, beta, a, t);
    Matrix *const parts[3] = {(Matrix *)E, &before, &G};
    for (int i = 0; i < 3; ++i) {
        double sign = i == 2 ? -1 : 1;
        add_outer(*parts[i], sign * gamma, h, h);
        add_symmetric(*parts[i], -sign * moment, h, k);
    }
    for (int i = 0; i < 3; ++i) { // -M/2 [h]x
        int x = (i + 1) % 3, y = (i + 2) % 3;
        G[x][y] += 0.5 * moment * h[i], G[y][x] -= 0.5 * moment * h[i];
    }
    if (!condense(E, G, before)) return false;
    memcpy(E, before, sizeof before);
    return true;
}

static bool is_minimum(const RestJoint *joints, int n, double ratio)
{
    Matrix E = {{0}};
    double W[3] = {0};
    for (int j = n; j >= 1; --j) {
        add(W, 1, joints[j].weight);
        add(W, 1, joints[j].held);
        if (!eliminate(&joints[j], ratio, W, E)) return false;
    }
    return true;
}

// --- The natural directions.

// v, turned by the smallest rotation from the unit vector a to the unit vector b.
static void turn(const double a[3], const double b[3], double v[3])
{
    double axis[3], moved[3], c = dot(a, b), along;
    cross(a, b, axis);
    cross(axis, v, moved);
    along = dot(axis, v) / (1 + c);
    for (int k = 0; k < 3; ++k) v[k] = c * v[k] + moved[k] + along * axis[k];
}

// s_j: a_j in the frame that the joints before it have turned, all of them without twist.
static void find_natural(RestJoint *joints, int n)
{
    double frame[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int j = 1; j <= n; ++j) {
        for (int k = 0; k < 3; ++k) joints[j].natural[k] = dot(frame[k], joints[j].a);
        for (int k = 0; k < 3; ++k) turn(joints[j].a, joints[j].t, frame[k]);
    }
}

void rest_shape_solve(RestJoint *joints, int n, double ratio)
{
    double limit = 1;
    for (int i = 0; i <= HALVINGS; ++i, limit /= 2) {
        if (i == HALVINGS) limit = 0;
        balance(joints, n, ratio, limit);
        if (is_minimum(joints, n, ratio)) break;
    }
    find_natural(joints, n);
}
