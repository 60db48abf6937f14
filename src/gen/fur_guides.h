// SPDX-License-Identifier: MIT
// Guides: strands that are grown over a surface, for others to lie between.
#pragma once

#include "base/nearest.h"
#include "gen/fur_map.h"
#include "gen/fur_recipe.h"

enum { FUR_STEPS = 72 }; // of a guide's line

// A strand's line: places at equal steps along it.
typedef Double3 FurLine[FUR_STEPS + 1];

typedef struct FurGuides {
    uint32_t count;
    double step;      // m, between the places of a line
    FurLine *line;    // [count]
    float (*root)[3]; // [count]
    Nearest nearest;  // among all
    uint32_t clumps;  // the first of them, that strands gather around; 0: none
    Nearest centers;  // among those
} FurGuides;

// Grows a guide from each of `count` roots, a fifth longer than the longest strand: strands that
// lie between guides or wind about them need more than their length.
//
// A guide leaves its root between the surface's normal and the combed direction, by lift_deg. On
// the way, at arc length s, the direction d comes to lie as it is combed there, turns down and
// strays:
//
//     d' = (c - d)/lie + gravity_bend (g - (g.d) d) + noise N(place/noise_size)
//
// with c and g the combed direction at the surface's nearest point and down, c as long as s is
// below comb_reach. It keeps outside the surface: root_lift at the root, `volume` more far from it.
// RESULT_FAILED when memory is short.
Result fur_guides_create(FurGuides *guides, const FurRecipe *recipe, const Surface *surface,
                         const FurComb *comb, const SurfacePoint *roots, uint32_t count,
                         Error *error);
void fur_guides_destroy(FurGuides *guides);

// A line's place at arc length `s` (m); before and behind it goes on straight.
void fur_guides_line_at(const Double3 *line, double step, double s, Double3 place);
