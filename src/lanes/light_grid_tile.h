// SPDX-License-Identifier: MIT
// Tiles of strands, one a lane, for light_grid_lattice.c and light_grid_items.c.
#pragma once

#include "lanes/light_grid_state.h"

enum { W = STRAND_TILE };

SIMD_INLINE void turn_points(const LightLattice *lattice, const float (*x)[4], float out[3][W])
{
    for (int k = 0; k < 3; ++k) {
        float a = lattice->turn[k][0], b = lattice->turn[k][1], c = lattice->turn[k][2];
        for (int i = 0; i < W; ++i) out[k][i] = a * x[i][0] + b * x[i][1] + c * x[i][2];
    }
}

static void tile_range(const GridHair *hair, int part, int parts, int range[2])
{
    int64_t tiles = ((int64_t)hair->caster.material.drawn_strands + W - 1) / W;
    range[0] = (int)(tiles * part / parts);
    range[1] = (int)(tiles * (part + 1) / parts);
}

static const float (*tile_points(const GridHair *hair, int tile, int j))[4]
{
    return hair->caster.position +
           ((size_t)tile * hair->caster.material.vertex_count + (size_t)j) * W;
}

static int tile_strands(const GridHair *hair, int tile)
{
    int left = (int)hair->caster.material.drawn_strands - tile * W;
    return left < W ? left : W;
}
