// SPDX-License-Identifier: MIT
// The way of a strand between its guides: gathered in clumps, wound into curls,
// frizzy; and its vertices, equal segments outside the surface.
#pragma once

#include "base/random.h"
#include "gen/fur_guides.h"

// A curve by arc length of the smooth line within, m.
typedef struct FurWeave {
    FurLine line, side; // the smooth line; a unit vector across it, carried along without turning
    double step;        // m
    double length;      // m, of the strand
    double radius, frequency, phase; // of curls: m, turns a metre, turns
    double frizz;                    // m
    double wave[2][2][2];            // frizz across in two directions, two waves: 1/m, phase
} FurWeave;

#define FUR_NO_GUIDE UINT32_MAX

// The strand with its root there, `length` (m) long, along a guide of its own or between them. All
// that is random in it comes from `random` and, what a clump has in common, from the recipe's seed
// and the clump.
void fur_weave_create(FurWeave *weave, const FurRecipe *recipe, const FurGuides *guides,
                      uint32_t own_guide, const SurfacePoint *root, const Double3 normal,
                      double length, Random *random);

// The curve's place; behind the line's end it goes on straight.
void fur_weave_at(const FurWeave *weave, double s, Double3 place);

// Walks along the curve with steps of `length` / (count - 1), as with dividers, so that the
// vertices' polyline has that length within rounding. A step that would end nearer to the surface
// than `gap` (m), or whose middle would be inside, is turned away from it; then the strand comes
// back to its curve. The first vertex is the curve's beginning. Returns how many steps no turning
// brought outside.
uint32_t fur_weave_cut(const FurWeave *weave, const Surface *surface, const SurfacePoint *root,
                       double gap, double length, Double3 *vertex, uint32_t count);
