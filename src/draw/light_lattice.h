// SPDX-License-Identifier: MIT
// The place of a light grid's cells.
#pragma once

#include <stddef.h>

typedef struct LightLattice {
    float turn[3][3]; // rows: the lattice's axes in the world, unit
    float low[3];     // m, along those axes: the first cell's corner
    float side;       // m, of a cell
    int count[3];     // cells along each axis
} LightLattice;

static inline size_t light_lattice_cells(const LightLattice *lattice)
{
    return (size_t)lattice->count[0] * (size_t)lattice->count[1] * (size_t)lattice->count[2];
}

// Turns a vector of the world into the lattice's axes.
static inline void light_lattice_turn(const LightLattice *lattice, const float x[3], float out[3])
{
    for (int k = 0; k < 3; ++k)
        out[k] =
            lattice->turn[k][0] * x[0] + lattice->turn[k][1] * x[1] + lattice->turn[k][2] * x[2];
}
