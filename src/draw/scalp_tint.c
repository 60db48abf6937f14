// SPDX-License-Identifier: MIT
#include "draw/scalp_tint.h"

#include "strands/follow_plan.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const float PI = 3.14159265f, LEAST_SKIN = 1e-3f;

// The vertices in cubic cells as wide as a root reaches, so that those near a root are in the 27
// cells around it. Cells share the lists of a hash table.
typedef struct Cells {
    const Mesh *mesh;
    float side;      // m
    uint32_t lists;  // a power of two
    uint32_t *first; // [lists], the first vertex of each, NONE: empty
    uint32_t *next;  // [vertices]
} Cells;

#define NONE UINT32_MAX

static void find_cell(const Cells *cells, const float x[3], int64_t cell[3])
{
    const double far = 1e15; // broken or far positions share a cell
    for (int k = 0; k < 3; ++k) {
        double at = floor((double)x[k] / (double)cells->side);
        cell[k] = (int64_t)(fabs(at) < far ? at : far);
    }
}

static uint32_t list_of(const Cells *cells, const int64_t cell[3])
{
    uint64_t mixed = (uint64_t)cell[0] * UINT64_C(0x9e3779b97f4a7c15) ^
                     (uint64_t)cell[1] * UINT64_C(0xc2b2ae3d27d4eb4f) ^
                     (uint64_t)cell[2] * UINT64_C(0x165667b19e3779f9);
    return (uint32_t)(mixed >> 32) & (cells->lists - 1);
}

static Result fill_cells(Cells *cells, const Mesh *mesh, float side, Error *error)
{
    *cells = (Cells){.mesh = mesh, .side = side, .lists = 1};
    while (cells->lists < mesh->vertex_count && cells->lists < 1u << 30) cells->lists *= 2;
    cells->first = malloc(cells->lists * sizeof *cells->first);
    cells->next = malloc(mesh->vertex_count * sizeof *cells->next + 1);
    if (!cells->first || !cells->next)
        return error_set(error, RESULT_FAILED, "no memory for the roots near %u vertices",
                         mesh->vertex_count);
    memset(cells->first, 0xff, cells->lists * sizeof *cells->first);
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        int64_t cell[3];
        find_cell(cells, mesh->position[v], cell);
        uint32_t *first = &cells->first[list_of(cells, cell)];
        cells->next[v] = *first;
        *first = v;
    }
    return RESULT_OK;
}

static void destroy_cells(Cells *cells)
{
    free(cells->first);
    free(cells->next);
}

// What the roots give to a vertex: cover, and its sums with their colours.
typedef struct Given {
    float cover, color[3];
} Given;

// A root's cover is spread as (1 - (d / side)^2)^2, whose integral over the plane is
// PI side^2 / 3.
static void give_to_cell(const Cells *cells, const int64_t cell[3], const float root[3],
                         float cover, const float color[3], Given *given)
{
    float whole = PI * cells->side * cells->side / 3;
    for (uint32_t v = cells->first[list_of(cells, cell)]; v != NONE; v = cells->next[v]) {
        int64_t own[3];
        find_cell(cells, cells->mesh->position[v], own);
        if (memcmp(own, cell, sizeof own) != 0) continue; // another cell of the list
        float square = 0;
        for (int k = 0; k < 3; ++k) {
            float way = (cells->mesh->position[v][k] - root[k]) / cells->side;
            square += way * way;
        }
        if (!(square < 1)) continue;
        float share = cover * (1 - square) * (1 - square) / whole;
        given[v].cover += share;
        for (int k = 0; k < 3; ++k) given[v].color[k] += share * color[k];
    }
}

static void give(const Cells *cells, const ScalpHair *hair, Given *given)
{
    const Strands *strands = hair->strands;
    for (uint32_t s = 0; s < strands->strand_count; ++s) {
        uint32_t v = strands->first[s];
        const float *root = strands->position[v],
                    *color = hair->paint->color ? hair->paint->color[v] : hair->color;
        float width = 2 * hair->radius * (hair->paint->thickness ? hair->paint->thickness[v] : 1),
              cover = hair->each * width * SCALP_TINT_ROOT * (float)strands_length(strands, s);
        int64_t middle[3], cell[3];
        find_cell(cells, root, middle);
        for (int i = 0; i < 27; ++i) {
            for (int k = 0, rest = i; k < 3; ++k, rest /= 3) cell[k] = middle[k] + rest % 3 - 1;
            give_to_cell(cells, cell, root, cover, color, given);
        }
    }
}

static float mean_edge(const Mesh *mesh)
{
    double sum = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; ++t)
        for (int i = 0; i < 3; ++i) {
            const float *a = mesh->position[mesh->triangle[t][i]],
                        *b = mesh->position[mesh->triangle[t][(i + 1) % 3]];
            double square = 0;
            for (int k = 0; k < 3; ++k) square += pow((double)(b[k] - a[k]), 2);
            sum += sqrt(square);
        }
    return mesh->triangle_count ? (float)(sum / (3.0 * mesh->triangle_count)) : 0;
}

static Result give_all(const Mesh *mesh, const ScalpHair *hair, Given *given, Error *error)
{
    if (hair->strands->strand_count == 0) return RESULT_OK;
    Cells cells = {0};
    float reach = fmaxf(4 * follow_plan_auto_radius(hair->strands), mean_edge(mesh));
    if (!(reach > 0) || !isfinite(reach)) return RESULT_OK;
    Result result = fill_cells(&cells, mesh, reach, error);
    if (result == RESULT_OK) give(&cells, hair, given);
    destroy_cells(&cells);
    return result;
}

Result scalp_tint_find(float (*tint)[3], const Mesh *mesh, const float skin[3], float most,
                       const ScalpHair *hair, uint32_t hair_count, Error *error)
{
    Given *given = calloc((size_t)mesh->vertex_count + 1, sizeof *given);
    Result result = given ? RESULT_OK
                          : error_set(error, RESULT_FAILED, "no memory for the tint of %u vertices",
                                      mesh->vertex_count);
    for (uint32_t i = 0; i < hair_count && result == RESULT_OK; ++i)
        result = give_all(mesh, &hair[i], given, error);
    for (uint32_t v = 0; v < mesh->vertex_count && result == RESULT_OK; ++v)
        for (int k = 0; k < 3; ++k) {
            float cover = given[v].cover, weight = most * -expm1f(-cover);
            float color = cover > 0 ? given[v].color[k] / cover : 0;
            tint[v][k] = 1 + weight * (color / fmaxf(skin[k], LEAST_SKIN) - 1);
        }
    free(given);
    return result;
}
