// SPDX-License-Identifier: MIT
// Parallel fibres scatter the light of a lamp into a narrow cone, which the directions and blurred
// lobes of the light grid smear (kernel/cell.h). So the light of a place is multiplied by the ratio
// of two tables: the light that endless, evenly lit hair of this tangent shows to the eye after two
// and more scatterings, by exact lobes and by those of the grid (light_cone.c).
#include "common/shared_math.h"
#ifdef __STDC__
#pragma once
#endif

// Each node of the table (kernel/cell.h) has a row for every CONE_STEP (rad) of the tangents'
// spread, from 0 on. The last row is the grid's own light, so that hair whose tangents spread as
// far is left as it is.
#define CONE_ROWS 6
#define CONE_STEP FLOAT(3.0 * PI / 180.0)
#define CONE_LAST 5 // CONE_ROWS - 1

// The share of an order's light that meets hair again.
#define CONE_MET 0.75f

// The standard deviation (rad) of tangents along each axis across their main tangent, whose sum of
// squared cosines with them is `share` of their area. Few strands in a cell tell little of the hair
// that they stand for, and one strand tells nothing: so the cell gets the area `strand` of one more
// strand with tangents as far apart as `doubt`. Less the smallest angle that matters: without it
// the square root would turn the rounding of 1 into 0.02 degrees.
SHARED_FUNCTION float cone_spread(float share, float area, float strand)
{
    const float doubt = FLOAT(8.0 * PI / 180.0), least = 0.005f;
    float variance = SHARED_MAX(0.5f - 0.5f * share, 0.0f) * area + doubt * doubt * strand;
    return SHARED_SQRT(variance / SHARED_MAX(area + strand, 1e-12f) + least * least) - least;
}

// The place of a spread among the rows: the row before it is the integer part. From CONE_LAST on
// nothing is corrected.
SHARED_FUNCTION float cone_place(float spread) { return spread / CONE_STEP; }

// The ambient light in a cell in the unit of the table, which is the light that lamps reach hair
// with, times its area. `mean`: the cell's mean radiance from all directions; `lamps`: the lit
// areas times the lamps' colours. Hair shows no more ambient light than all of it would give.
SHARED_FUNCTION float cone_around(float mean, float lamps, float around, float area, float albedo)
{
    float most = around * area, part = mean * (1.0f - CONE_MET * albedo) * area;
    return 4.0f / SHARED_MAX(albedo, 1e-3f) *
           SHARED_MIN(SHARED_MAX(part - 0.25f * albedo * lamps, 0.0f), most);
}

// The correction, from the light of both tables. Both are small far off the cone, where the series
// is least certain; so the ratio has limits.
SHARED_FUNCTION float cone_ratio(float exact, float grid)
{
    return SHARED_MIN(SHARED_MAX(exact / SHARED_MAX(grid, 1e-20f), 0.05f), 2.0f);
}
