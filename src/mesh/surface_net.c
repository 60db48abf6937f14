// SPDX-License-Identifier: MIT
#include "mesh/surface_net.h"

#include <stdlib.h>

#define NO_VERTEX UINT32_MAX

typedef struct Build {
    const SurfaceNet *net;
    Mesh *mesh;
    double *value;    // [points of the grid]
    uint32_t *vertex; // [cells], by their first point; NO_VERTEX if the surface does not cross the
                      // cell
    Double3 *place;   // [vertices]
    Double3 *middle;  // [vertices], sums over the neighbours
    uint32_t *degree; // [vertices], number of neighbours
    uint32_t vertex_count, triangle_count;
    size_t step[3]; // index step from point to point along each axis
} Build;

static size_t point_at(const Build *build, const uint32_t p[3])
{
    return p[0] + build->step[1] * p[1] + build->step[2] * p[2];
}

static void place_point(const SurfaceNet *net, const uint32_t p[3], Double3 place)
{
    for (int i = 0; i < 3; i++) place[i] = net->line[i][p[i]];
}

// Steps to the next point of the grid. False after the last one; the last `margin` points of each
// line are skipped.
static bool next_point(const SurfaceNet *net, uint32_t margin, uint32_t p[3])
{
    for (int i = 0; i < 3; i++) {
        if (++p[i] < net->count[i] - margin) return true;
        p[i] = 0;
    }
    return false;
}

// Fills in the values line by line. Points that are nearer to the last evaluated point than half
// its distance from the surface copy its value, because they have the same sign.
static void measure(Build *build)
{
    const double *line = build->net->line[0];
    uint32_t p[3] = {0};
    double value = 0.0, since = 0.0;
    do {
        if (p[0] == 0 || line[p[0]] - since >= 0.5 * fabs(value)) {
            Double3 place;
            place_point(build->net, p, place);
            value = build->net->distance(place);
            since = line[p[0]];
        }
        build->value[point_at(build, p)] = value;
    } while (next_point(build->net, 0, p));
}

// Whether some corners of the cell are inside and others are not.
static bool is_crossed(const Build *build, const uint32_t cell[3])
{
    const double *first = build->value + point_at(build, cell);
    int inside = 0;
    for (int k = 0; k < 8; k++)
        inside += first[(k & 1) + build->step[1] * (k >> 1 & 1) + build->step[2] * (k >> 2)] < 0.0;
    return inside > 0 && inside < 8;
}

// The mean of the points where the surface crosses the edges of a crossed cell.
static void find_middle(const Build *build, const uint32_t cell[3], Double3 middle)
{
    int crossings = 0;
    Double3 sum = {0};
    for (int edge = 0; edge < 12; edge++) {
        int axis = edge / 4;
        uint32_t a[3], b[3];
        for (int i = 0; i < 3; i++) a[i] = cell[i];
        a[(axis + 1) % 3] += (uint32_t)(edge & 1);
        a[(axis + 2) % 3] += (uint32_t)(edge >> 1 & 1);
        for (int i = 0; i < 3; i++) b[i] = a[i] + (i == axis);
        double from = build->value[point_at(build, a)], to = build->value[point_at(build, b)];
        if ((from < 0.0) == (to < 0.0)) continue;
        Double3 begin, end, at;
        place_point(build->net, a, begin);
        place_point(build->net, b, end);
        double3_mix(begin, end, from / (from - to), at);
        double3_add_scaled(sum, 1.0, at);
        crossings++;
    }
    for (int i = 0; i < 3; i++) middle[i] = sum[i] / crossings;
}

static void number_vertices(Build *build)
{
    uint32_t cell[3] = {0};
    do {
        bool crossed = is_crossed(build, cell);
        build->vertex[point_at(build, cell)] = crossed ? build->vertex_count++ : NO_VERTEX;
    } while (next_point(build->net, 1, cell));
}

static void place_vertices(Build *build)
{
    uint32_t cell[3] = {0};
    do {
        uint32_t vertex = build->vertex[point_at(build, cell)];
        if (vertex != NO_VERTEX) find_middle(build, cell, build->place[vertex]);
    } while (next_point(build->net, 1, cell));
}

static void add_triangle(Build *build, uint32_t a, uint32_t b, uint32_t c)
{
    uint32_t *triangle = build->mesh->triangle[build->triangle_count++];
    triangle[0] = a, triangle[1] = b, triangle[2] = c;
}

// The four cells around an edge of the grid, counter-clockwise as seen from the end of the edge.
static void find_quad(const Build *build, const uint32_t p[3], int axis, uint32_t quad[4])
{
    static const uint32_t back[4][2] = {{1, 1}, {0, 1}, {0, 0}, {1, 0}};
    for (int k = 0; k < 4; k++) {
        uint32_t cell[3] = {p[0], p[1], p[2]};
        cell[(axis + 1) % 3] -= back[k][0];
        cell[(axis + 2) % 3] -= back[k][1];
        quad[k] = build->vertex[point_at(build, cell)];
    }
}

// Calls `act` for the quad of each grid edge that the surface crosses, oriented outwards.
static void each_quad(Build *build, void (*act)(Build *build, const uint32_t quad[4]))
{
    uint32_t p[3] = {0};
    do {
        double here = build->value[point_at(build, p)];
        for (int axis = 0; axis < 3; axis++) {
            int u = (axis + 1) % 3, v = (axis + 2) % 3;
            if (p[axis] + 1 >= build->net->count[axis] || p[u] == 0 || p[v] == 0) continue;
            double next = build->value[point_at(build, p) + build->step[axis]];
            if ((here < 0.0) == (next < 0.0)) continue;
            uint32_t quad[4];
            find_quad(build, p, axis, quad);
            if (here >= 0.0) {
                uint32_t swap = quad[1];
                quad[1] = quad[3], quad[3] = swap;
            }
            act(build, quad);
        }
    } while (next_point(build->net, 1, p));
}

static void count_quad(Build *build, const uint32_t quad[4])
{
    (void)quad;
    build->triangle_count += 2;
}

static void gather_quad(Build *build, const uint32_t quad[4])
{
    for (int k = 0; k < 4; k++) {
        for (int side = 1; side < 4; side += 2)
            double3_add_scaled(build->middle[quad[k]], 1.0, build->place[quad[(k + side) % 4]]);
        build->degree[quad[k]] += 2;
    }
}

// Splits the quad along its shorter diagonal.
static void split_quad(Build *build, const uint32_t quad[4])
{
    Double3 *place = build->place;
    int first = double3_distance(place[quad[0]], place[quad[2]]) >
                double3_distance(place[quad[1]], place[quad[3]]);
    const uint32_t *q = quad;
    add_triangle(build, q[first], q[first + 1], q[first + 2]);
    add_triangle(build, q[first], q[first + 2], q[(first + 3) % 4]);
}

// Moves the point onto the surface by Newton's method.
void surface_net_project(const SurfaceNet *net, Double3 place)
{
    Double3 normal, before = {0};
    for (int k = 0; k < 5 && (k == 0 || memcmp(place, before, sizeof before) != 0); k++) {
        double3_copy(place, before);
        double distance = net->near(net->own, place, normal);
        double3_add_scaled(place, -distance, normal);
    }
}

// Moves each vertex half of the way to the mean of its neighbours, tangentially to the surface.
static void smooth(Build *build)
{
    const SurfaceNet *net = build->net;
    memset(build->middle, 0, build->vertex_count * sizeof *build->middle);
    memset(build->degree, 0, build->vertex_count * sizeof *build->degree);
    each_quad(build, gather_quad);
    for (uint32_t v = 0; v < build->vertex_count; v++) {
        Double3 way, normal;
        for (int i = 0; i < 3; i++)
            way[i] = build->middle[v][i] / build->degree[v] - build->place[v][i];
        net->near(net->own, build->place[v], normal);
        double3_flatten(way, normal);
        double3_add_scaled(build->place[v], 0.5, way);
        double3_add_scaled(build->place[v], -net->near(net->own, build->place[v], NULL), normal);
    }
}

static Result make_mesh(Build *build, Error *error)
{
    const SurfaceNet *net = build->net;
    number_vertices(build);
    uint32_t count = build->vertex_count;
    each_quad(build, count_quad);
    TRY(mesh_create(build->mesh, count, build->triangle_count, error));
    build->place = malloc(count * sizeof *build->place);
    build->middle = malloc(count * sizeof *build->middle);
    build->degree = malloc(count * sizeof *build->degree);
    if (!build->place || !build->middle || !build->degree)
        return error_set(error, RESULT_FAILED, "no memory for a mesh of %u vertices", count);
    place_vertices(build);
    for (uint32_t v = 0; v < count; v++) surface_net_project(net, build->place[v]);
    for (int k = 0; k < net->smoothing; k++) smooth(build);
    build->triangle_count = 0;
    each_quad(build, split_quad);
    for (uint32_t v = 0; v < count; v++)
        for (int i = 0; i < 3; i++) build->mesh->position[v][i] = (float)build->place[v][i];
    return RESULT_OK;
}

Result surface_net_make(Mesh *mesh, const SurfaceNet *net, Error *error)
{
    size_t points = (size_t)net->count[0] * net->count[1] * net->count[2];
    Build build = {.net = net, .mesh = mesh};
    Result result = RESULT_OK;
    *mesh = (Mesh){0};
    build.step[0] = 1, build.step[1] = net->count[0];
    build.step[2] = build.step[1] * net->count[1];
    build.value = malloc(points * sizeof *build.value);
    build.vertex = malloc(points * sizeof *build.vertex);
    if (build.value && build.vertex) {
        measure(&build);
        result = make_mesh(&build, error);
    } else {
        result = error_set(error, RESULT_FAILED, "no memory for a grid of %zu points", points);
    }
    if (result != RESULT_OK) mesh_destroy(mesh);
    free(build.value);
    free(build.vertex);
    free(build.place);
    free(build.middle);
    free(build.degree);
    return result;
}
