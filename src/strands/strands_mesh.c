// SPDX-License-Identifier: MIT
#include "strands/strands_mesh.h"

#include "base/double3.h"
#include "base/doubles.h"
#include "base/parallel.h"
#include "mesh/mesh_binding.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Sorts the values; returns 0 if there are none.
static double median_of(double *values, size_t count)
{
    doubles_sort(values, count);
    return count ? values[(count - 1) / 2] : 0;
}

// --- Attaching and pushing, each strand for itself, on all threads.

typedef struct Work {
    Strands *strands;
    const Surface *surface;
    double gap;
    // [vertex_count] Distances from the surface before anything was moved. When attaching, only the
    // entries of the roots are set.
    double *distance;
    bool attaches, pushes;
} Work;

static void attach_strand(const Work *work, uint32_t s)
{
    Strands *strands = work->strands;
    uint32_t root = strands->first[s];
    SurfacePoint nearest = {0};
    Double3 from, shift;
    double3_from_float(strands->position[root], from);
    work->distance[root] = fabs(surface_nearest(work->surface, from, &nearest));
    double3_subtract(nearest.place, from, shift);
    for (uint32_t v = root; v < strands->first[s + 1]; ++v)
        for (int k = 0; k < 3; ++k)
            strands->position[v][k] = (float)(strands->position[v][k] + shift[k]);
}

// Pushes the vertex away from its nearest point until it is `gap` outside the surface. Repeats,
// because after a push another part of the surface may be nearer.
static void push_vertex(const Surface *surface, double gap, double distance, SurfacePoint *nearest,
                        float position[3])
{
    enum { MOST_TRIES = 8 };
    Double3 at, way;
    double3_from_float(position, at);
    for (int i = 0; i < MOST_TRIES && distance < gap; ++i) {
        double3_subtract(at, nearest->place, way);
        // At a distance of 0 there is no direction, so take the surface normal; from inside, the
        // direction to the nearest point leads outwards.
        if (double3_normalize(way) < 1e-9)
            surface_normal(surface, nearest, way);
        else if (distance < 0)
            for (int k = 0; k < 3; ++k) way[k] = -way[k];
        double3_copy(nearest->place, at);
        double3_add_scaled(at, gap * (1 + 1e-6) + 1e-7, way);
        distance = surface_nearest(surface, at, nearest);
    }
    for (int k = 0; k < 3; ++k) position[k] = (float)at[k];
}

static void visit_strand(const Work *work, uint32_t s)
{
    Strands *strands = work->strands;
    SurfacePoint nearest = {0};
    if (work->attaches) {
        attach_strand(work, s);
        return;
    }
    work->distance[strands->first[s]] = INFINITY;
    for (uint32_t v = strands->first[s] + 1; v < strands->first[s + 1]; ++v) {
        Double3 at;
        double3_from_float(strands->position[v], at);
        double distance = work->distance[v] = surface_nearest(work->surface, at, &nearest);
        if (work->pushes && distance < work->gap)
            push_vertex(work->surface, work->gap, distance, &nearest, strands->position[v]);
    }
}

static void visit_part(void *data, int part)
{
    const Work *work = data;
    uint64_t count = work->strands->strand_count, parts = PARALLEL_MOST;
    for (uint64_t s = count * (uint64_t)part / parts; s < count * ((uint64_t)part + 1) / parts; ++s)
        visit_strand(work, (uint32_t)s);
}

static Result visit(Work *work, Error *error)
{
    work->distance = malloc(((size_t)work->strands->vertex_count + 1) * sizeof *work->distance);
    if (!work->distance)
        return error_set(error, RESULT_FAILED, "no memory for distances from the mesh");
    parallel_run(PARALLEL_MOST, visit_part, work);
    return RESULT_OK;
}

Result strands_attach(Strands *strands, const Surface *surface, StrandsShift *shift, Error *error)
{
    Work work = {.strands = strands, .surface = surface, .attaches = true};
    TRY(visit(&work, error));
    uint32_t count = strands->strand_count;
    for (uint32_t s = 0; s < count; ++s) work.distance[s] = work.distance[strands->first[s]];
    *shift = (StrandsShift){.strands = count, .vertices = strands->vertex_count};
    shift->median = median_of(work.distance, count);
    shift->most = count ? work.distance[count - 1] : 0;
    free(work.distance);
    return RESULT_OK;
}

Result strands_push_out(Strands *strands, const Surface *surface, double gap, StrandsShift *shift,
                        Error *error)
{
    Work work = {.strands = strands, .surface = surface, .gap = gap, .pushes = true};
    TRY(visit(&work, error));
    *shift = (StrandsShift){0};
    size_t inside = 0;
    for (uint32_t s = 0; s < strands->strand_count; ++s) {
        bool changed = false;
        for (uint32_t v = strands->first[s]; v < strands->first[s + 1]; ++v) {
            double distance = work.distance[v];
            shift->vertices += distance < gap;
            changed = changed || distance < gap;
            // Overwrites only entries already read.
            if (distance < 0) work.distance[inside++] = -distance;
        }
        shift->strands += changed;
    }
    shift->median = median_of(work.distance, inside);
    shift->most = inside ? work.distance[inside - 1] : 0;
    free(work.distance);
    return RESULT_OK;
}

Result strands_find_depth(const Strands *strands, const Surface *surface, double *depth,
                          Error *error)
{
    // Neither flag is set, so the strands are not changed and the cast is safe.
    Work work = {.strands = (Strands *)(uintptr_t)strands, .surface = surface};
    TRY(visit(&work, error));
    for (uint32_t v = 0; v < strands->vertex_count; ++v) depth[v] = -work.distance[v];
    free(work.distance);
    return RESULT_OK;
}

// --- Fitting.

enum { MOST_ROOTS = 1000, ROUGH_STEPS = 20, FINE_STEPS = 60 };
static const double KEPT_SHARE = 0.9, MOST_STRETCH = 2, MOST_TURN_DEG = 45;
static const double START_SCALES[] = {1, 0.75, 1.33};

// Roots at their original (`root`) and current (`moved`) positions, their nearest points on the
// surface (`near`) and the distances. `from`, `to` and `normal` hold only the pairs that count.
typedef struct Pairs {
    uint32_t count, kept;
    double (*root)[3], (*moved)[3], (*near)[3], (*from)[3], (*to)[3], (*normal)[3];
    double *distance, *sorted; // negative inside
    SurfacePoint *hint;        // the last nearest point, where the next search begins
} Pairs;

static void destroy_pairs(Pairs *pairs)
{
    free(pairs->root);
    free(pairs->distance);
    free(pairs->hint);
}

static bool create_pairs(Pairs *pairs, const Strands *strands)
{
    uint32_t stride = (strands->strand_count - 1) / MOST_ROOTS + 1;
    pairs->count = (strands->strand_count + stride - 1) / stride;
    pairs->root = malloc(6 * (size_t)pairs->count * sizeof *pairs->root);
    pairs->distance = malloc(2 * (size_t)pairs->count * sizeof *pairs->distance);
    pairs->hint = calloc(pairs->count, sizeof *pairs->hint);
    if (!pairs->root || !pairs->distance || !pairs->hint) return false;
    pairs->moved = pairs->root + pairs->count;
    pairs->near = pairs->moved + pairs->count;
    pairs->from = pairs->near + pairs->count;
    pairs->to = pairs->from + pairs->count;
    pairs->normal = pairs->to + pairs->count;
    pairs->sorted = pairs->distance + pairs->count;
    for (uint32_t i = 0; i < pairs->count; ++i)
        double3_from_float(strands->position[strands->first[i * stride]], pairs->root[i]);
    return true;
}

static void apply(const StrandsMove *move, const double from[3], double to[3])
{
    for (int i = 0; i < 3; ++i) {
        to[i] = move->translation[i];
        for (int k = 0; k < 3; ++k) to[i] += move->scale * move->rotation[i][k] * from[k];
    }
}

// Moves the roots and finds their nearest points. The farthest roots are left out as outliers; the
// first `kept` entries of `from`, `to`, `moved` and `normal` (direction to the surface) are those
// of the others. Returns the median distance of all.
static double pair_up(Pairs *pairs, const Surface *surface, const StrandsMove *move)
{
    for (uint32_t i = 0; i < pairs->count; ++i) {
        apply(move, pairs->root[i], pairs->moved[i]);
        pairs->distance[i] = surface_nearest(surface, pairs->moved[i], &pairs->hint[i]);
        pairs->sorted[i] = fabs(pairs->distance[i]);
        double3_copy(pairs->hint[i].place, pairs->near[i]);
        surface_normal(surface, &pairs->hint[i], pairs->normal[i]);
    }
    double median = median_of(pairs->sorted, pairs->count);
    double most = pairs->sorted[(uint32_t)(KEPT_SHARE * (pairs->count - 1))];
    pairs->kept = 0;
    for (uint32_t i = 0; i < pairs->count; ++i) {
        if (fabs(pairs->distance[i]) > most) continue;
        double3_copy(pairs->root[i], pairs->from[pairs->kept]);
        double3_copy(pairs->near[i], pairs->to[pairs->kept]);
        double3_copy(pairs->moved[i], pairs->moved[pairs->kept]);
        // Off the surface, the direction to the root is more reliable than the mesh's normal.
        Double3 way;
        double3_subtract(pairs->moved[i], pairs->near[i], way);
        if (double3_normalize(way) < 1e-6) double3_copy(pairs->normal[i], way);
        double3_copy(way, pairs->normal[pairs->kept++]);
    }
    return median;
}

static void find_middle(const double (*points)[3], uint32_t count, double middle[3])
{
    Double3 sum = {0, 0, 0};
    for (uint32_t i = 0; i < count; ++i) double3_add_scaled(sum, 1.0 / count, points[i]);
    double3_copy(sum, middle);
}

static double find_spread(const double (*points)[3], uint32_t count, const double middle[3])
{
    double sum = 0;
    for (uint32_t i = 0; i < count; ++i) {
        double apart = double3_distance(points[i], middle);
        sum += apart * apart;
    }
    return sqrt(sum / count);
}

// The best similarity from the kept roots to their nearest points.
static void improve(const Pairs *pairs, RigidMotion *turned, StrandsMove *move)
{
    Double3 from, to, back;
    const double(*roots)[3] = (const double(*)[3])pairs->from,
          (*near)[3] = (const double(*)[3])pairs->to;
    find_middle(roots, pairs->kept, from);
    find_middle(near, pairs->kept, to);
    double spread = find_spread(roots, pairs->kept, from);
    *turned = rigid_motion_fit(roots, near, pairs->kept, turned);
    double3_rotation(turned->rotation, move->rotation);
    if (spread > 0) move->scale = find_spread(near, pairs->kept, to) / spread;
    memset(move->translation, 0, sizeof move->translation);
    apply(move, from, back);
    double3_subtract(to, back, move->translation);
}

enum { UNKNOWNS = 7 }; // 3 of the rotation, 1 of the scale, 3 of the translation

// Solves A x = b by Gauss-Jordan elimination with partial pivoting. Unknowns that A leaves
// undetermined become 0.
static void solve(double a[UNKNOWNS][UNKNOWNS + 1], double x[UNKNOWNS])
{
    for (int k = 0; k < UNKNOWNS; ++k) {
        int best = k;
        for (int i = k + 1; i < UNKNOWNS; ++i)
            if (fabs(a[i][k]) > fabs(a[best][k])) best = i;
        for (int j = 0; j <= UNKNOWNS; ++j) {
            double kept = a[k][j];
            a[k][j] = a[best][j], a[best][j] = kept;
        }
        for (int i = 0; i < UNKNOWNS && a[k][k] != 0; ++i) {
            double factor = i == k ? 0 : a[i][k] / a[k][k];
            for (int j = k; j <= UNKNOWNS && factor != 0; ++j) a[i][j] -= factor * a[k][j];
        }
    }
    for (int k = 0; k < UNKNOWNS; ++k) x[k] = a[k][k] != 0 ? a[k][UNKNOWNS] / a[k][k] : 0;
}

// One step of point-to-plane ICP (Chen and Medioni 1992, "Object modelling by registration of
// multiple range images"): a small similarity about the centre of the roots that moves them onto
// the tangent planes of their nearest points, so that roots may slide along the surface.
static void slide(const Pairs *pairs, double damping, StrandsMove *move)
{
    Double3 middle;
    double a[UNKNOWNS][UNKNOWNS + 1] = {{0}}, x[UNKNOWNS], trace = 0;
    find_middle((const double(*)[3])pairs->moved, pairs->kept, middle);
    double size = find_spread((const double(*)[3])pairs->moved, pairs->kept, middle);
    for (uint32_t i = 0; i < pairs->kept; ++i) {
        const double *n = pairs->normal[i];
        Double3 at, off;
        double3_subtract(pairs->moved[i], middle, at);
        double3_subtract(pairs->to[i], pairs->moved[i], off);
        for (int k = 0; k < 3; ++k) at[k] /= size;
        Double3 turn;
        double3_cross(at, n, turn);
        const double row[UNKNOWNS] = {turn[0], turn[1], turn[2], double3_dot(at, n),
                                      n[0],    n[1],    n[2]};
        for (int j = 0; j < UNKNOWNS; ++j) {
            for (int k = 0; k < UNKNOWNS; ++k) a[j][k] += row[j] * row[k];
            a[j][UNKNOWNS] += row[j] * double3_dot(off, n) / size;
        }
    }
    for (int k = 0; k < UNKNOWNS; ++k) trace += a[k][k];
    for (int k = 0; k < UNKNOWNS; ++k) a[k][k] += damping * trace;
    solve(a, x);
    double angle = double3_length(x), half = angle / 2, sine = angle > 0 ? sin(half) / angle : 0;
    const double q[4] = {x[0] * sine, x[1] * sine, x[2] * sine, cos(half)};
    StrandsMove more = strands_move_none(), all = *move;
    more.scale = 1 + fmin(fmax(x[3], -0.5), 0.5);
    double3_rotation(q, more.rotation);
    Double3 back;
    apply(&more, middle, back);
    for (int k = 0; k < 3; ++k) more.translation[k] = middle[k] + size * x[4 + k] - back[k];
    apply(&more, move->translation, all.translation);
    all.scale = more.scale * move->scale;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            all.rotation[i][j] = 0;
            for (int k = 0; k < 3; ++k)
                all.rotation[i][j] += more.rotation[i][k] * move->rotation[k][j];
        }
    *move = all;
}

// Refines `move` and returns the median distance. Stops if the scale departs by more than
// MOST_STRETCH from the start: ICP would otherwise shrink the groom to a point on the surface,
// where all distances are 0.
static double refine(Pairs *pairs, const Surface *surface, StrandsMove *move)
{
    RigidMotion turned = {.rotation = {0, 0, 0, 1}};
    double start = move->scale, best = pair_up(pairs, surface, move);
    StrandsMove at = *move;
    for (int i = 0; i < ROUGH_STEPS + FINE_STEPS && pairs->kept >= 3; ++i) {
        if (i < ROUGH_STEPS)
            improve(pairs, &turned, &at);
        else
            slide(pairs, i < ROUGH_STEPS + FINE_STEPS / 2 ? 1e-2 : 1e-4, &at);
        if (!(at.scale > start / MOST_STRETCH && at.scale < start * MOST_STRETCH)) break;
        double median = pair_up(pairs, surface, &at);
        if (median < best) best = median, *move = at;
    }
    return best;
}

// A start that puts the bounding box of the roots at the top of the mesh. The box becomes `share`
// times as wide as the part of the mesh at the height of the roots.
static StrandsMove start_on_top(const Pairs *pairs, const Mesh *mesh, double share)
{
    Double3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    float mesh_low[3], mesh_high[3];
    StrandsMove move = strands_move_none();
    mesh_bounds(mesh, mesh_low, mesh_high);
    for (uint32_t i = 0; i < pairs->count; ++i)
        for (int k = 0; k < 3; ++k) {
            low[k] = fmin(low[k], pairs->root[i][k]);
            high[k] = fmax(high[k], pairs->root[i][k]);
        }
    // Start with a tenth of the mesh's height and grow, so that the shoulders of a bust are not
    // taken for the head.
    if (high[1] > low[1])
        move.scale = 0.1 * (double)(mesh_high[1] - mesh_low[1]) / (high[1] - low[1]);
    for (int turn = 0; turn < 8; ++turn) {
        double from = (double)mesh_high[1] - move.scale * (high[1] - low[1]), ratio = 1;
        double wide[2][2] = {{INFINITY, -INFINITY}, {INFINITY, -INFINITY}};
        for (uint32_t v = 0; v < mesh->vertex_count; ++v)
            for (int k = 0; k < 2 && (double)mesh->position[v][1] >= from; ++k) {
                wide[k][0] = fmin(wide[k][0], (double)mesh->position[v][2 * k]);
                wide[k][1] = fmax(wide[k][1], (double)mesh->position[v][2 * k]);
            }
        for (int k = 0; k < 2; ++k) {
            double own = high[2 * k] - low[2 * k], there = wide[k][1] - wide[k][0];
            if (own > 0 && there > 0) ratio *= sqrt(there / own);
        }
        move.scale = share * ratio;
        for (int k = 0; k < 2; ++k)
            move.translation[2 * k] =
                (wide[k][0] + wide[k][1]) / 2 - move.scale * (low[2 * k] + high[2 * k]) / 2;
    }
    for (int k = 0; k < 3; k += 2)
        if (!isfinite(move.translation[k])) move.translation[k] = 0;
    move.translation[1] = (double)mesh_high[1] - move.scale * high[1];
    return move;
}

static double angle_of(const StrandsMove *move)
{
    double trace = move->rotation[0][0] + move->rotation[1][1] + move->rotation[2][2];
    return 180 / M_PI * acos(fmin(fmax((trace - 1) / 2, -1), 1));
}

Result strands_find_fit(StrandsFit *fit, const Strands *strands, const Surface *surface,
                        Error *error)
{
    Pairs pairs = {0};
    *fit = (StrandsFit){.move = strands_move_none()};
    if (strands->strand_count < 3)
        return error_set(error, RESULT_FAILED, "%u strands: expected at least 3 to fit a groom",
                         strands->strand_count);
    if (!create_pairs(&pairs, strands)) {
        destroy_pairs(&pairs);
        return error_set(error, RESULT_FAILED, "no memory to fit a groom");
    }
    fit->before = pair_up(&pairs, surface, &fit->move);
    fit->after = refine(&pairs, surface, &fit->move);
    for (size_t i = 0; i < sizeof START_SCALES / sizeof *START_SCALES; ++i) {
        StrandsMove other = start_on_top(&pairs, surface->mesh, START_SCALES[i]);
        double median = refine(&pairs, surface, &other);
        if (median < fit->after && angle_of(&other) <= MOST_TURN_DEG)
            fit->after = median, fit->move = other;
    }
    Double3 middle, moved;
    find_middle((const double(*)[3])pairs.root, pairs.count, middle);
    apply(&fit->move, middle, moved);
    fit->moved = double3_distance(middle, moved);
    fit->turned_deg = angle_of(&fit->move);
    destroy_pairs(&pairs);
    return RESULT_OK;
}
