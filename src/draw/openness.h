// SPDX-License-Identifier: MIT
// How much of the sky a mesh sees: ambient occlusion by itself and by the hair on it, as both stand
// at rest. It moves with the mesh, costs nothing a frame, and is soft: hair that swings away from
// where it hangs leaves it as it was.
#pragma once

#include "mesh/mesh.h"
#include "strands/strands.h"

// Hair of one section. `each`: strands that every one stands for (1 + followers).
typedef struct OpennessHair {
    const Strands *strands; // m, the mesh's frame
    float radius;           // m
    float each;
} OpennessHair;

// open[mesh->vertex_count]: the share, 0 .. 1, of an even sky's light that reaches each vertex, of
// what it would be without hair and mesh. Hair counts by its density in cubic cells, OPENNESS_CELLS
// along the longest side of both; rays of 48 directions are followed from cell to cell.
// RESULT_FAILED when memory is short.
Result openness_find(float *open, const Mesh *mesh, const OpennessHair *hair, uint32_t hair_count,
                     Error *error);

enum { OPENNESS_CELLS = 32 };
