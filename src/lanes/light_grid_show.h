// SPDX-License-Identifier: MIT
// The light among hair that 16 points send to the eye. It is the radiance of the eight cells around
// each point (trilinear), weighted by the share that a fibre with the point's tangent scatters from
// each direction to the eye. Both are computed together for 16 tangents, a patch, when the first
// point asks for this patch of a cell (light_grid_patch). Points that follow interpolate in the
// patch.
#pragma once

#include "lanes/light_grid_state.h"

#include "glsl/common/shared.h"
#include "glsl/kernel/cell.h"

// Turns tangents into the frame of the tables, which are made for one direction to the eye.
SIMD_INLINE void grid_turn_tangents(const float eye[3], const float axis[3],
                                    const float p[3][STRAND_TILE], float t[3][STRAND_TILE])
{
    const CellVector to = {axis[0], axis[1], axis[2]};
    for (int i = 0; i < STRAND_TILE; ++i) {
        CellVector tangent = {t[0][i], t[1][i], t[2][i]},
                   way = {eye[0] - p[0][i], eye[1] - p[1][i], eye[2] - p[2][i]};
        tangent = cell_turn(tangent, way, to);
        t[0][i] = tangent.x, t[1][i] = tangent.y, t[2][i] = tangent.z;
    }
}

// The place of 16 points among cells and tangents. For each axis: the cells before and behind each
// point, as the part of the cell's number that belongs to this axis, and their weights. Then the
// number of the point's own cell, and the place of its tangent in its patch.
typedef struct SIMD_ALIGNED GridPlaces {
    int cell[3][2][STRAND_TILE], own[STRAND_TILE];
    float share[3][2][STRAND_TILE];
    int patch[STRAND_TILE], node[STRAND_TILE];
    float u[STRAND_TILE], v[STRAND_TILE];
} GridPlaces;

SIMD_INLINE void grid_find_places(const LightLattice *lattice, const float x[3][STRAND_TILE],
                                  const float tangent[3][STRAND_TILE], GridPlaces *places)
{
    const float inverse = 1 / lattice->side;
    int stride = 1;
    memset(places->own, 0, sizeof places->own);
    for (int k = 0; k < 3; ++k) {
        int most = lattice->count[k] - 1;
        float last = (float)most;
        for (int i = 0; i < STRAND_TILE; ++i) {
            float at = (x[k][i] - lattice->low[k]) * inverse,
                  from = simd_min(simd_max(at - 0.5f, -0.5f), last + 0.5f);
            int low = (int)(from + 1) - 1;
            places->cell[k][0][i] = stride * (low < 0 ? 0 : low);
            places->cell[k][1][i] = stride * (low < most ? low + 1 : most);
            places->share[k][1][i] = from - (float)low;
            places->share[k][0][i] = 1 - places->share[k][1][i];
            places->own[i] += stride * (int)simd_min(simd_max(at, 0), last);
        }
        stride *= lattice->count[k];
    }
    for (int i = 0; i < STRAND_TILE; ++i) {
        CellTangent at = cell_tangent(tangent[0][i], tangent[1][i], tangent[2][i]);
        places->patch[i] = at.in_patch;
        places->node[i] = at.node;
        places->u[i] = at.u;
        places->v[i] = at.v;
    }
}

typedef float GridColor __attribute__((vector_size(16), aligned(4), may_alias));

// The light of one row of a cone's table at a point, between the four nodes around its tangent.
SIMD_INLINE GridColor grid_cone_row(const float (*nodes)[CONE_ROWS][4], int row, float u, float v)
{
    const float(*below)[CONE_ROWS][4] = nodes + CELL_NODES_ROW;
    GridColor a = *(const GridColor *)nodes[0][row], b = *(const GridColor *)nodes[1][row],
              c = *(const GridColor *)below[0][row], d = *(const GridColor *)below[1][row];
    a += u * (b - a);
    c += u * (d - c);
    return a + v * (c - a);
}

// Multiplies the light that point i shows by the factor of kernel/cone.h. `cone`: the sum over the
// cells around the point.
SIMD_INLINE void grid_narrow(const LightGridState *state, int kind, const GridCone *cone,
                             const GridPlaces *places, int i, float seen[3])
{
    float place = cone_place(cone->spread / simd_max(cone->area, 1e-12f));
    if (!(place < CONE_LAST) || state->field.lights == 0) return;
    int row = (int)place, node = cell_node(places->patch[i], places->node[i]);
    GridColor exact = {cone->around[0], cone->around[1], cone->around[2]}, grid = exact;
    for (int l = 0; l < state->field.lights; ++l) {
        const float(*nodes)[CONE_ROWS][4] =
            (const float(*)[CONE_ROWS][4])state->field.kinds[kind].cone[l] + node;
        float u = places->u[i], v = places->v[i];
        GridColor a = grid_cone_row(nodes, row, u, v), b = grid_cone_row(nodes, row + 1, u, v);
        exact += cone->lit[l] * (a + (place - (float)row) * (b - a));
        grid += cone->lit[l] * grid_cone_row(nodes, CONE_LAST, u, v);
    }
    for (int c = 0; c < 3; ++c)
        if (grid[c] > 0) seen[c] *= cone_ratio(exact[c], grid[c]);
}

// Two neighbouring nodes: red, green, blue and an unused number of each.
typedef float GridPair __attribute__((vector_size(32), aligned(4), may_alias));

// The light that point i sends to the eye.
SIMD_INLINE void grid_show_point(const LightGridState *state, int kind, const GridPlaces *places,
                                 int i, float seen[3])
{
    GridPair row = {0}, next = {0};
    GridCone cone = {.area = 0};
    for (int q = 0; q < 8; ++q) {
        int x = q & 1, y = q >> 1 & 1, z = q >> 2;
        float weight = places->share[2][z][i] * places->share[1][y][i] * places->share[0][x][i],
              scratch[CELL_PATCH_NODES][4];
        int slot =
            state->slot[places->cell[2][z][i] + places->cell[1][y][i] + places->cell[0][x][i]];
        const float(*patch)[4] = light_grid_patch(state, kind, slot < 0 ? state->active : slot,
                                                  places->patch[i], scratch) +
                                 places->node[i];
        if (slot >= 0 && slot < state->filled)
            *(GridConeLanes *)&cone += weight * *(const GridConeLanes *)&state->cone[slot];
        row += weight * *(const GridPair *)patch[0];
        next += weight * *(const GridPair *)patch[CELL_PATCH_ROW];
    }
    row += places->v[i] * (next - row);
    for (int c = 0; c < 3; ++c) seen[c] = row[c] + places->u[i] * (row[4 + c] - row[c]);
    grid_narrow(state, kind, &cone, places, i, seen);
}

// The light that the first `count` of 16 points send to the eye, linear RGB. x: world, m. Tangents:
// world, of any length. Neither may be NaN or infinite in any lane. Call light_grid_prepare first.
SIMD_INLINE void light_grid_show(const LightGrid *grid, int kind, const float x[3][STRAND_TILE],
                                 const float tangent[3][STRAND_TILE], int count,
                                 float seen[3][STRAND_TILE])
{
    const LightGridState *state = grid->state;
    float p[3][STRAND_TILE], t[3][STRAND_TILE];
    GridPlaces places;
    memset(seen, 0, 3 * sizeof *seen);
    if (!state || !state->filled) return;
    for (int k = 0; k < 3; ++k) {
        const float *turn = state->field.lattice.turn[k];
        for (int i = 0; i < STRAND_TILE; ++i) {
            p[k][i] = turn[0] * x[0][i] + turn[1] * x[1][i] + turn[2] * x[2][i];
            t[k][i] = turn[0] * tangent[0][i] + turn[1] * tangent[1][i] + turn[2] * tangent[2][i];
        }
    }
    const GridKind *of = &state->field.kinds[kind];
    grid_turn_tangents(state->eye, of->gather_eye, (const float(*)[STRAND_TILE])p, t);
    grid_find_places(&state->field.lattice, (const float(*)[STRAND_TILE])p,
                     (const float(*)[STRAND_TILE])t, &places);
    for (int i = 0; i < count; ++i) {
        int slot = state->slot[places.own[i]];
        const float *hidden = state->hidden + 4 * (size_t)(slot < 0 ? state->active : slot);
        float own[3];
        if (hidden[3] > 0)
            for (int c = 0; c < 3; ++c)
                own[c] = hidden[c] * of->lobes.albedo[SCATTER_INCLINATIONS - 1][c];
        else
            grid_show_point(state, kind, &places, i, own);
        for (int c = 0; c < 3; ++c) seen[c][i] = own[c];
    }
}
