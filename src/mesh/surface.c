// SPDX-License-Identifier: MIT
#include "mesh/surface.h"

#include <stdlib.h>
#include <string.h>

enum { LEAF = 4, DEEPEST = 64 };

struct SurfaceNode {
    Double3 low, high;
    uint32_t begin, end; // range in Surface.triangle
    uint32_t right;      // the left child is the next node; 0 marks a leaf
};

// --- Triangles.

// The positions of a triangle's corners.
static void find_corners(const Mesh *mesh, uint32_t triangle, Double3 corner[3])
{
    for (int k = 0; k < 3; k++)
        double3_from_float(mesh->position[mesh->triangle[triangle][k]], corner[k]);
}

double surface_triangle(const Mesh *mesh, uint32_t triangle, Double3 normal)
{
    Double3 corner[3], u, v;
    find_corners(mesh, triangle, corner);
    double3_subtract(corner[1], corner[0], u);
    double3_subtract(corner[2], corner[0], v);
    double3_cross(u, v, normal);
    return double3_normalize(normal);
}

SurfacePoint surface_at(const Surface *surface, uint32_t triangle, const Double3 weight)
{
    SurfacePoint point = {.triangle = triangle};
    Double3 corner[3];
    find_corners(surface->mesh, triangle, corner);
    double3_copy(weight, point.weight);
    for (int k = 0; k < 3; k++) double3_add_scaled(point.place, weight[k], corner[k]);
    return point;
}

void surface_normal(const Surface *surface, const SurfacePoint *point, Double3 normal)
{
    const Mesh *mesh = surface->mesh;
    Double3 sum = {0};
    for (int k = 0; k < 3; k++) {
        Double3 corner;
        double3_from_float(mesh->normal[mesh->triangle[point->triangle][k]], corner);
        double3_add_scaled(sum, point->weight[k], corner);
    }
    if (double3_normalize(sum) < 1e-3) surface_triangle(mesh, point->triangle, sum);
    double3_copy(sum, normal);
}

bool surface_uv(const Surface *surface, const SurfacePoint *point, double uv[2])
{
    const Mesh *mesh = surface->mesh;
    uv[0] = uv[1] = 0.0;
    for (int k = 0; k < 3; k++) {
        uint32_t index = mesh->uv ? mesh->triangle_uv[point->triangle][k] : MESH_NO_UV;
        if (index == MESH_NO_UV) return false;
        for (int i = 0; i < 2; i++) uv[i] += point->weight[k] * (double)mesh->uv[index][i];
    }
    return true;
}

// Solves P = P0 + a E1 + b E2 and (u, v) = (u0, v0) + a F1 + b F2 for dP/du and dP/dv.
bool surface_uv_axes(const Surface *surface, const SurfacePoint *point, Double3 u, Double3 v)
{
    const Mesh *mesh = surface->mesh;
    Double3 corner[3], edge[2];
    double f[2][2], uv[2];
    if (!surface_uv(surface, point, uv)) return false;
    find_corners(mesh, point->triangle, corner);
    const uint32_t *index = mesh->triangle_uv[point->triangle];
    for (int k = 0; k < 2; k++) {
        double3_subtract(corner[k + 1], corner[0], edge[k]);
        for (int i = 0; i < 2; i++)
            f[k][i] = (double)mesh->uv[index[k + 1]][i] - (double)mesh->uv[index[0]][i];
    }
    double determinant = f[0][0] * f[1][1] - f[0][1] * f[1][0], side = determinant < 0 ? -1.0 : 1.0;
    for (int i = 0; i < 3; i++) {
        u[i] = side * (f[1][1] * edge[0][i] - f[0][1] * edge[1][i]);
        v[i] = side * (f[0][0] * edge[1][i] - f[1][0] * edge[0][i]);
    }
    return determinant != 0.0 && double3_normalize(u) > 0.0 && double3_normalize(v) > 0.0;
}

// --- The tree.

static double middle_of(const Mesh *mesh, uint32_t triangle, int axis)
{
    double sum = 0.0;
    for (int k = 0; k < 3; k++) sum += (double)mesh->position[mesh->triangle[triangle][k]][axis];
    return sum;
}

// Hoare's selection as in nearest.c: puts the median of begin .. end - 1 in its place.
static void split(Surface *surface, uint32_t begin, uint32_t end, uint32_t middle, int axis)
{
    int64_t low = begin, high = (int64_t)end - 1;
    while (low < high) {
        double pivot = middle_of(surface->mesh, surface->triangle[middle], axis);
        int64_t i = low, j = high;
        while (i <= j) {
            while (middle_of(surface->mesh, surface->triangle[i], axis) < pivot) i++;
            while (middle_of(surface->mesh, surface->triangle[j], axis) > pivot) j--;
            if (i > j) break;
            uint32_t kept = surface->triangle[i];
            surface->triangle[i++] = surface->triangle[j];
            surface->triangle[j--] = kept;
        }
        if (j < (int64_t)middle) low = i;
        if (i > (int64_t)middle) high = j;
    }
}

static void set_box(const Surface *surface, SurfaceNode *node)
{
    for (int axis = 0; axis < 3; axis++) {
        node->low[axis] = INFINITY;
        node->high[axis] = -INFINITY;
    }
    for (uint32_t i = node->begin; i < node->end; i++) {
        Double3 corner[3];
        find_corners(surface->mesh, surface->triangle[i], corner);
        for (int k = 0; k < 9; k++) {
            node->low[k % 3] = fmin(node->low[k % 3], corner[k / 3][k % 3]);
            node->high[k % 3] = fmax(node->high[k % 3], corner[k / 3][k % 3]);
        }
    }
}

// Builds a subtree and returns the index of the next free node.
static uint32_t build(Surface *surface, uint32_t at, uint32_t begin, uint32_t end)
{
    SurfaceNode *node = &surface->nodes[at];
    *node = (SurfaceNode){.begin = begin, .end = end};
    set_box(surface, node);
    if (end - begin <= LEAF) return at + 1;
    int axis = 0;
    for (int k = 1; k < 3; k++)
        if (node->high[k] - node->low[k] > node->high[axis] - node->low[axis]) axis = k;
    uint32_t middle = begin + (end - begin) / 2;
    split(surface, begin, end, middle, axis);
    node->right = build(surface, at + 1, begin, middle);
    return build(surface, node->right, middle, end);
}

// --- Normals of edges and corners, which tell whether a point is inside or outside.

// The angle with this cosine, to within 7e-5 (Abramowitz and Stegun 4.4.45).
static double angle_of(double cosine)
{
    double x = fmin(fabs(cosine), 1.0);
    double angle = sqrt(1.0 - x) * (1.5707288 + x * (-0.2121144 + x * (0.0742610 - 0.0187293 * x)));
    return cosine < 0 ? M_PI - angle : angle;
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

// same[v] is the first of the vertices at the position of v. False if memory is short.
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
    find_corners(surface->mesh, t, corner);
    surface_triangle(surface->mesh, t, normal);
    for (int k = 0; k < 3; k++) {
        double3_subtract(corner[(k + 1) % 3], corner[k], a);
        double3_subtract(corner[(k + 2) % 3], corner[k], b);
        double cosine = double3_dot(a, b) / (double3_length(a) * double3_length(b));
        double3_add_scaled(surface->corner_normal[same[surface->mesh->triangle[t][k]]],
                           angle_of(cosine), normal);
    }
}

// Fills edge_normal and corner_normal, which must be zero. Vertices at the same position count as
// one. The normal of an edge is the sum of its triangles' normals; that of a corner is their sum
// weighted by the angles at the corner (Baerentzen and Aanaes 2005). False if memory is short.
static bool compute_normals(Surface *surface)
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

// ---

Result surface_create(Surface *surface, const Mesh *mesh, const char *name, Error *error)
{
    uint32_t count = mesh->triangle_count;
    *surface = (Surface){.mesh = mesh};
    surface->triangle = malloc(((size_t)count + 1) * sizeof *surface->triangle);
    surface->edge_normal = calloc((size_t)count + 1, sizeof *surface->edge_normal);
    surface->corner_normal = calloc((size_t)mesh->vertex_count + 1, sizeof *surface->corner_normal);
    surface->nodes = malloc(((size_t)count + 1) * 2 * sizeof *surface->nodes);
    bool good =
        surface->triangle && surface->edge_normal && surface->corner_normal && surface->nodes;
    for (uint32_t t = 0; good && t < count; t++) {
        Double3 normal;
        double twice = surface_triangle(mesh, t, normal);
        surface->area += 0.5 * twice;
        if (twice > 0.0) surface->triangle[surface->triangle_count++] = t;
    }
    surface->flat_count = count - surface->triangle_count;
    if (good && !(surface->area > 0.0 && isfinite(surface->area))) {
        surface_destroy(surface);
        return error_set(error, RESULT_BAD_INPUT, "%s: no triangle has an area", name);
    }
    if (good) build(surface, 0, 0, surface->triangle_count);
    if (good && compute_normals(surface)) return RESULT_OK;
    surface_destroy(surface);
    return error_set(error, RESULT_FAILED, "%s: no memory for %u triangles", name, count);
}

void surface_destroy(Surface *surface)
{
    free(surface->triangle);
    free(surface->edge_normal);
    free(surface->corner_normal);
    free(surface->nodes);
    *surface = (Surface){0};
}

// --- The nearest point.

// The barycentric weights of the point of edge a b that is nearest to p.
static void nearest_on_edge(const Double3 corner[3], const Double3 p, int a, Double3 weight)
{
    int b = (a + 1) % 3;
    Double3 edge, to;
    double3_subtract(corner[b], corner[a], edge);
    double3_subtract(p, corner[a], to);
    double share =
        double_min(double_max(double3_dot(to, edge) / double3_dot(edge, edge), 0.0), 1.0);
    weight[a] = 1.0 - share;
    weight[b] = share;
    weight[(a + 2) % 3] = 0.0;
}

// The projection of p onto the triangle's plane, if it is inside the triangle; otherwise the
// nearest point of the edges.
static double nearest_on_triangle(const Mesh *mesh, uint32_t triangle, const Double3 p,
                                  Double3 weight)
{
    Double3 corner[3], u, v, w, n, cross;
    find_corners(mesh, triangle, corner);
    double3_subtract(corner[1], corner[0], u);
    double3_subtract(corner[2], corner[0], v);
    double3_subtract(p, corner[0], w);
    double3_cross(u, v, n);
    double square = double3_dot(n, n);
    double3_cross(u, w, cross);
    weight[2] = double3_dot(cross, n) / square;
    double3_cross(w, v, cross);
    weight[1] = double3_dot(cross, n) / square;
    weight[0] = 1.0 - weight[1] - weight[2];
    double height = double3_dot(w, n);
    if (weight[0] > 0.0 && weight[1] > 0.0 && weight[2] > 0.0) return height * height / square;
    double best = INFINITY;
    for (int a = 0; a < 3; a++) {
        Double3 on_edge, difference;
        nearest_on_edge((const Double3 *)corner, p, a, on_edge);
        for (int i = 0; i < 3; i++)
            difference[i] = on_edge[0] * corner[0][i] + on_edge[1] * corner[1][i] +
                            on_edge[2] * corner[2][i] - p[i];
        double distance = double3_dot(difference, difference);
        if (distance >= best) continue;
        best = distance;
        double3_copy(on_edge, weight);
    }
    return best;
}

static double box_distance(const SurfaceNode *node, const Double3 p)
{
    double sum = 0.0;
    for (int i = 0; i < 3; i++) {
        double out = double_max(double_max(node->low[i] - p[i], p[i] - node->high[i]), 0.0);
        sum += out * out;
    }
    return sum;
}

static void try_triangle(const Surface *surface, uint32_t triangle, const Double3 from,
                         SurfacePoint *nearest, double *best)
{
    Double3 weight;
    double square = nearest_on_triangle(surface->mesh, triangle, from, weight);
    if (square >= *best) return;
    *best = square;
    nearest->triangle = triangle;
    double3_copy(weight, nearest->weight);
}

// The normal that decides between inside and outside: that of the face, or of the edge or corner if
// the point is on one (weights are 0).
static const double *find_side(const Surface *surface, const SurfacePoint *point, Double3 face)
{
    int zeros = 0, zero = 0, full = 0;
    for (int k = 0; k < 3; k++) {
        if (point->weight[k] <= 0.0) zeros++, zero = k;
        if (point->weight[k] >= 1.0) full = k;
    }
    if (zeros == 2) return surface->corner_normal[surface->mesh->triangle[point->triangle][full]];
    if (zeros == 1) return surface->edge_normal[point->triangle][(zero + 1) % 3];
    surface_triangle(surface->mesh, point->triangle, face);
    return face;
}

double surface_nearest(const Surface *surface, const Double3 from, SurfacePoint *nearest)
{
    struct {
        uint32_t node;
        double square; // distance of its box
    } stack[DEEPEST];
    uint32_t depth = 0;
    double best = INFINITY;
    Double3 face, away;
    bool known = nearest->triangle < surface->mesh->triangle_count &&
                 surface_triangle(surface->mesh, nearest->triangle, face) > 0.0;
    if (known) try_triangle(surface, nearest->triangle, from, nearest, &best);
    stack[depth].node = 0;
    stack[depth++].square = box_distance(surface->nodes, from);
    while (depth > 0) {
        uint32_t at = stack[--depth].node;
        const SurfaceNode *node = &surface->nodes[at];
        if (stack[depth].square >= best) continue;
        if (node->right == 0) {
            for (uint32_t i = node->begin; i < node->end; i++)
                try_triangle(surface, surface->triangle[i], from, nearest, &best);
            continue;
        }
        double left = box_distance(&surface->nodes[at + 1], from),
               right = box_distance(&surface->nodes[node->right], from);
        bool left_first = left <= right;
        stack[depth].node = left_first ? node->right : at + 1;
        stack[depth++].square = left_first ? right : left;
        stack[depth].node = left_first ? at + 1 : node->right;
        stack[depth++].square = left_first ? left : right;
    }
    *nearest = surface_at(surface, nearest->triangle, nearest->weight);
    double3_subtract(from, nearest->place, away);
    double side = double3_dot(away, find_side(surface, nearest, face));
    return side < 0.0 ? -sqrt(best) : sqrt(best);
}
