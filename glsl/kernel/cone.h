// SPDX-License-Identifier: MIT
// The correction of the light grid for hair of parallel fibres. Such fibres scatter the light of a
// lamp into a narrow cone. The directions and the blurred lobes of the grid (kernel/cell.h) widen
// this cone. So the light at a point is multiplied by a ratio: the light that endless, evenly lit
// hair of the point's tangent shows to the eye after two and more scatterings by exact lobes,
// divided by the same light by the grid's lobes. light_cone.c makes the table of both.
#include "common/shared_math.h"
#ifdef __STDC__
#pragma once
#endif

// Each node of the table (kernel/cell.h) has a row for each of the spreads 0, CONE_STEP (rad), 2
// CONE_STEP ... of the tangents. The last row is the light by the grid's lobes: hair with this
// spread or a larger one is not corrected.
#define CONE_ROWS 6
#define CONE_STEP FLOAT(3.0 * PI / 180.0)
#define CONE_LAST 5 // CONE_ROWS - 1

// The share of an order's light that meets hair again.
#define CONE_MET 0.75f

// The standard deviation (rad) of a cell's tangents along each axis across their main tangent.
// `share`: the mean squared cosine between the tangents and the main tangent; `area`: of the cell's
// hair. Few strands in a cell tell little about the hair that they represent, and a single strand
// tells nothing. Therefore one more strand counts, which has the area `strand` and whose tangents
// have the standard deviation `doubt`. `least` is inside and outside of the square root because a
// plain square root would turn the rounding of a share near 1 into 0.02 degrees.
SHARED_FUNCTION float cone_spread(float share, float area, float strand)
{
    const float doubt = FLOAT(8.0 * PI / 180.0), least = 0.005f;
    float variance = SHARED_MAX(0.5f - 0.5f * share, 0.0f) * area + doubt * doubt * strand;
    return SHARED_SQRT(variance / SHARED_MAX(area + strand, 1e-12f) + least * least) - least;
}

// The place of a spread among the rows: its integer part is the row before it. From CONE_LAST on
// nothing is corrected.
SHARED_FUNCTION float cone_place(float spread) { return spread / CONE_STEP; }

// The ambient part of a cell's light. Its unit is that of the table: the lamps' light where it
// reaches hair, times the area of this hair. `mean`: the cell's mean radiance from all directions;
// `lamps`: the sum of lit areas times the lamps' colours; `around`: the mean ambient radiance. The
// part is at most that of hair which nothing hides from the ambient light.
SHARED_FUNCTION float cone_around(float mean, float lamps, float around, float area, float albedo)
{
    float most = around * area, part = mean * (1.0f - CONE_MET * albedo) * area;
    return 4.0f / SHARED_MAX(albedo, 1e-3f) *
           SHARED_MIN(SHARED_MAX(part - 0.25f * albedo * lamps, 0.0f), most);
}

// The factor of the correction, from the light by exact lobes and by the grid's lobes. Far off the
// cone both are small and the series is least accurate, so the factor has limits.
SHARED_FUNCTION float cone_ratio(float exact, float grid)
{
    return SHARED_MIN(SHARED_MAX(exact / SHARED_MAX(grid, 1e-20f), 0.05f), 2.0f);
}
