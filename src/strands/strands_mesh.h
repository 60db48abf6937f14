// SPDX-License-Identifier: MIT
// Strands on a mesh: fits a groom to another head, puts roots onto the surface, pushes vertices out
// of the mesh and measures depths. The mesh must be closed near the hair; surface_nearest decides
// what is inside.
#pragma once

#include "mesh/surface.h"
#include "strands/strands.h"
#include "strands/strands_edit.h"

// How far vertices were moved, m.
typedef struct StrandsShift {
    uint32_t strands, vertices; // number changed
    double median, most;        // of the roots, or of the vertices that were inside
} StrandsShift;

// Moves each strand as a whole so that its root is at the nearest point of the surface.
// RESULT_FAILED when memory is short.
Result strands_attach(Strands *strands, const Surface *surface, StrandsShift *shift, Error *error);

// Moves vertices outwards that are inside or nearer to the surface than `gap` (m, at least 0),
// until they have that distance, unless a hollow is too narrow. Roots stay. Errors as above.
Result strands_push_out(Strands *strands, const Surface *surface, double gap, StrandsShift *shift,
                        Error *error);

typedef struct StrandsFit {
    StrandsMove move;
    double turned_deg;    // angle of the rotation
    double moved;         // m, by the centre of the roots
    double before, after; // m, median distance of the roots
} StrandsFit;

// Finds the similarity that brings the roots to the surface by ICP: alternates between nearest
// points and the best motion towards them (Besl and McKay 1992, "A method for registration of 3-D
// shapes"), with the scale that makes their spreads equal (Horn 1987); then uses the best motion
// towards the tangent planes. The farthest tenth of the roots is left out. It starts from the hair
// as it is, and from positions at the top of the mesh with the width of the mesh there. A groom
// that faces another direction is not turned round. RESULT_FAILED for fewer than 3 roots and when
// memory is short.
Result strands_find_fit(StrandsFit *fit, const Strands *strands, const Surface *surface,
                        Error *error);

// Writes the depth of each vertex inside the mesh (m) to depth [vertex_count]; 0 or less for
// vertices outside and for roots. Errors as above.
Result strands_find_depth(const Strands *strands, const Surface *surface, double *depth,
                          Error *error);
