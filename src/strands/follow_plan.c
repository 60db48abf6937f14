// SPDX-License-Identifier: MIT
#include "strands/follow_plan.h"

#include "strands/paint.h"

#include "base/double3.h"
#include "base/nearest.h"
#include "base/random.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    NEIGHBOURS = 32,
    MOST_TRIANGLES = NEIGHBOURS * (NEIGHBOURS - 1) / 2,
    RADIUS_SAMPLES = 256,
    FEWEST_FILLED = 32,     // strands; fewer are wisps, not a groom
    MOST_FILLED = 5000,     // strands; from here on, guides alone cover the scalp
    FRAME_SEGMENTS = 16000, // cost of the rest of a 1280x720 frame, in drawn segments
    SHARE_NEIGHBOURS = 16
};
static const double MOST_SIDE = 6;  // longest side of a triangle between guides, in follower radii
static const double ROUNDED = 1e-3; // of the squared distances of roots
// Two strands agree if the cosine of the angle between their chords is at least this.
static const double LEAST_COSINE = 0.5;

static float find_radius(const SectionParams *params, const Strands *strands)
{
    if (!params->follower_radius.automatic) return params->follower_radius.value;
    return strands->follower_radius > 0 ? strands->follower_radius
                                        : follow_plan_auto_radius(strands);
}

uint32_t follow_plan_fill(const Strands *strands)
{
    uint32_t count = strands->strand_count;
    if (count < FEWEST_FILLED || count >= MOST_FILLED) return 0;
    double segments = strands->vertex_count - count;
    double most = floor(2 * (segments + FRAME_SEGMENTS) / segments);
    return (uint32_t)fmin(most, 2.0 * MOST_FILLED / count);
}

// Whether the number is automatic and above 0, unless a fibre radius is given.
static bool may_fill(const SectionParams *params, const Strands *strands)
{
    return params->followers.automatic && !strands->followers && follow_plan_fill(strands) > 0;
}

// Whether neither the user nor the file gives the width of the fibres.
static bool has_automatic_width(const SectionParams *params, const Strands *strands)
{
    return params->radius.automatic && !(paint_file_radius(params, strands) > 0);
}

bool follow_plan_fills(const SectionParams *params, const Strands *strands)
{
    return has_automatic_width(params, strands) && may_fill(params, strands);
}

void follow_plan_tell_gaps(const SectionParams *params, const Strands *strands, const char *name,
                           FILE *stream)
{
    if (has_automatic_width(params, strands) || !may_fill(params, strands)) return;
    fprintf(stream,
            "%s: the space between %u strands is not filled because %s: --followers "
            "%u --follow interpolate fills it\n",
            name, strands->strand_count,
            params->radius.automatic ? "the file has widths" : "--radius is given",
            follow_plan_fill(strands));
}

FollowOptions follow_plan_options(const SectionParams *params, const Strands *strands,
                                  uint32_t seed)
{
    FollowOptions options = {.seed = seed};
    bool given = !params->followers.automatic && params->followers.value >= 0;
    options.per_guide = given ? (uint32_t)params->followers.value : strands->followers;
    bool fills = follow_plan_fills(params, strands);
    if (fills) options.per_guide = follow_plan_fill(strands);
    options.interpolate =
        params->follow == FOLLOW_INTERPOLATE || (params->follow == FOLLOW_AUTO && fills);
    if (options.per_guide) options.radius = find_radius(params, strands);
    return options;
}

float follow_plan_reach(const SectionParams *params, const Strands *strands)
{
    FollowOptions options = follow_plan_options(params, strands, 0);
    return options.radius * fmaxf(1, 1 + params->tip_separation);
}

// Two unit vectors perpendicular to `normal` (any length but 0) and to each other: those of a fixed
// frame, turned by the smallest rotation from its axis c to the normal. It changes smoothly with
// the normal except opposite to c, a direction that no hair has on purpose: were it an axis of the
// world, rounding would decide how followers lie around straight hair.
static void span_plane(const Double3 normal, Double3 u, Double3 v)
{
    static const Double3 c = {0.36, 0.48, 0.8}, side[2] = {{0.8, -0.6, 0}, {0.48, 0.64, -0.6}};
    double length = sqrt(double3_dot(normal, normal)), *spans[2] = {u, v};
    double opposite = 1 + double3_dot(c, normal) / length;
    for (int i = 0; i < 2; ++i) {
        double share = double3_dot(side[i], normal) / length / opposite;
        for (int k = 0; k < 3; ++k)
            spans[i][k] = side[i][k] - (opposite > 1e-12 ? share * (c[k] + normal[k] / length) : 0);
    }
}

static const float *vertex(const Strands *strands, uint32_t s, uint32_t j)
{
    return strands->position[strands->first[s] + j];
}

// The vector from the root of strand s to its vertex j.
static void chord(const Strands *strands, uint32_t s, uint32_t j, Double3 way)
{
    const float *root = vertex(strands, s, 0), *end = vertex(strands, s, j);
    for (int k = 0; k < 3; ++k) way[k] = (double)end[k] - (double)root[k];
}

// A triangle between a guide's root and the roots of two of its neighbours.
typedef struct Triangle {
    uint32_t second, third;
    double area;
} Triangle;

typedef struct Fan {
    Triangle triangle[MOST_TRIANGLES];
    uint32_t count;
    double area;
} Fan;

// A guide's neighbours. Positions are relative to the guide's root.
typedef struct Neighbourhood {
    uint32_t count;
    Neighbour neighbour[NEIGHBOURS];
    Double3 at[NEIGHBOURS];     // m
    double flat[NEIGHBOURS][2]; // m, projected onto the plane that fits the points best
} Neighbourhood;

// The direction in which the points spread least: the eigenvector of C = sum x x^T with the
// smallest eigenvalue. It is found by power iteration with (trace C) I - C.
static void least_spread(const Neighbourhood *around, Double3 normal)
{
    double c[3][3] = {{0}};
    Double3 next, fit = {0.36, 0.48, 0.8};
    for (uint32_t i = 0; i < around->count; ++i)
        for (int k = 0; k < 9; ++k) c[k / 3][k % 3] += around->at[i][k / 3] * around->at[i][k % 3];
    double trace = c[0][0] + c[1][1] + c[2][2];
    for (int turn = 0; turn < 50 && trace > 0; ++turn) {
        for (int k = 0; k < 3; ++k) next[k] = fit[k] - double3_dot(c[k], fit) / trace;
        double length = sqrt(double3_dot(next, next));
        if (!(length > 0)) break;
        for (int k = 0; k < 3; ++k) fit[k] = next[k] / length;
    }
    double3_copy(fit, normal);
}

static int by_number(const void *a, const void *b)
{
    uint32_t x = ((const Neighbour *)a)->point, y = ((const Neighbour *)b)->point;
    return (x > y) - (x < y);
}

// Neighbours in the order of the strands: rounding decides which of two is nearer where roots stand
// in rows.
static void look_around(Neighbourhood *around, const Nearest *roots, uint32_t guide)
{
    around->count = nearest_find(roots, guide, around->neighbour, NEIGHBOURS);
    qsort(around->neighbour, around->count, sizeof *around->neighbour, by_number);
    for (uint32_t i = 0; i < around->count; ++i)
        for (int k = 0; k < 3; ++k)
            around->at[i][k] = (double)roots->point[around->neighbour[i].point][k] -
                               (double)roots->point[guide][k];
    Double3 normal, u, v;
    least_spread(around, normal);
    span_plane(normal, u, v);
    for (uint32_t i = 0; i < around->count; ++i)
        around->flat[i][0] = double3_dot(around->at[i], u),
        around->flat[i][1] = double3_dot(around->at[i], v);
}

// Whether the circle through the origin, a and b contains none of the other points. Its centre m
// solves 2 m.a = a.a and 2 m.b = b.b, and a point p is inside if p.p < 2 m.p. A point on the circle
// counts as outside, and so does one that rounding of a file could have moved into it: otherwise
// rounding would choose the diagonals where roots stand in rows.
static bool is_delaunay(const Neighbourhood *around, uint32_t i, uint32_t j, double *area)
{
    const double *a = around->flat[i], *b = around->flat[j];
    double aa = a[0] * a[0] + a[1] * a[1], bb = b[0] * b[0] + b[1] * b[1];
    double twice = a[0] * b[1] - a[1] * b[0];
    // The three points are collinear.
    if (!(fabs(twice) > 1e-6 * (aa + bb))) return false;
    double x = (aa * b[1] - bb * a[1]) / twice, y = (bb * a[0] - aa * b[0]) / twice; // 2 m
    for (uint32_t k = 0; k < around->count; ++k) {
        const double *p = around->flat[k];
        double pp = p[0] * p[0] + p[1] * p[1];
        if (k != i && k != j && pp < (1 - ROUNDED) * (x * p[0] + y * p[1])) return false;
    }
    *area = fabs(twice) / 2;
    return true;
}

// Whether two strands point in similar directions, at half their length and at the tip. A follower
// between strands that diverge would float in the gap between them.
static bool agree(const Strands *strands, uint32_t s, uint32_t t)
{
    uint32_t n = strands_size(strands, s);
    for (int part = 1; part <= 2; ++part) {
        Double3 a, b;
        chord(strands, s, part * (n - 1) / 2, a);
        chord(strands, t, part * (n - 1) / 2, b);
        if (double3_dot(a, b) < LEAST_COSINE * sqrt(double3_dot(a, a) * double3_dot(b, b)))
            return false;
    }
    return true;
}

static bool side_is_short(const Neighbourhood *around, uint32_t i, uint32_t j, double most)
{
    Double3 side;
    for (int k = 0; k < 3; ++k) side[k] = around->at[i][k] - around->at[j][k];
    return double3_dot(side, side) <= most * most;
}

static void find_fan(Fan *fan, const Strands *strands, const uint32_t *guides, const Nearest *roots,
                     uint32_t guide, double most_side)
{
    Neighbourhood around;
    look_around(&around, roots, guide);
    bool near[NEIGHBOURS];
    fan->count = 0, fan->area = 0;
    for (uint32_t i = 0; i < around.count; ++i)
        near[i] = around.neighbour[i].square <= most_side * most_side &&
                  agree(strands, guides[guide], guides[around.neighbour[i].point]);
    for (uint32_t i = 0; i < around.count; ++i)
        for (uint32_t j = i + 1; j < around.count && near[i]; ++j) {
            uint32_t second = around.neighbour[i].point, third = around.neighbour[j].point;
            double area;
            if (!near[j] || !side_is_short(&around, i, j, most_side) ||
                !agree(strands, guides[second], guides[third]) ||
                !is_delaunay(&around, i, j, &area))
                continue;
            fan->triangle[fan->count++] = (Triangle){second, third, area};
            fan->area += area;
        }
}

// Picks a triangle of the fan with a probability proportional to its area, and a point uniformly
// within it. Then rotates the weights so that the guide has the largest one: this maps the other
// two thirds of the triangle onto the third next to the guide.
static void place_between(Follower *follower, const Fan *fan, Random *random)
{
    double choice = random_real(random) * fan->area;
    uint32_t t = 0;
    while (t + 1 < fan->count && choice >= fan->triangle[t].area) choice -= fan->triangle[t++].area;
    double root = sqrt(random_real(random)), share = random_real(random);
    double weight[3] = {1 - root, root * (1 - share), root * share};
    int first = 0;
    for (int k = 1; k < 3; ++k)
        if (weight[k] > weight[first]) first = k;
    follower->guide[1] = fan->triangle[t].second;
    follower->guide[2] = fan->triangle[t].third;
    for (int k = 0; k < 3; ++k) follower->weight[k] = (float)weight[(first + k) % 3];
}

static void place_beside(Follower *follower, const Strands *strands, uint32_t s, double radius,
                         Random *random)
{
    Double3 along, u, v;
    chord(strands, s, 1, along);
    span_plane(along, u, v);
    double from = radius * sqrt(random_real(random));
    double angle = 6.283185307179586 * random_real(random);
    for (int k = 0; k < 3; ++k)
        follower->offset[k] = (float)(from * (cos(angle) * u[k] + sin(angle) * v[k]));
}

static void plan_guide(FollowPlan *plan, const Strands *strands, uint32_t s, uint32_t guide,
                       const Fan *fan, const FollowOptions *options)
{
    Random random = random_create(options->seed, s);
    for (uint32_t i = 0; i < options->per_guide; ++i) {
        Follower *follower = &plan->follower[(size_t)guide * options->per_guide + i];
        *follower = (Follower){.guide = {guide, guide, guide}, .weight = {1, 0, 0}};
        follower->id = (uint32_t)random_next(&random);
        if (fan->count)
            place_between(follower, fan, &random);
        else
            place_beside(follower, strands, s, (double)options->radius, &random);
    }
}

// The roots of the guides and a search tree over them. Both are NULL on failure.
static Result collect_roots(float (**root)[3], Nearest *nearest, const Strands *strands,
                            const uint32_t *guides, uint32_t count, Error *error)
{
    *nearest = (Nearest){0};
    *root = malloc(((size_t)count + 1) * sizeof **root);
    if (!*root) return error_set(error, RESULT_FAILED, "no memory for %u roots", count);
    for (uint32_t i = 0; i < count; ++i)
        memcpy((*root)[i], vertex(strands, guides[i], 0), sizeof **root);
    return nearest_create(nearest, (const float(*)[3]) * root, count, error);
}

Result follow_plan_create(FollowPlan *plan, const Strands *strands, const uint32_t *guides,
                          uint32_t count, const FollowOptions *options, Error *error)
{
    float(*root)[3] = NULL;
    Nearest nearest = {0};
    Result result = RESULT_OK;
    *plan = (FollowPlan){.per_guide = options->per_guide};
    plan->follower = malloc(((size_t)count * options->per_guide + 1) * sizeof *plan->follower);
    if (!plan->follower)
        result = error_set(error, RESULT_FAILED, "no memory for %u followers of %u strands",
                           options->per_guide, count);
    if (result == RESULT_OK && options->interpolate)
        result = collect_roots(&root, &nearest, strands, guides, count, error);
    for (uint32_t i = 0; i < count && result == RESULT_OK; ++i) {
        Fan fan = {.count = 0};
        if (options->interpolate)
            find_fan(&fan, strands, guides, &nearest, i, MOST_SIDE * (double)options->radius);
        plan_guide(plan, strands, guides[i], i, &fan, options);
    }
    nearest_destroy(&nearest);
    free(root);
    if (result != RESULT_OK) follow_plan_destroy(plan);
    return result;
}

void follow_plan_destroy(FollowPlan *plan)
{
    free(plan->follower);
    *plan = (FollowPlan){0};
}

// The radius of a disc with the area that one root takes up on the scalp around strand s: the area
// up to its k-th neighbour, divided by k. Neighbours at the same position do not count; returns 0
// if there are no others. One nearest neighbour alone would mislead where roots stand in rows.
static double share_radius(const Strands *strands, uint32_t s)
{
    const float *from = vertex(strands, s, 0);
    float nearest[SHARE_NEIGHBOURS]; // squares, ascending
    int count = 0;
    for (uint32_t t = 0; t < strands->strand_count; ++t) {
        const float *to = vertex(strands, t, 0);
        float square = 0;
        for (int k = 0; k < 3; ++k) square += (to[k] - from[k]) * (to[k] - from[k]);
        bool full = count == SHARE_NEIGHBOURS;
        if (!(square > 0) || (full && square >= nearest[count - 1])) continue;
        int at = full ? count - 1 : count++;
        for (; at > 0 && nearest[at - 1] > square; --at) nearest[at] = nearest[at - 1];
        nearest[at] = square;
    }
    return count ? sqrt((double)nearest[count - 1] / count) : 0;
}

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

float follow_plan_auto_radius(const Strands *strands)
{
    double distance[RADIUS_SAMPLES], longest = 0;
    uint32_t stride = strands->strand_count / RADIUS_SAMPLES + 1, count = 0;
    for (uint32_t s = 0; s < strands->strand_count; s += stride) {
        double found = share_radius(strands, s);
        if (found > 0) distance[count++] = found;
    }
    if (count) {
        qsort(distance, count, sizeof *distance, compare);
        return (float)distance[count / 2];
    }
    for (uint32_t s = 0; s < strands->strand_count; ++s)
        longest = fmax(longest, strands_length(strands, s));
    return longest > 0 ? (float)(longest / 50) : 1e-3f;
}
