// SPDX-License-Identifier: MIT
// Guides: strands that grow over a surface; the other strands are interpolated between them.
#pragma once

#include "base/nearest.h"
#include "gen/fur_map.h"
#include "gen/fur_recipe.h"

enum { FUR_STEPS = 72 }; // of a guide's line

// A strand's line: points at equal steps along it.
typedef Double3 FurLine[FUR_STEPS + 1];

typedef struct FurGuides {
    uint32_t count;
    double step;      // m, between the points of a line
    FurLine *line;    // [count]
    float (*root)[3]; // [count]
    Nearest nearest;  // search among all roots
    uint32_t clumps;  // number of guides, from the first on, around which strands gather; 0: no
                      // clumps
    Nearest centers;  // search among the roots of those
} FurGuides;

// Grows a guide from each of `count` roots, a fifth longer than the longest strand, because strands
// that lie between guides or wind around them need more than their own length.
//
// A guide starts at its root between the surface's normal and the combed direction, by lift_deg.
// Further on, at arc length s, its direction d turns towards the combed direction, turns down, and
// strays:
//
//     d' = (c - d)/lie + gravity_bend (g - (g.d) d) + noise N(place/noise_size)
//
// with the combed direction c at the surface's nearest point, and down, g. The length of c falls to
// 0 as s approaches comb_reach. The guide stays outside the surface: by root_lift at the root, and
// by `volume` more far from it. RESULT_FAILED when memory is short.
Result fur_guides_create(FurGuides *guides, const FurRecipe *recipe, const Surface *surface,
                         const FurComb *comb, const SurfacePoint *roots, uint32_t count,
                         Error *error);
void fur_guides_destroy(FurGuides *guides);

// A line's point at arc length `s` (m); beyond its ends, the line continues straight.
void fur_guides_line_at(const Double3 *line, double step, double s, Double3 place);
