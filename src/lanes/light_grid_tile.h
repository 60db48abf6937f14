// SPDX-License-Identifier: MIT
// Strands for a light grid, 16 at once, one for each lane: one of each group of `step` strands,
// which represents the group (kernel/cell.h). For light_grid_lattice.c and light_grid_items.c.
#pragma once

#include "lanes/light_grid_state.h"

enum { W = STRAND_TILE };

// Lanes from `strands` on repeat the first strand.
typedef struct GridStrands {
    const GridHair *hair;
    int strands;
    size_t root[W]; // particle of the root; the others follow it STRAND_TILE apart
    int number[W];
} GridStrands;

// The number of groups of 16 strands of a batch.
static inline int grid_turns(const GridHair *hair, uint step)
{
    return (int)((cell_strands(hair->caster.material.drawn_strands, step) + W - 1) / W);
}

static inline void grid_open_strands(const GridHair *hair, uint step, int turn,
                                     GridStrands *strands)
{
    const MaterialParams *m = &hair->caster.material;
    uint count = cell_strands(m->drawn_strands, step), first = (uint)turn * W;
    strands->hair = hair;
    strands->strands = count - first < W ? (int)(count - first) : W;
    for (uint i = 0; i < W; ++i) {
        uint s = cell_strand(first + (i < count - first ? i : 0), m->drawn_strands, step);
        strands->number[i] = (int)s;
        strands->root[i] = (size_t)(s / W) * m->vertex_count * W + s % W;
    }
}

// Particle j of each strand, world.
SIMD_INLINE void grid_read_points(const GridStrands *strands, int j, float x[3][W])
{
    for (int i = 0; i < W; ++i) {
        const float *at = strands->hair->caster.position[strands->root[i] + (size_t)j * W];
        for (int k = 0; k < 3; ++k) x[k][i] = at[k];
    }
}

// The same in the lattice's axes.
SIMD_INLINE void grid_turn_points(const LightLattice *lattice, const GridStrands *strands, int j,
                                  float out[3][W])
{
    float x[3][W];
    grid_read_points(strands, j, x);
    for (int k = 0; k < 3; ++k) {
        float a = lattice->turn[k][0], b = lattice->turn[k][1], c = lattice->turn[k][2];
        for (int i = 0; i < W; ++i) out[k][i] = a * x[0][i] + b * x[1][i] + c * x[2][i];
    }
}

// The groups that one of `parts` threads works on, from range[0] to before range[1].
static inline void grid_turn_range(const GridHair *hair, uint step, int part, int parts,
                                   int range[2])
{
    int64_t turns = grid_turns(hair, step);
    range[0] = (int)(turns * part / parts);
    range[1] = (int)(turns * (part + 1) / parts);
}
