// SPDX-License-Identifier: MIT
// How much of the sky each vertex of a mesh sees: ambient occlusion by the mesh itself and by the
// hair on it, both at rest. The values move with the mesh and cost nothing in a frame. They do not
// follow hair that swings away from its rest style.
#pragma once

#include "mesh/mesh.h"
#include "strands/strands.h"

// Hair of one section. `each`: the number of strands that each strand represents (1 + followers).
typedef struct OpennessHair {
    const Strands *strands; // m, in the mesh's frame
    float radius;           // m
    float each;
} OpennessHair;

// open[mesh->vertex_count]: the share, 0 .. 1, of an even sky's light that reaches each vertex past
// hair and mesh, and the share that would reach it past the mesh alone. Hair counts by its density
// in cubic cells, OPENNESS_CELLS along the longest side of hair and mesh. Rays in 48 directions go
// from cell to cell. RESULT_FAILED if memory is short.
Result openness_find(float (*open)[2], const Mesh *mesh, const OpennessHair *hair,
                     uint32_t hair_count, Error *error);

enum { OPENNESS_CELLS = 32 };
