// SPDX-License-Identifier: MIT
// Warns if the hair of a body does not grow from its mesh.
#pragma once

#include "mesh/mesh.h"
#include "scene/scene.h"
#include "strands/strands.h"

#include <stdio.h>

// `mesh`: of the body; `strands`: of all sections of the scene; `hair_unit`: m, of the body's first
// hair file. If half of the roots of the body's visible sections are farther from its rigid mesh
// than 2 % of the diagonal of the mesh's bounding box, prints a line on `messages` with distance,
// diagonal and, if the roots lie on the mesh with one of the named units, the option that sets it.
// Does nothing if no triangle of the mesh has an area. RESULT_FAILED when memory is short.
Result root_distance_warn(const Scene *scene, uint32_t body, const Mesh *mesh,
                          const Strands *strands, double hair_unit, FILE *messages, Error *error);
