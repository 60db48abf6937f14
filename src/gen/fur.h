// SPDX-License-Identifier: MIT
// Grows fur and hair on a mesh.
#pragma once

#include "gen/fur_recipe.h"
#include "mesh/mesh.h"
#include "strands/strands.h"

typedef struct FurReport {
    uint32_t guides, flat_triangles;
    uint64_t stuck; // number of steps that lie inside the mesh because no turning brought them
                    // outside
} FurReport;

// Makes strands on the mesh. Equal recipes and meshes give equal strands, to the bit, on every
// machine, unless a formula uses functions that differ between C libraries (all but + - * /, sqrt,
// abs, min, max, comparisons, smoothstep and noise). Guides come first. Strands get the texture
// coordinates of their roots if the mesh has any, and thickness by vertex if the recipe has it.
// Each length is length x length_map, varied by up to length_variation, within rounding; strands
// shorter than a thousandth of `length` are left out. `name` is the mesh's file. RESULT_USAGE for
// an invalid recipe, RESULT_BAD_INPUT for maps and meshes, RESULT_FAILED when memory is short.
Result fur_grow(Strands *strands, const FurRecipe *recipe, const Mesh *mesh, const char *name,
                FurReport *report, Error *error);
