// SPDX-License-Identifier: MIT
// The light that hair sends onto 16 points of skin (kernel/onto.h).
#pragma once

#include "lanes/light_grid_state.h"

#include "glsl/kernel/onto.h"

// Whether light_grid_solve has found this light.
static inline bool light_grid_lights_skin(const LightGrid *grid)
{
    return grid && grid->state && grid->state->filled && grid->state->lights_skin;
}

// The eight cells around a point of the lattice's axes (m), as in light_grid_show.h: for each axis
// the index and the weight of two cells. Returns the square of the distance to the lattice.
SIMD_INLINE float onto_find_cells(const LightLattice *lattice, const float p[3], int cell[3][2],
                                  float share[3][2])
{
    float away2 = 0;
    for (int k = 0; k < 3; ++k) {
        float at = (p[k] - lattice->low[k]) / lattice->side, most = (float)lattice->count[k],
              inside = simd_min(simd_max(at, 0), most), off = (at - inside) * lattice->side,
              from = simd_min(simd_max(inside - 0.5f, 0), most - 1);
        int low = (int)from;
        cell[k][0] = low;
        cell[k][1] = low + 1 < lattice->count[k] ? low + 1 : low;
        share[k][1] = from - (float)low;
        share[k][0] = 1 - share[k][1];
        away2 += off * off;
    }
    return away2;
}

// A point at p with the unit normal n, both in the lattice's axes.
SIMD_INLINE void onto_point(const LightGridState *state, const float p[3], const float n[3],
                            float light[3])
{
    const LightLattice *lattice = &state->field.lattice;
    const int *count = lattice->count;
    int cell[3][2], longest = count[0] > count[1] ? count[0] : count[1];
    float share[3][2], sum[3] = {0}, weights = 0, away = onto_find_cells(lattice, p, cell, share);
    const float(*faces[8])[4];
    float brightest = 0;
    longest = longest > count[2] ? longest : count[2];
    for (int q = 0; q < 8; ++q) {
        const size_t at =
            ((size_t)cell[2][q >> 2] * (size_t)count[1] + (size_t)cell[1][q >> 1 & 1]) *
                (size_t)count[0] +
            (size_t)cell[0][q & 1];
        faces[q] = (const float(*)[4])state->onto[at];
        brightest = simd_max(brightest, faces[q][0][3]);
    }
    for (int q = 0; q < 8; ++q) {
        const float(*face)[4] = faces[q];
        float weight = face[0][3] > ONTO_LEAST * brightest
                           ? share[2][q >> 2] * share[1][q >> 1 & 1] * share[0][q & 1]
                           : 0;
        weights += weight;
        for (int k = 0; k < 3; ++k) {
            const float *to = face[onto_face(k, n[k])];
            float part = weight * onto_share(n[k]);
            for (int c = 0; c < 3; ++c) sum[c] += part * to[c];
        }
    }
    float scale = onto_away(away, (float)longest * lattice->side) / simd_max(weights, 1e-6f);
    for (int c = 0; c < 3; ++c) light[c] = scale * sum[c];
}

// The mean light that hair sends onto the points x (m) of surfaces with these unit normals, both in
// the world. Values of points that are not finite are not used.
SIMD_INLINE void light_grid_onto(const LightGrid *grid, const float x[3][STRAND_TILE],
                                 const float normal[3][STRAND_TILE], float light[3][STRAND_TILE])
{
    const LightGridState *state = grid->state;
    const LightLattice *lattice = &state->field.lattice;
    for (int i = 0; i < STRAND_TILE; ++i) {
        const float n[3] = {normal[0][i], normal[1][i], normal[2][i]},
                    above = ONTO_ABOVE * lattice->side;
        float p[3], q[3], m[3], seen[3];
        for (int k = 0; k < 3; ++k) q[k] = x[k][i] + above * n[k];
        light_lattice_turn(lattice, q, p);
        light_lattice_turn(lattice, n, m);
        onto_point(state, p, m, seen);
        for (int c = 0; c < 3; ++c) light[c][i] = seen[c];
    }
}
