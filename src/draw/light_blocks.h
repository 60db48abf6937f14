// SPDX-License-Identifier: MIT
// How a mesh blocks light between the cells of a light grid.
#pragma once

#include "base/error.h"
#include "draw/light_lattice.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// A mesh at its place in the frame: metres, world.
typedef struct LightMesh {
    const float (*vertices)[3];
    const uint32_t (*triangles)[3];
    uint32_t vertex_count, triangle_count;
    float rotation[4], translation[3]; // from the mesh's frame to the world
} LightMesh;

typedef struct LightBlocks {
    LightMesh mesh;
    // [3][cells], owned. For an axis and a cell: 1 if light passes along the line from the middle
    // of the cell before on this axis to the middle of this cell, 0 if the mesh cuts the line. No
    // chain of open lines leads through the mesh.
    float *open;
    size_t room;
} LightBlocks;

// Fills in `open` for this lattice. RESULT_FAILED if memory is short.
Result light_blocks_find(LightBlocks *blocks, const LightLattice *lattice, Error *error);

// The share of light that passes the mesh on the straight line from the middle of `cell` along the
// unit vector `way` (in the lattice's axes), up to the lattice's end or `reach` (m).
float light_blocks_march(const LightBlocks *blocks, const LightLattice *lattice, const int cell[3],
                         const float way[3], float reach);

// The steps from cell to cell that a straight line makes from the middle of a cell, in their order.
// They are the same from every cell, except for where the line leaves the lattice.
enum { LIGHT_PATH_MOST = 3 * 66 };
typedef struct LightPath {
    int count;
    ptrdiff_t way[LIGHT_PATH_MOST]; // in LightBlocks.open, from the cell's own on axis 0
    int until[3][LIGHT_PATH_MOST];  // number of steps before the n-th step on an axis; all steps if
                                    // there is no n-th
    bool up[3];                     // steps on this axis go towards higher cells
} LightPath;

// Finds the path along the unit vector `way`. A lattice has at most 65 cells along each axis.
void light_path_find(LightPath *path, const LightLattice *lattice, const float way[3]);

// The same as light_blocks_march along the path's direction, without a limit of the reach.
float light_path_follow(const LightPath *path, const LightBlocks *blocks,
                        const LightLattice *lattice, const int cell[3]);

void light_blocks_destroy(LightBlocks *blocks);
