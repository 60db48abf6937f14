// SPDX-License-Identifier: MIT
#include "draw/light_blocks.h"

#include <cglm/cglm.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

// A triangle's corners in lattice cells; at[0] is its first corner.
typedef struct Corners {
    double at[3][3];
} Corners;

static void place_vertex(const LightMesh *mesh, const LightLattice *lattice, uint32_t v,
                         double place[3])
{
    versor turn = {0};
    vec3 x = {0};
    float turned[3];
    memcpy(turn, mesh->rotation, sizeof turn);
    memcpy(x, mesh->vertices[v], sizeof(float[3]));
    glm_quat_rotatev(turn, x, x);
    for (int k = 0; k < 3; ++k) x[k] += mesh->translation[k];
    light_lattice_turn(lattice, x, turned);
    for (int k = 0; k < 3; ++k)
        place[k] = (double)(turned[k] - lattice->low[k]) / (double)lattice->side;
}

// Twice the signed area of the triangle (a, b, p), projected to the plane of the axes u and v.
static double side_of(const double a[3], const double b[3], double pu, double pv, int u, int v)
{
    return (b[u] - a[u]) * (pv - a[v]) - (b[v] - a[v]) * (pu - a[u]);
}

// The depth at which the line through (pu, pv) along `axis` meets the triangle. False if it misses
// the triangle.
static bool meet(const Corners *c, int axis, double pu, double pv, double *depth)
{
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    double w0 = side_of(c->at[1], c->at[2], pu, pv, u, v),
           w1 = side_of(c->at[2], c->at[0], pu, pv, u, v),
           w2 = side_of(c->at[0], c->at[1], pu, pv, u, v), sum = w0 + w1 + w2;
    bool inside = (w0 >= 0 && w1 >= 0 && w2 >= 0) || (w0 <= 0 && w1 <= 0 && w2 <= 0);
    if (!inside || sum == 0) return false;
    *depth = (w0 * c->at[0][axis] + w1 * c->at[1][axis] + w2 * c->at[2][axis]) / sum;
    return true;
}

// fmin without a function call; the arguments are not NaN.
static double lesser(double a, double b)
{
    return a < b ? a : b;
}
static double greater(double a, double b)
{
    return a > b ? a : b;
}

static double least_of(const Corners *c, int k)
{
    return lesser(lesser(c->at[0][k], c->at[1][k]), c->at[2][k]);
}

static double most_of(const Corners *c, int k)
{
    return greater(greater(c->at[0][k], c->at[1][k]), c->at[2][k]);
}

// Blocks the way between two neighbouring cells on line (u, v): the triangle crosses it at `depth`,
// between the centres of both cells. The entry of the second cell stands for the way to it.
static void close_way(float *open, const LightLattice *lattice, int axis, const int line[2],
                      double depth)
{
    int cell[3], u = (axis + 1) % 3, v = (axis + 2) % 3;
    cell[axis] = (int)ceil(fmin(fmax(depth - 0.5, -2), lattice->count[axis] + 1));
    cell[u] = line[0];
    cell[v] = line[1];
    if (cell[axis] < 0 || cell[axis] >= lattice->count[axis]) return;
    size_t at = ((size_t)cell[2] * (size_t)lattice->count[1] + (size_t)cell[1]) *
                    (size_t)lattice->count[0] +
                (size_t)cell[0];
    open[at] = 0;
}

static void close_triangle(float *open, const LightLattice *lattice, int axis, const Corners *c)
{
    int u = (axis + 1) % 3, v = (axis + 2) % 3, line[2];
    double depth;
    for (int k = 0; k < 3; ++k)
        if (!(most_of(c, k) >= 0) || !(least_of(c, k) <= lattice->count[k])) return;
    int first[2], end[2];
    for (int k = 0; k < 2; ++k) {
        int on = k ? v : u;
        first[k] = (int)fmax(floor(least_of(c, on)), 0);
        end[k] = (int)fmin(ceil(most_of(c, on)), lattice->count[on]);
    }
    for (line[0] = first[0]; line[0] < end[0]; ++line[0])
        for (line[1] = first[1]; line[1] < end[1]; ++line[1])
            if (meet(c, axis, line[0] + 0.5, line[1] + 0.5, &depth))
                close_way(open, lattice, axis, line, depth);
}

static Result make_room(LightBlocks *blocks, size_t count, Error *error)
{
    if (blocks->room >= count) return RESULT_OK;
    free(blocks->open);
    blocks->open = malloc(count * sizeof *blocks->open);
    blocks->room = blocks->open ? count : 0;
    return blocks->open ? RESULT_OK
                        : error_set(error, RESULT_FAILED, "no memory for the mesh in the light");
}

Result light_blocks_find(LightBlocks *blocks, const LightLattice *lattice, Error *error)
{
    const LightMesh *mesh = &blocks->mesh;
    size_t cells = light_lattice_cells(lattice);
    TRY(make_room(blocks, 3 * cells, error));
    double(*places)[3] = malloc((mesh->vertex_count + 1) * sizeof *places);
    if (!places) return error_set(error, RESULT_FAILED, "no memory for the mesh in the light");
    for (size_t i = 0; i < 3 * cells; ++i) blocks->open[i] = 1;
    for (uint32_t i = 0; i < mesh->vertex_count; ++i) place_vertex(mesh, lattice, i, places[i]);
    for (uint32_t i = 0; i < mesh->triangle_count; ++i) {
        Corners c = {0};
        for (int k = 0; k < 3; ++k) memcpy(c.at[k], places[mesh->triangles[i][k]], sizeof c.at[k]);
        for (int axis = 0; axis < 3; ++axis)
            close_triangle(blocks->open + (size_t)axis * cells, lattice, axis, &c);
    }
    free(places);
    return RESULT_OK;
}

float light_blocks_march(const LightBlocks *blocks, const LightLattice *lattice, const int cell[3],
                         const float way[3], float reach)
{
    size_t cells = light_lattice_cells(lattice);
    int axis = 0, at[3], next[3];
    for (int k = 1; k < 3; ++k)
        if (fabsf(way[k]) > fabsf(way[axis])) axis = k;
    float main = fabsf(way[axis]), passed = 1, limit = reach * main / lattice->side;
    memcpy(at, cell, sizeof at);
    for (int step = 1; (float)step <= limit + 0.5f; ++step) {
        for (int k = 0; k < 3; ++k) next[k] = cell[k] + (int)lroundf((float)step * way[k] / main);
        for (int n = 0; n < 3; ++n) {
            int k = (axis + 1 + n) % 3; // the other axes before the main axis
            if (next[k] == at[k]) continue;
            int far = next[k] > at[k] ? next[k] : at[k];
            if (next[k] < 0 || next[k] >= lattice->count[k]) return passed;
            at[k] = next[k];
            int face[3] = {at[0], at[1], at[2]};
            face[k] = far;
            passed *= blocks->open[(size_t)k * cells +
                                   ((size_t)face[2] * (size_t)lattice->count[1] + (size_t)face[1]) *
                                       (size_t)lattice->count[0] +
                                   (size_t)face[0]];
            if (passed == 0) return 0;
        }
    }
    return passed;
}

void light_path_find(LightPath *path, const LightLattice *lattice, const float way[3])
{
    const int *n = lattice->count;
    const ptrdiff_t stride[3] = {1, n[0], (ptrdiff_t)n[0] * n[1]};
    int axis = 0, at[3] = {0}, steps[3] = {0};
    for (int k = 1; k < 3; ++k)
        if (fabsf(way[k]) > fabsf(way[axis])) axis = k;
    float main = fabsf(way[axis]);
    path->count = 0;
    for (int k = 0; k < 3; ++k) path->up[k] = way[k] > 0;
    for (int step = 1; steps[axis] < n[axis]; ++step)
        for (int i = 0; i < 3; ++i) {
            int k = (axis + 1 + i) % 3, next = (int)lroundf((float)step * way[k] / main);
            if (next == at[k]) continue;
            int face[3] = {at[0], at[1], at[2]};
            face[k] = next > at[k] ? next : at[k];
            at[k] = next;
            path->until[k][steps[k]++] = path->count;
            path->way[path->count++] = k * (ptrdiff_t)light_lattice_cells(lattice) + face[0] +
                                       face[1] * stride[1] + face[2] * stride[2];
        }
    for (int k = 0; k < 3; ++k)
        while (steps[k] < n[k]) path->until[k][steps[k]++] = path->count;
}

float light_path_follow(const LightPath *path, const LightBlocks *blocks,
                        const LightLattice *lattice, const int cell[3])
{
    const int *n = lattice->count;
    const float *open = blocks->open + ((ptrdiff_t)cell[2] * n[1] + cell[1]) * n[0] + cell[0];
    int count = path->count;
    for (int k = 0; k < 3; ++k) { // the step out of the lattice is not blocked
        int left = path->up[k] ? n[k] - 1 - cell[k] : cell[k];
        count = path->until[k][left] < count ? path->until[k][left] : count;
    }
    for (int i = 0; i < count; ++i)
        if (open[path->way[i]] == 0) return 0;
    return 1;
}

void light_blocks_destroy(LightBlocks *blocks)
{
    free(blocks->open);
    *blocks = (LightBlocks){0};
}
