// SPDX-License-Identifier: MIT
// The colour that hair gives to the skin it grows from: where roots lie close together, skin goes
// towards their colour, and at the hairline and at partings softly back to its own. Found once, at
// rest, for each vertex of the mesh, so it moves with the mesh and a frame only interpolates it.
#pragma once

#include "mesh/mesh.h"
#include "strands/paint.h"

// Hair of one section.
typedef struct ScalpHair {
    const Strands *strands; // m, the mesh's frame
    const Paint *paint;     // its colours, as one sees them, count where it has some
    float color[3];         // linear RGB of the others, as one sees it
    float radius;           // m
    float each;             // strands that each strand represents (1 + followers)
} ScalpHair;

// The share of a strand, from its root, that counts as lying on the skin.
#define SCALP_TINT_ROOT 0.15f

// tint[mesh->vertex_count]: factors of the mesh's linear colour `skin` that make it the mixture
//     (1 - w) skin + w hair,   w = most (1 - exp(-cover)),   0 <= most <= 1,
// with the mean colour of the roots near the vertex. `cover` is the part of the skin, counted more
// than once where fibres cross, that the lowest SCALP_TINT_ROOT of the strands would cover if it
// lay there: by roots per area, the fibres' widths and the strands' lengths. A root counts for the
// vertices within four times the radius of its share of the scalp (follow_plan_auto_radius), but
// at least within a mean edge of the mesh; farther vertices keep the skin's colour: 1 exactly. A
// channel that the skin lacks (below 1e-3) stays nearly so. RESULT_FAILED if memory is short.
Result scalp_tint_find(float (*tint)[3], const Mesh *mesh, const float skin[3], float most,
                       const ScalpHair *hair, uint32_t hair_count, Error *error);
