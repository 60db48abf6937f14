// SPDX-License-Identifier: MIT
#include "mesh/simplify.h"

#include <stdlib.h>

// A weighted sum of squared distances from planes: p A p + 2 b p + c with symmetric A.
typedef struct Quadric {
    double a[6], b[3], c;
} Quadric;

// A candidate edge collapse. It is outdated if one of its vertices has changed since.
typedef struct Merge {
    double cost;
    uint32_t from, to; // from > to
    uint32_t from_age, to_age;
} Merge;

// Corner k of triangle t has the number 3 t + k. The corners of a vertex form a circular list.
typedef struct Work {
    Mesh *mesh;
    Double3 *place;   // [vertices]
    Quadric *quadric; // [vertices]
    uint32_t *age;    // [vertices], number of changes
    uint32_t *first;  // [vertices], one of the corners
    uint32_t *next;   // [corners], the next corner of the same vertex
    bool *gone;       // [triangles]
    uint32_t left;    // remaining triangles
    Merge *heap;
    size_t heap_count, heap_room;
} Work;

static uint32_t vertex_of(const Work *work, uint32_t corner)
{
    return work->mesh->triangle[corner / 3][corner % 3];
}

// --- Quadrics.

static void add_plane(Quadric *q, const Double3 normal, double offset, double weight)
{
    for (int i = 0, k = 0; i < 3; i++) {
        for (int j = i; j < 3; j++) q->a[k++] += weight * normal[i] * normal[j];
        q->b[i] += weight * normal[i] * offset;
    }
    q->c += weight * offset * offset;
}

static void add_quadric(Quadric *to, const Quadric *q)
{
    for (int i = 0; i < 6; i++) to->a[i] += q->a[i];
    for (int i = 0; i < 3; i++) to->b[i] += q->b[i];
    to->c += q->c;
}

static double quadric_at(const Quadric *q, const Double3 p)
{
    const double *a = q->a, *b = q->b;
    double square = a[0] * p[0] * p[0] + a[3] * p[1] * p[1] + a[5] * p[2] * p[2];
    double mixed = a[1] * p[0] * p[1] + a[2] * p[0] * p[2] + a[4] * p[1] * p[2];
    return square + 2.0 * (mixed + b[0] * p[0] + b[1] * p[1] + b[2] * p[2]) + q->c;
}

// Returns twice the area of a triangle and sets its unit normal.
static double find_normal(const Double3 a, const Double3 b, const Double3 c, Double3 normal)
{
    Double3 u, v;
    double3_subtract(b, a, u);
    double3_subtract(c, a, v);
    double3_cross(u, v, normal);
    return double3_normalize(normal);
}

static void add_triangles(Work *work, double (*weight)(const Double3 at))
{
    for (uint32_t t = 0; t < work->mesh->triangle_count; t++) {
        const uint32_t *v = work->mesh->triangle[t];
        Double3 normal;
        double area = find_normal(work->place[v[0]], work->place[v[1]], work->place[v[2]], normal);
        double offset = -double3_dot(normal, work->place[v[0]]);
        if (weight) area *= weight(work->place[v[0]]);
        for (int k = 0; k < 3; k++) add_plane(&work->quadric[v[k]], normal, offset, area);
    }
}

// --- The heap, ordered by cost; equal costs by vertex numbers, so that results are repeatable.

static bool comes_before(const Merge *a, const Merge *b)
{
    if (a->cost != b->cost) return a->cost < b->cost;
    return a->from != b->from ? a->from < b->from : a->to < b->to;
}

static bool push(Work *work, Merge merge)
{
    if (work->heap_count == work->heap_room) {
        size_t room = 2 * work->heap_room + 1024;
        Merge *heap = realloc(work->heap, room * sizeof *heap);
        if (!heap) return false;
        work->heap = heap, work->heap_room = room;
    }
    size_t i = work->heap_count++;
    for (; i > 0 && comes_before(&merge, &work->heap[(i - 1) / 2]); i = (i - 1) / 2)
        work->heap[i] = work->heap[(i - 1) / 2];
    work->heap[i] = merge;
    return true;
}

static Merge pop(Work *work)
{
    Merge top = work->heap[0], last = work->heap[--work->heap_count];
    size_t i = 0;
    for (;;) {
        size_t child = 2 * i + 1;
        if (child >= work->heap_count) break;
        if (child + 1 < work->heap_count &&
            comes_before(&work->heap[child + 1], &work->heap[child]))
            child++;
        if (!comes_before(&work->heap[child], &last)) break;
        work->heap[i] = work->heap[child];
        i = child;
    }
    work->heap[i] = last;
    return top;
}

// --- Edges.

// Chooses the merged vertex's position: one of the ends or the middle. Returns its cost.
static double find_place(const Work *work, uint32_t a, uint32_t b, Double3 place)
{
    Quadric sum = work->quadric[a];
    double least = INFINITY;
    add_quadric(&sum, &work->quadric[b]);
    for (int k = 0; k < 3; k++) {
        static const double SHARES[] = {0.5, 0.0, 1.0};
        Double3 at;
        double3_mix(work->place[a], work->place[b], SHARES[k], at);
        double cost = quadric_at(&sum, at);
        if (cost < least) least = cost, double3_copy(at, place);
    }
    return least;
}

// Adds a candidate. The small cost per length collapses short edges first where all costs are 0, as
// in a plane.
static bool offer(Work *work, uint32_t a, uint32_t b)
{
    static const double PER_LENGTH = 1e-7; // of the fourth power of the length
    uint32_t from = a > b ? a : b, to = a > b ? b : a;
    Double3 place, way;
    double3_subtract(work->place[a], work->place[b], way);
    double square = double3_dot(way, way);
    double cost = fmax(find_place(work, to, from, place), 0.0) + PER_LENGTH * square * square;
    return push(work, (Merge){cost, from, to, work->age[from], work->age[to]});
}

// Whether moving `v` to `place` flips one of its triangles or makes it a needle. Triangles that
// contain `other` are not checked, since they disappear.
static bool would_fold(const Work *work, uint32_t v, uint32_t other, const Double3 place)
{
    uint32_t c = work->first[v];
    do {
        uint32_t t = c / 3, k = c % 3;
        uint32_t p = work->mesh->triangle[t][(k + 1) % 3], q = work->mesh->triangle[t][(k + 2) % 3];
        c = work->next[c];
        if (work->gone[t] || p == other || q == other) continue;
        Double3 before, after, edge;
        find_normal(work->place[v], work->place[p], work->place[q], before);
        double area = find_normal(place, work->place[p], work->place[q], after), longest = 0.0;
        const double *corner[3] = {place, work->place[p], work->place[q]};
        for (int i = 0; i < 3; i++) {
            double3_subtract(corner[i], corner[(i + 1) % 3], edge);
            longest = fmax(longest, double3_dot(edge, edge));
        }
        if (double3_dot(before, after) < 0.5 || area < 0.15 * longest) return true;
    } while (c != work->first[v]);
    return false;
}

// Whether a remaining triangle of v contains `other`.
static bool are_neighbours(const Work *work, uint32_t v, uint32_t other)
{
    uint32_t c = work->first[v];
    do {
        const uint32_t *corner = work->mesh->triangle[c / 3];
        if (!work->gone[c / 3])
            for (int k = 0; k < 3; k++)
                if (corner[k] == other) return true;
        c = work->next[c];
    } while (c != work->first[v]);
    return false;
}

// The ends of an edge of a closed surface have two common neighbours. With more, the collapse would
// pinch the surface.
static bool would_pinch(const Work *work, uint32_t from, uint32_t to)
{
    int common = 0;
    uint32_t c = work->first[from];
    do {
        uint32_t t = c / 3, ahead = work->mesh->triangle[t][(c % 3 + 1) % 3];
        if (!work->gone[t] && ahead != to && are_neighbours(work, to, ahead)) common++;
        c = work->next[c];
    } while (c != work->first[from]);
    return common != 2;
}

static bool merge(Work *work, uint32_t from, uint32_t to, const Double3 place)
{
    Mesh *mesh = work->mesh;
    uint32_t c = work->first[from];
    do {
        uint32_t t = c / 3;
        if (!work->gone[t]) {
            for (int k = 0; k < 3; k++)
                if (mesh->triangle[t][k] == to) work->gone[t] = true;
            if (work->gone[t])
                work->left--;
            else
                mesh->triangle[t][c % 3] = to;
        }
        c = work->next[c];
    } while (c != work->first[from]);
    // Swapping two links joins the two circular lists.
    uint32_t swap = work->next[work->first[from]];
    work->next[work->first[from]] = work->next[work->first[to]];
    work->next[work->first[to]] = swap;
    double3_copy(place, work->place[to]);
    add_quadric(&work->quadric[to], &work->quadric[from]);
    work->age[to]++;
    work->age[from]++;
    c = work->first[to];
    do {
        uint32_t t = c / 3;
        if (!work->gone[t] && !offer(work, to, work->mesh->triangle[t][(c % 3 + 1) % 3]))
            return false;
        c = work->next[c];
    } while (c != work->first[to]);
    return true;
}

static bool merge_all(Work *work, uint32_t triangle_count)
{
    const Mesh *mesh = work->mesh;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            uint32_t a = mesh->triangle[t][k], b = mesh->triangle[t][(k + 1) % 3];
            if (a < b && !offer(work, a, b)) return false;
        }
    while (work->left > triangle_count && work->heap_count > 0) {
        Merge top = pop(work);
        Double3 place;
        if (work->age[top.from] != top.from_age || work->age[top.to] != top.to_age) continue;
        find_place(work, top.to, top.from, place);
        if (would_pinch(work, top.from, top.to) || would_fold(work, top.from, top.to, place) ||
            would_fold(work, top.to, top.from, place))
            continue;
        if (!merge(work, top.from, top.to, place)) return false;
    }
    return true;
}

// --- Beginning and end.

static bool begin(Work *work, Mesh *mesh, double (*weight)(const Double3 at))
{
    uint32_t vertices = mesh->vertex_count, corners = 3 * mesh->triangle_count;
    *work = (Work){.mesh = mesh, .left = mesh->triangle_count};
    work->place = malloc(vertices * sizeof *work->place);
    work->quadric = calloc(vertices, sizeof *work->quadric);
    work->age = calloc(vertices, sizeof *work->age);
    work->first = malloc(vertices * sizeof *work->first);
    work->next = malloc(corners * sizeof *work->next);
    work->gone = calloc(mesh->triangle_count, sizeof *work->gone);
    if (!work->place || !work->quadric || !work->age || !work->first || !work->next || !work->gone)
        return false;
    for (uint32_t v = 0; v < vertices; v++) {
        double3_from_float(mesh->position[v], work->place[v]);
        work->first[v] = UINT32_MAX;
    }
    for (uint32_t c = 0; c < corners; c++) {
        uint32_t *first = &work->first[vertex_of(work, c)];
        work->next[c] = *first == UINT32_MAX ? c : work->next[*first];
        if (*first == UINT32_MAX)
            *first = c;
        else
            work->next[*first] = c;
    }
    add_triangles(work, weight);
    return true;
}

// Moves the remaining vertices and triangles to the front, in their order.
static void pack(Work *work)
{
    Mesh *mesh = work->mesh;
    uint32_t *number = work->age, vertices = 0, triangles = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) number[v] = UINT32_MAX;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        for (int k = 0; k < 3 && !work->gone[t]; k++) number[mesh->triangle[t][k]] = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        if (number[v] == UINT32_MAX) continue;
        for (int i = 0; i < 3; i++) mesh->position[vertices][i] = (float)work->place[v][i];
        number[v] = vertices++;
    }
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        if (work->gone[t]) continue;
        for (int k = 0; k < 3; k++) mesh->triangle[triangles][k] = number[mesh->triangle[t][k]];
        triangles++;
    }
    mesh->vertex_count = vertices;
    mesh->triangle_count = triangles;
}

Result simplify_mesh(Mesh *mesh, uint32_t triangle_count, double (*weight)(const Double3 at),
                     Error *error)
{
    Work work;
    bool good = begin(&work, mesh, weight) && merge_all(&work, triangle_count);
    if (good) pack(&work);
    free(work.place);
    free(work.quadric);
    free(work.age);
    free(work.first);
    free(work.next);
    free(work.gone);
    free(work.heap);
    if (good) return RESULT_OK;
    return error_set(error, RESULT_FAILED, "no memory to simplify %u triangles",
                     mesh->triangle_count);
}
