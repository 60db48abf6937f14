// SPDX-License-Identifier: MIT
#include "strands/scalp_fit.h"

#include "base/doubles.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { UNKNOWNS = 6, MOST_ROOTS = 4096, FEWEST_ROOTS = 32, PASSES = 20 };
static const double STIFFNESS = 0.02;            // of the regularisation, per unit of weight
static const double HUBER = 1.345;               // 95 % efficiency for normal errors
static const double LEAST = 0.05, MOST = 0.4;    // m, permitted range of the radii
static const double MOST_RATIO = 2;              // of the largest to the smallest radius
static const double MOST_ERROR = 0.04;           // median distance over mean radius
static const double ONE_WAY = 0.9, AROUND = 0.2; // length of the mean unit vector to the roots
static const double LEAST_UP = 0.1;              // y of that vector
static const double LEAST_OUT = 0.05;            // mean cosine of first segment and normal
// A vertex counts as inside below DEEP of the radius; at most MOST_INSIDE of all vertices may be.
static const double DEEP = 0.9, MOST_INSIDE = 0.1;

// Roots and the unit directions of their first segments.
typedef struct Roots {
    double (*at)[3], (*way)[3];
    double *distance, *weight;
    uint32_t count;
    // m; `at` holds (position - middle) / scale.
    double middle[3], scale;
} Roots;

static void take_root(Roots *roots, const Strands *strands, uint32_t s)
{
    const float *a = strands->position[strands->first[s]],
                *b = strands->position[strands->first[s] + 1];
    double length = 0, *way = roots->way[roots->count];
    for (int k = 0; k < 3; ++k) {
        roots->at[roots->count][k] = (double)a[k];
        way[k] = (double)b[k] - (double)a[k];
        length += way[k] * way[k];
    }
    // Not 0: reading removed coincident neighbours.
    for (int k = 0; k < 3; ++k) way[k] /= sqrt(length);
    roots->weight[roots->count++] = 1;
}

static bool collect(Roots *roots, const Strands *strands, uint32_t sets)
{
    uint64_t all = 0;
    for (uint32_t i = 0; i < sets; ++i) all += strands[i].strand_count;
    uint32_t stride = (uint32_t)(all / MOST_ROOTS) + 1;
    size_t room = (size_t)(all / stride) + sets + 1;
    roots->at = malloc(room * sizeof *roots->at);
    roots->way = malloc(room * sizeof *roots->way);
    roots->distance = malloc(room * sizeof *roots->distance);
    roots->weight = malloc(room * sizeof *roots->weight);
    if (!roots->at || !roots->way || !roots->distance || !roots->weight) return false;
    for (uint32_t i = 0; i < sets; ++i)
        for (uint32_t s = 0; s < strands[i].strand_count; s += stride)
            take_root(roots, &strands[i], s);
    return true;
}

// Centres the roots and scales them to unit size, which keeps the equations well conditioned.
static void normalise(Roots *roots)
{
    double square = 0;
    for (uint32_t i = 0; i < roots->count; ++i)
        for (int k = 0; k < 3; ++k) roots->middle[k] += roots->at[i][k] / roots->count;
    for (uint32_t i = 0; i < roots->count; ++i)
        for (int k = 0; k < 3; ++k) {
            roots->at[i][k] -= roots->middle[k];
            square += roots->at[i][k] * roots->at[i][k];
        }
    roots->scale = sqrt(square / roots->count);
    for (uint32_t i = 0; i < roots->count; ++i)
        for (int k = 0; k < 3; ++k) roots->at[i][k] /= roots->scale;
}

// Gaussian elimination with pivoting; false if the matrix is singular.
static bool solve(double m[UNKNOWNS][UNKNOWNS + 1], double x[UNKNOWNS])
{
    for (int i = 0; i < UNKNOWNS; ++i) {
        int pivot = i;
        for (int j = i + 1; j < UNKNOWNS; ++j)
            if (fabs(m[j][i]) > fabs(m[pivot][i])) pivot = j;
        if (!(fabs(m[pivot][i]) > 1e-12)) return false;
        for (int k = 0; k <= UNKNOWNS; ++k) {
            double swap = m[i][k];
            m[i][k] = m[pivot][k], m[pivot][k] = swap;
        }
        for (int j = i + 1; j < UNKNOWNS; ++j) {
            double factor = m[j][i] / m[i][i];
            for (int k = i; k <= UNKNOWNS; ++k) m[j][k] -= factor * m[i][k];
        }
    }
    for (int i = UNKNOWNS - 1; i >= 0; --i) {
        x[i] = m[i][UNKNOWNS];
        for (int k = i + 1; k < UNKNOWNS; ++k) x[i] -= m[i][k] * x[k];
        x[i] /= m[i][i];
    }
    return true;
}

// Solves the weighted equations for an ellipsoid, in the normalised units of the roots. False if
// the solution is not an ellipsoid.
static bool fit_once(const Roots *roots, double centre[3], double radius[3])
{
    double m[UNKNOWNS][UNKNOWNS + 1] = {{0}}, x[UNKNOWNS], total = 0;
    for (uint32_t i = 0; i < roots->count; ++i) {
        const double *p = roots->at[i];
        double square = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
        double row[UNKNOWNS + 1] = {
            2 * p[0], 2 * p[1], 2 * p[2], 1, p[0] * p[0] - square / 3, p[1] * p[1] - square / 3,
            square};
        for (int j = 0; j < UNKNOWNS; ++j)
            for (int k = 0; k <= UNKNOWNS; ++k) m[j][k] += roots->weight[i] * row[j] * row[k];
        total += roots->weight[i];
    }
    m[4][4] += STIFFNESS * total, m[5][5] += STIFFNESS * total;
    if (!solve(m, x)) return false;
    double third = 1 + (x[4] + x[5]) / 3, of[3] = {third - x[4], third - x[5], third}, rest = x[3];
    for (int k = 0; k < 3; ++k) {
        if (!(of[k] > 0)) return false;
        centre[k] = x[k] / of[k];
        rest += x[k] * centre[k];
    }
    if (!(rest > 0)) return false;
    for (int k = 0; k < 3; ++k) radius[k] = sqrt(rest / of[k]);
    return true;
}

static double mean_radius(const double radius[3])
{
    return cbrt(radius[0] * radius[1] * radius[2]);
}

// The distance of p from the centre as a share of the distance to the surface in that direction: 1
// on the surface.
static double share_out(const double p[3], const double centre[3], const double radius[3])
{
    double square = 0;
    for (int k = 0; k < 3; ++k) square += pow((p[k] - centre[k]) / radius[k], 2);
    return sqrt(square);
}

// Sorts the distances and returns the quantile `share`.
static double quantile(Roots *roots, double share)
{
    doubles_sort(roots->distance, roots->count);
    return roots->distance[(uint32_t)(share * (roots->count - 1))];
}

static void measure(Roots *roots, const double centre[3], const double radius[3], bool weigh)
{
    double size = mean_radius(radius);
    for (uint32_t i = 0; i < roots->count; ++i)
        roots->distance[i] = fabs(share_out(roots->at[i], centre, radius) - 1) * size;
    if (!weigh) return;
    double scale = HUBER * 1.4826 * quantile(roots, 0.5);
    for (uint32_t i = 0; i < roots->count; ++i) {
        double off = fabs(share_out(roots->at[i], centre, radius) - 1) * size;
        roots->weight[i] = off > scale ? scale / off : 1;
    }
}

// --- Checks that the ellipsoid is a head.

// Where the roots lie around the ellipsoid, and where their strands leave.
typedef struct Directions {
    double together, up; // length and y of the mean unit vector from the centre to the roots
    double out;          // mean cosine of first segment and normal
} Directions;

static Directions find_directions(const Roots *roots, const double centre[3],
                                  const double radius[3])
{
    double mean[3] = {0}, out = 0;
    for (uint32_t i = 0; i < roots->count; ++i) {
        double normal[3], length = 0, way[3], square = 0;
        for (int k = 0; k < 3; ++k) {
            way[k] = roots->at[i][k] - centre[k];
            normal[k] = way[k] / (radius[k] * radius[k]);
            length += normal[k] * normal[k], square += way[k] * way[k];
        }
        for (int k = 0; k < 3; ++k) {
            mean[k] += way[k] / sqrt(square) / roots->count;
            out += normal[k] / sqrt(length) * roots->way[i][k] / roots->count;
        }
    }
    double together = sqrt(mean[0] * mean[0] + mean[1] * mean[1] + mean[2] * mean[2]);
    return (Directions){.together = together, .up = mean[1], .out = out};
}

static const char *judge_directions(const Directions *found)
{
    if (found->together > ONE_WAY) return "the roots are a patch";
    if (found->together < AROUND || found->up < LEAST_UP) return "the roots are not on top";
    return found->out < LEAST_OUT ? "strands do not leave outwards" : NULL;
}

static const char *judge_form(const double radius[3], double error)
{
    double least = fmin(radius[0], fmin(radius[1], radius[2])),
           most = fmax(radius[0], fmax(radius[1], radius[2]));
    if (most > MOST_RATIO * least) return "the ellipsoid is too long";
    return error > MOST_ERROR * mean_radius(radius) ? "the roots are too far from the ellipsoid"
                                                    : NULL;
}

static bool is_size_of_head(const double radius[3])
{
    return fmin(radius[0], fmin(radius[1], radius[2])) >= LEAST &&
           fmax(radius[0], fmax(radius[1], radius[2])) <= MOST;
}

static const char *judge_vertices(const Strands *strands, uint32_t sets, const ScalpFit *fit)
{
    uint64_t inside = 0, all = 0;
    for (uint32_t i = 0; i < sets; ++i)
        for (uint32_t v = 0; v < strands[i].vertex_count; ++v) {
            const float *at = strands[i].position[v];
            double p[3] = {(double)at[0], (double)at[1], (double)at[2]};
            inside += share_out(p, fit->centre, fit->radius) < DEEP;
            ++all;
        }
    return (double)inside > MOST_INSIDE * (double)all ? "too much hair is inside the ellipsoid"
                                                      : NULL;
}

static void destroy(Roots *roots)
{
    free(roots->at);
    free(roots->way);
    free(roots->distance);
    free(roots->weight);
}

static const char *fit_roots(ScalpFit *fit, Roots *roots)
{
    double centre[3], radius[3];
    if (roots->count < FEWEST_ROOTS) return "there are too few roots";
    normalise(roots);
    if (!(roots->scale > 0)) return "all roots coincide";
    for (int pass = 0; pass < PASSES; ++pass) {
        if (!fit_once(roots, centre, radius)) return "no ellipsoid fits the roots";
        measure(roots, centre, radius, true);
    }
    measure(roots, centre, radius, false);
    fit->error = quantile(roots, 0.5) * roots->scale;
    double sunk = quantile(roots, 0.9) * roots->scale;
    for (int k = 0; k < 3; ++k) {
        fit->centre[k] = roots->middle[k] + roots->scale * centre[k];
        fit->radius[k] = roots->scale * radius[k];
    }
    const Directions found = find_directions(roots, centre, radius);
    fit->around = found.together < AROUND && found.out >= LEAST_OUT;
    const char *reason = judge_form(fit->radius, fit->error);
    if (!reason) reason = judge_directions(&found);
    for (int k = 0; k < 3 && !reason; ++k) fit->radius[k] -= sunk;
    return reason;
}

ScalpFit scalp_fit(const Strands *strands, uint32_t count)
{
    ScalpFit fit = {0};
    Roots roots = {0};
    fit.reason = collect(&roots, strands, count) ? fit_roots(&fit, &roots) : "memory is short";
    destroy(&roots);
    if (!fit.reason) fit.reason = judge_vertices(strands, count, &fit);
    if (!fit.reason && !is_size_of_head(fit.radius)) {
        fit.reason = "it would not be as large as a head";
        fit.other_size = true;
    }
    fit.found = !fit.reason;
    return fit;
}
