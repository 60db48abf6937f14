// SPDX-License-Identifier: MIT
#include "support/reference_bend.h"

#include <math.h>

typedef double Matrix[3][3];

double reference_bend_stiffness(const SectionParams *params)
{
    double share = (double)params->style;
    return (double)params->chain_bend * share / (1 - share);
}

static void cross(const Vec a, const Vec b, Vec r)
{
    for (int k = 0; k < 3; ++k)
        r[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

// Rotates each column of `frame` by the smallest rotation from the unit vector a to the unit vector
// b (Rodrigues): v -> c v + k x v + k (k.v)/(1 + c), k = a x b, c = a.b.
static void turn_frame(Matrix frame, const Vec a, const Vec b)
{
    double c = vec_dot(a, b);
    Vec k;
    cross(a, b, k);
    for (int column = 0; column < 3 && 1 + c > 1e-6; ++column) {
        Vec v = {frame[0][column], frame[1][column], frame[2][column]}, kv;
        cross(k, v, kv);
        for (int i = 0; i < 3; ++i)
            frame[i][column] = c * v[i] + kv[i] + k[i] * vec_dot(k, v) / (1 + c);
    }
}

// The columns are the head's axes x, y and z in the world.
static void head_frame(const HeadPose *head, Matrix frame)
{
    const HeadPose turn = {
        .rotation = {head->rotation[0], head->rotation[1], head->rotation[2], head->rotation[3]}};
    for (int k = 0; k < 3; ++k) {
        TwinStrand axis = {.n = 1};
        Vec turned;
        axis.style[0][k] = 1;
        twin_style(&axis, &turn, 0, turned);
        for (int i = 0; i < 3; ++i) frame[i][k] = turned[i];
    }
}

static void find_goals(const TwinStrand *strand, const HeadPose *head, const Vec *r, Vec *goal,
                       Vec *direction)
{
    Matrix frame;
    head_frame(head, frame);
    for (int j = 1; j < strand->n; ++j) {
        Vec style;
        vec_add_scaled(strand->style[j], -1, strand->style[j - 1], style);
        for (int i = 0; i < 3; ++i) {
            goal[j][i] = vec_dot(frame[i], style) / strand->length[j];
            direction[j][i] = r[j][i] / vec_norm(r[j]);
        }
        turn_frame(frame, goal[j], direction[j]);
    }
}

static void find_gradient(const TwinStrand *strand, const Vec *goal, const Vec *direction,
                          Vec *gradient)
{
    double scale = (strand->n - 1) * (strand->n - 1);
    double most = 0;
    Vec G = {0};
    for (int j = strand->n - 1; j >= 1; --j) {
        const double *a = goal[j], *t = direction[j];
        double beta = scale * strand->length[j];
        double tau = vec_dot(G, t) / fmax(1 + vec_dot(a, t), 0.1), along;
        Vec across, moment, by_t;
        vec_add_scaled(G, -tau, a, across);
        cross(across, t, by_t);
        vec_add_scaled(by_t, -beta, a, by_t);
        along = vec_dot(by_t, t);
        cross(a, t, moment);
        for (int i = 0; i < 3; ++i) {
            gradient[j][i] = (by_t[i] - along * t[i]) / strand->length[j];
            G[i] = tau * (a[i] + t[i]) - beta * moment[i];
        }
        most += beta;
        double shorter = fmin(most / fmax(vec_norm(G), 1e-30), 1);
        for (int i = 0; i < 3; ++i) G[i] *= shorter;
    }
}

double reference_bend_energy(const TwinStrand *strand, const HeadPose *head, const Vec *r,
                             Vec *gradient)
{
    Vec goal[TWIN_MAX], direction[TWIN_MAX];
    double energy = 0, scale = (strand->n - 1) * (strand->n - 1);
    find_goals(strand, head, r, goal, direction);
    for (int j = 1; j < strand->n; ++j)
        energy += scale * strand->length[j] * (1 - vec_dot(goal[j], direction[j]));
    if (gradient) find_gradient(strand, (const Vec *)goal, (const Vec *)direction, gradient);
    return energy;
}
