// SPDX-License-Identifier: MIT
// Strands on a mesh: a groom is fitted to another head, roots are put onto the skin, vertices are
// pushed out of it, and what is inside is measured. The mesh must be closed where hair is near it;
// inside is where surface_nearest says so.
#pragma once

#include "mesh/surface.h"
#include "strands/strands.h"
#include "strands/strands_edit.h"

// How far what was changed has come, m.
typedef struct StrandsShift {
    uint32_t strands, vertices; // that were changed
    double median, most;        // of the roots, or of the vertices that were inside
} StrandsShift;

// Moves each strand as a whole so that its root lies on the surface's nearest point. RESULT_FAILED
// when memory is short.
Result strands_attach(Strands *strands, const Surface *surface, StrandsShift *shift, Error *error);

// Moves vertices that are inside, or nearer to the surface than `gap` (m, at least 0), outwards
// until they are that far away, where hollows leave the room; roots stay. Errors as above.
Result strands_push_out(Strands *strands, const Surface *surface, double gap, StrandsShift *shift,
                        Error *error);

typedef struct StrandsFit {
    StrandsMove move;
    double turned_deg;    // of the rotation
    double moved;         // m, of the middle of the roots
    double before, after; // m: half of the roots lie within it
} StrandsFit;

// Finds the similarity that brings the roots to the surface: nearest points and the best motion to
// them in turn (Besl and McKay 1992, "A method for registration of 3-D shapes"), with the scale
// that makes their spreads equal (Horn 1987), then the best motion to the tangent planes there,
// leaving out the tenth of the roots that is farthest. It starts from where the hair is, and from
// where its roots' box has the mesh's top and its width there; a groom that looks another way is
// not turned round. RESULT_FAILED for fewer than 3 roots, and when memory is short.
Result strands_find_fit(StrandsFit *fit, const Strands *strands, const Surface *surface,
                        Error *error);

// How deep each vertex lies inside, m, to depth [vertex_count]; 0 and less outside, and of roots.
// Errors as above.
Result strands_find_depth(const Strands *strands, const Surface *surface, double *depth,
                          Error *error);
