// SPDX-License-Identifier: MIT
// The colour that hair gives to the skin it grows from. Where roots are close together, skin takes
// their colour. Towards the hairline and partings it returns softly to its own colour. The tint is
// found once, at rest, for each vertex of the mesh. So it moves with the mesh, and a frame only
// interpolates it.
#pragma once

#include "mesh/mesh.h"
#include "strands/paint.h"

// Hair of one section.
typedef struct ScalpHair {
    const Strands *strands; // m, the mesh's frame
    const Paint *paint;     // visible colours of the strands that have colours of their own
    float color[3];         // linear RGB: visible colour of the other strands
    float radius;           // m
    float each;             // strands that each strand represents (1 + followers)
} ScalpHair;

// The share of a strand, from its root, that counts as lying on the skin.
#define SCALP_TINT_ROOT 0.15f

// tint[mesh->vertex_count]: factors of the mesh's linear colour `skin` that make it the mixture
//     (1 - w) skin + w hair,   w = most (1 - exp(-cover)),   0 <= most <= 1,
// with the mean colour of the roots near the vertex. For `cover`, imagine that the lowest
// SCALP_TINT_ROOT of each strand lies on the skin: it is the area of these fibres divided by the
// area of the skin, from the roots per area, the fibres' widths and the strands' lengths. It
// exceeds 1 where fibres cross often. A root counts for the vertices within four times the radius
// of its share of the scalp (follow_plan_auto_radius), but at least within a mean edge of the mesh.
// Farther vertices keep the skin's colour: their factor is exactly 1. A channel that the skin lacks
// (below 1e-3) stays nearly 0. RESULT_FAILED if memory is short.
Result scalp_tint_find(float (*tint)[3], const Mesh *mesh, const float skin[3], float most,
                       const ScalpHair *hair, uint32_t hair_count, Error *error);
