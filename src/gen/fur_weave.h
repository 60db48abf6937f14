// SPDX-License-Identifier: MIT
// The curve of a strand between its guides: gathered in clumps, wound into curls, frizzy; and its
// vertices, equal segments outside the surface.
#pragma once

#include "base/random.h"
#include "gen/fur_guides.h"

// A curve, parametrised by the arc length of the smooth line inside it, m.
typedef struct FurWeave {
    FurLine line, side; // the smooth line; a unit vector across it, carried along without twist
    double step;        // m
    double length;      // m, of the strand
    double radius, frequency, phase; // of curls: m, turns per metre, turns
    double frizz;                    // m
    double wave[2][2][2]; // two waves of frizz in each of two directions across: 1/m, phase
} FurWeave;

#define FUR_NO_GUIDE UINT32_MAX

// The curve of a strand with this root, `length` (m) long, along its own guide or between guides.
// Random numbers come from `random`, and those that a clump shares, from the recipe's seed and the
// clump's number.
void fur_weave_create(FurWeave *weave, const FurRecipe *recipe, const FurGuides *guides,
                      uint32_t own_guide, const SurfacePoint *root, const Double3 normal,
                      double length, Random *random);

// A point of the curve; beyond the line's end, it continues straight.
void fur_weave_at(const FurWeave *weave, double s, Double3 place);

// Walks along the curve in steps of `length` / (count - 1), like a pair of dividers, so that the
// vertices' polyline has that length within rounding. A step that would end nearer to the surface
// than `gap` (m), or whose middle would be inside, is turned away from it; then the strand returns
// to its curve. The first vertex is the curve's start. Returns the number of steps that no turning
// brought outside.
uint32_t fur_weave_cut(const FurWeave *weave, const Surface *surface, const SurfacePoint *root,
                       double gap, double length, Double3 *vertex, uint32_t count);
