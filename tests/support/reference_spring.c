// SPDX-License-Identifier: MIT
#include "support/reference_spring.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

// A link: length, direction, the style's direction, spring constants.
typedef struct Link {
    double m, l, k, b;
    Vec u, t;
} Link;

static Link link_of(const TwinStrand *strand, const HeadPose *head, const SectionParams *params,
                    int j)
{
    double links = strand->n - 1, style = (double)params->style;
    Link link = {.l = strand->length[j], .k = (double)params->spring_coil * links * links};
    Vec from, to, r;
    link.b =
        fmin((double)params->spring_angular * style / (1 - style) * links, link.k * link.l / 8);
    vec_add_scaled(strand->x[j], -1, strand->x[j - 1], r);
    link.m = vec_norm(r);
    twin_style(strand, head, j - 1, from);
    twin_style(strand, head, j, to);
    for (int k = 0; k < 3; ++k) {
        link.u[k] = r[k] / link.m;
        link.t[k] = (to[k] - from[k]) / link.l;
    }
    return link;
}

static double angle_of(const Link *link)
{
    return acos(fmax(-1, fmin(1, vec_dot(link->u, link->t))));
}

// The force on the particle at the link's end.
static void link_force(const Link *link, Vec force)
{
    Vec across;
    vec_add_scaled(link->t, -vec_dot(link->t, link->u), link->u, across);
    double sine = vec_norm(across);
    for (int k = 0; k < 3; ++k) {
        force[k] = -link->k / 2 * (link->m - link->l) * link->u[k];
        if (sine > 1e-9) force[k] += link->b * angle_of(link) * across[k] / sine;
    }
}

// The potential of the explicit rule's springs for a link r (spring.comp).
static double potential(const Link *link, const Vec r, double softness)
{
    double l = link->l, e = softness, m = vec_norm(r), longer = fmax(l, e);
    double stretched = sqrt(m * m + longer * longer - l * l) - longer;
    double b = fmin(link->b, link->k * l * l * l / 8 / (l * l + e * e)) * (l * l + e * e) / l;
    double theta = acos(fmax(-1, fmin(1, vec_dot(r, link->t) / m))), back = PI - theta;
    double phi = theta < 0.75 * PI ? theta * theta / 2 : 0.375 * PI * PI - 1.5 * back * back;
    return link->k / 4 * stretched * stretched + b * m * m / (m * m + e * e) * phi;
}

// The force by central differences of the potential, so that it is conservative.
static void conservative_force(const Link *link, double softness, Vec force)
{
    double delta = 1e-6 * link->l;
    for (int k = 0; k < 3; ++k) {
        Vec more, less;
        for (int i = 0; i < 3; ++i) {
            more[i] = link->m * link->u[i] + (i == k ? delta : 0);
            less[i] = link->m * link->u[i] - (i == k ? delta : 0);
        }
        force[k] = (potential(link, less, softness) - potential(link, more, softness)) / 2 / delta;
    }
}

enum { BAND = 5, SIZE = 3 * TWIN_MAX }; // an equation couples this many unknowns on each side

// Solves a x = b by Gaussian elimination within the band; b becomes x.
static void solve_banded(double (*a)[2 * BAND + 1], double *b, int count)
{
    for (int i = 0; i < count; ++i)
        for (int j = i + 1; j <= i + BAND && j < count; ++j) {
            double f = a[j][i - j + BAND] / a[i][BAND];
            for (int k = i; k <= i + BAND && k < count; ++k)
                a[j][k - j + BAND] -= f * a[i][k - i + BAND];
            b[j] -= f * b[i];
        }
    for (int i = count - 1; i >= 0; --i) {
        for (int k = i + 1; k <= i + BAND && k < count; ++k) b[i] -= a[i][k - i + BAND] * b[k];
        b[i] /= a[i][BAND];
    }
}

// Adds a link between particles j - 1 and j to 1 + H and to the right-hand side, both times `acts`
// (s^2). The root is not an unknown: it moves by `root_move`.
static void assemble(const Link *link, int j, double acts, const Vec root_move,
                     double (*a)[2 * BAND + 1], double *b)
{
    Vec force;
    double along = link->k / 2,
           across = link->k / 2 * fmin(fabs(1 - link->l / link->m), 1) + link->b / link->l;
    int end = 3 * (j - 1), begin = end - 3;
    link_force(link, force);
    for (int r = 0; r < 3; ++r) {
        b[end + r] += acts * force[r];
        if (j > 1) b[begin + r] -= acts * force[r];
        for (int c = 0; c < 3; ++c) {
            double h = acts * ((r == c ? across : 0) + (along - across) * link->u[r] * link->u[c]);
            a[end + r][c - r + BAND] += h;
            if (j == 1) {
                b[end + r] += h * root_move[c];
                continue;
            }
            a[begin + r][c - r + BAND] += h;
            a[begin + r][c + 3 - r + BAND] -= h;
            a[end + r][c - 3 - r + BAND] -= h;
        }
    }
}

static double acting_time(const TwinStep *step)
{
    double h = step->first ? step->dt / 2 : step->dt, c = step->drag;
    return c > 0 ? -expm1(-c * h) / c : h;
}

// (1 + H) D = h v* + h^2 f F(x), where D are the displacements in this step and v* the velocities
// without springs.
void reference_spring_implicit_step(TwinStrand *strand, const TwinStep *step,
                                    const SectionParams *params)
{
    static double a[SIZE][2 * BAND + 1], b[SIZE];
    int count = 3 * (strand->n - 1);
    Vec root, root_move;
    memset(a, 0, sizeof a);
    memset(b, 0, sizeof b);
    twin_style(strand, &step->head, 0, root);
    vec_add_scaled(root, -1, strand->x[0], root_move);
    for (int i = 0; i < count; ++i) a[i][BAND] = 1;
    for (int j = 1; j < strand->n; ++j) {
        Link link = link_of(strand, &step->head, params, j);
        twin_kick(strand->v[j], step, step->first ? step->dt / 2 : step->dt);
        vec_add_scaled(&b[3 * (j - 1)], step->dt, strand->v[j], &b[3 * (j - 1)]);
        assemble(&link, j, step->dt * acting_time(step), root_move, a, b);
    }
    solve_banded(a, b, count);
    vec_copy(root, strand->x[0]);
    for (int j = 1; j < strand->n; ++j)
        for (int k = 0; k < 3; ++k) {
            strand->x[j][k] += b[3 * (j - 1) + k];
            strand->v[j][k] = b[3 * (j - 1) + k] / step->dt;
        }
}

// Interpolates two poses: translation linearly, rotation at constant speed.
static HeadPose pose_between(const HeadPose *from, const HeadPose *to, double share)
{
    HeadPose pose = {.translation = {0}};
    double cosine = 0;
    for (int k = 0; k < 4; ++k) cosine += (double)from->rotation[k] * (double)to->rotation[k];
    double angle = acos(fmin(1, cosine)), sine = sin(angle);
    double a = sine > 1e-9 ? sin((1 - share) * angle) / sine : 1 - share,
           b = sine > 1e-9 ? sin(share * angle) / sine : share;
    for (int k = 0; k < 4; ++k)
        pose.rotation[k] = (float)(a * (double)from->rotation[k] + b * (double)to->rotation[k]);
    for (int k = 0; k < 3; ++k)
        pose.translation[k] = (float)((1 - share) * (double)from->translation[k] +
                                      share * (double)to->translation[k]);
    return pose;
}

static void symplectic_euler(TwinStrand *strand, const TwinStep *step, const HeadPose *head,
                             const SectionParams *params)
{
    Vec force[TWIN_MAX + 1] = {{0}};
    double softness = 0; // a quarter of an average link's length
    for (int j = 1; j < strand->n; ++j) softness += strand->length[j] / (strand->n - 1) / 4;
    for (int j = 1; j < strand->n; ++j) {
        Link link = link_of(strand, head, params, j);
        conservative_force(&link, softness, force[j]);
    }
    twin_style(strand, head, 0, strand->x[0]);
    for (int j = 1; j < strand->n; ++j) {
        twin_kick(strand->v[j], step, step->first ? step->dt / 2 : step->dt);
        vec_add_scaled(strand->v[j], acting_time(step), force[j], strand->v[j]);
        vec_add_scaled(strand->v[j], -acting_time(step), force[j + 1], strand->v[j]);
        vec_add_scaled(strand->x[j], step->dt, strand->v[j], strand->x[j]);
    }
}

void reference_spring_explicit_step(TwinStrand *strand, const TwinStep *step,
                                    const SectionParams *params)
{
    double omega = (strand->n - 1) * sqrt(2.5 * (double)params->spring_coil);
    int count = (int)ceil(step->dt * omega / 1.6);
    TwinStep part = *step;
    part.dt = step->dt / count;
    for (int i = 1; i <= count; ++i) {
        HeadPose head = pose_between(&step->head_old, &step->head, (double)i / count);
        symplectic_euler(strand, &part, &head, params);
        part.first = false;
    }
}
