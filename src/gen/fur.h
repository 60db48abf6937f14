// SPDX-License-Identifier: MIT
// Grows fur and hair on a mesh.
#pragma once

#include "gen/fur_recipe.h"
#include "mesh/mesh.h"
#include "strands/strands.h"

typedef struct FurReport {
    uint32_t guides, flat_triangles;
    uint64_t stuck; // steps that lie inside the mesh: no turning brought them out
} FurReport;

// Makes strands on the mesh: equal recipes and meshes give equal strands, to the bit, on every
// machine, unless a formula uses functions that C libraries differ in (all but + - * /, sqrt, abs,
// min, max, comparisons, smoothstep and noise). Guides come first. Strands have the texture
// coordinates of their roots if the mesh has some, and thickness by vertex if the recipe has. Each
// length is length x length_map within what length_variation allows, within rounding; strands that
// would be shorter than a thousandth of `length` are left out. `name` is the mesh's file.
// RESULT_USAGE for what cannot be grown by, RESULT_BAD_INPUT for maps and meshes, RESULT_FAILED
// when memory is short.
Result fur_grow(Strands *strands, const FurRecipe *recipe, const Mesh *mesh, const char *name,
                FurReport *report, Error *error);
