// SPDX-License-Identifier: MIT
// What a mesh takes away of the light that goes from cell to cell of a light grid.
#pragma once

#include "base/error.h"
#include "draw/light_lattice.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// A mesh where it stands: metres, world.
typedef struct LightMesh {
    const float (*vertices)[3];
    const uint32_t (*triangles)[3];
    uint32_t vertex_count, triangle_count;
    float rotation[4], translation[3]; // its frame -> world
} LightMesh;

typedef struct LightBlocks {
    LightMesh mesh;
    // [3][cells], owned: 1 where light passes between the middle of the cell before (on each axis)
    // and that of the cell, 0 where the mesh crosses that way: no chain of open ways leads through
    // it
    float *open;
    size_t room;
} LightBlocks;

// Finds `open` for this lattice. RESULT_FAILED if memory is short.
Result light_blocks_find(LightBlocks *blocks, const LightLattice *lattice, Error *error);

// Share of light that the mesh lets through on the straight way from the middle of `cell` along the
// unit vector `way` (of the lattice) out of the lattice, or as far as `reach` (m).
float light_blocks_march(const LightBlocks *blocks, const LightLattice *lattice, const int cell[3],
                         const float way[3], float reach);

// The ways that a straight way from the middle of any cell crosses, in their order: the same ones
// from each cell, but for where they leave the lattice.
enum { LIGHT_PATH_MOST = 3 * 66 };
typedef struct LightPath {
    int count;
    ptrdiff_t way[LIGHT_PATH_MOST]; // in LightBlocks.open, from the cell's own on axis 0
    int until[3][LIGHT_PATH_MOST]; // ways before the n-th step on an axis; those there are not: all
    bool up[3];                    // the axis' steps are towards higher cells
} LightPath;

// The path along the unit vector `way`. Lattices have 65 cells along each axis at most.
void light_path_find(LightPath *path, const LightLattice *lattice, const float way[3]);

// What light_blocks_march finds along the path's way, with no bound to its reach.
float light_path_follow(const LightPath *path, const LightBlocks *blocks,
                        const LightLattice *lattice, const int cell[3]);

void light_blocks_destroy(LightBlocks *blocks);
