// SPDX-License-Identifier: MIT
#include "mesh/surface_normals.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// An angle's size from its cosine, within 7e-5 (Abramowitz and Stegun 4.4.45).
static double angle_of(double cosine)
{
    double x = fmin(fabs(cosine), 1.0);
    double angle = sqrt(1.0 - x) * (1.5707288 + x * (-0.2121144 + x * (0.0742610 - 0.0187293 * x)));
    return cosine < 0 ? 3.14159265358979323846 - angle : angle;
}

typedef struct Spot {
    float place[3];
    uint32_t vertex;
} Spot;

static int compare_spots(const void *a, const void *b)
{
    const Spot *p = a, *q = b;
    for (int i = 0; i < 3; i++)
        if (p->place[i] != q->place[i]) return p->place[i] < q->place[i] ? -1 : 1;
    return p->vertex < q->vertex ? -1 : p->vertex > q->vertex;
}

// same[v]: the first of the vertices that lie where v does. False when memory is short.
static bool find_same(const Mesh *mesh, uint32_t *same)
{
    Spot *spots = malloc(((size_t)mesh->vertex_count + 1) * sizeof *spots);
    if (!spots) return false;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        spots[v].vertex = v;
        memcpy(spots[v].place, mesh->position[v], sizeof spots[v].place);
    }
    qsort(spots, mesh->vertex_count, sizeof *spots, compare_spots);
    for (uint32_t v = 0, first = 0; v < mesh->vertex_count; v++) {
        bool equal = true;
        for (int i = 0; i < 3; i++) equal = equal && spots[v].place[i] == spots[first].place[i];
        if (!equal) first = v;
        same[spots[v].vertex] = spots[first].vertex;
    }
    free(spots);
    return true;
}

typedef struct Edge {
    uint32_t low, high, triangle, side;
} Edge;

static int compare_edges(const void *a, const void *b)
{
    const Edge *p = a, *q = b;
    if (p->low != q->low) return p->low < q->low ? -1 : 1;
    if (p->high != q->high) return p->high < q->high ? -1 : 1;
    uint64_t i = 3 * (uint64_t)p->triangle + p->side, j = 3 * (uint64_t)q->triangle + q->side;
    return i < j ? -1 : i > j;
}

// Sums the normals of the triangles at each edge.
static void join_edges(Surface *surface, Edge *edges, uint32_t count)
{
    qsort(edges, count, sizeof *edges, compare_edges);
    for (uint32_t begin = 0, end; begin < count; begin = end) {
        Double3 sum = {0}, normal;
        for (end = begin; end < count && edges[end].low == edges[begin].low &&
                          edges[end].high == edges[begin].high;
             end++) {
            surface_triangle(surface->mesh, edges[end].triangle, normal);
            double3_add_scaled(sum, 1.0, normal);
        }
        for (uint32_t e = begin; e < end; e++)
            double3_copy(sum, surface->edge_normal[edges[e].triangle][edges[e].side]);
    }
}

static void add_corners(Surface *surface, const uint32_t *same, uint32_t t)
{
    Double3 corner[3], normal, a, b;
    surface_corners(surface->mesh, t, corner);
    surface_triangle(surface->mesh, t, normal);
    for (int k = 0; k < 3; k++) {
        double3_subtract(corner[(k + 1) % 3], corner[k], a);
        double3_subtract(corner[(k + 2) % 3], corner[k], b);
        double cosine = double3_dot(a, b) / (double3_length(a) * double3_length(b));
        double3_add_scaled(surface->corner_normal[same[surface->mesh->triangle[t][k]]],
                           angle_of(cosine), normal);
    }
}

bool surface_compute_normals(Surface *surface)
{
    const Mesh *mesh = surface->mesh;
    uint32_t *same = malloc(((size_t)mesh->vertex_count + 1) * sizeof *same);
    Edge *edges = malloc(3 * (size_t)surface->triangle_count * sizeof *edges);
    bool good = same && edges && find_same(mesh, same);
    uint32_t count = 0;
    for (uint32_t i = 0; good && i < surface->triangle_count; i++) {
        uint32_t t = surface->triangle[i];
        for (uint32_t side = 0; side < 3; side++) {
            uint32_t a = same[mesh->triangle[t][side]], b = same[mesh->triangle[t][(side + 1) % 3]];
            edges[count++] = (Edge){a < b ? a : b, a < b ? b : a, t, side};
        }
        add_corners(surface, same, t);
    }
    if (good) join_edges(surface, edges, count);
    for (uint32_t v = 0; good && v < mesh->vertex_count; v++)
        double3_copy(surface->corner_normal[same[v]], surface->corner_normal[v]);
    free(edges);
    free(same);
    return good;
}
