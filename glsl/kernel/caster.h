// SPDX-License-Identifier: MIT
// Functions for drawing hair into a light's shadow map: the place of a point as the light sees it,
// and the points by which a segment of a ribbon is drawn. For shaders and for vectorised C.
#ifdef __STDC__
#pragma once
#endif
#include "common/shared_math.h"

// A matrix by its rows, as shadow.h has them; element i of row k is m[k][i] in both languages.
#ifdef __STDC__
#define CASTER_ROWS(m) const float(*m)[4]
#else
#define CASTER_ROWS(m) mat4 m
#endif

// Row k times (x, y, z, 1).
SHARED_FUNCTION float caster_row(CASTER_ROWS(m), int k, float x, float y, float z)
{
    return m[k][0] * x + m[k][1] * y + m[k][2] * z + m[k][3];
}

// Texels and depth 0..1 of the hair; w: m before a lamp, else 1.
SHARED_STRUCT(CasterPlace) { float u, v, z, w; };

// What lies beside a lamp or behind it goes far away.
SHARED_FUNCTION CasterPlace caster_place(CASTER_ROWS(m), float x, float y, float z)
{
    float w = caster_row(m, 3, x, y, z), inverse = 1.0f / SHARED_MAX(w, 1e-6f);
    float u = caster_row(m, 0, x, y, z), v = caster_row(m, 1, x, y, z);
    CasterPlace place;
    place.u = w > 0.0f ? u * inverse : -1e6f;
    place.v = w > 0.0f ? v * inverse : -1e6f;
    place.z = caster_row(m, 2, x, y, z);
    place.w = SHARED_MAX(w, 1e-6f);
    return place;
}

// --- Points of a segment. In a texel of the map that they go to, along and across: sums are
// smoothed afterwards, but where ribbons are wide their pattern would show; of first depths none
// may be far from a point, and within a wide ribbon every texel must have one: its inner circle
// does if they are no more than sqrt(1/2) apart. Those of a coarse map are spread to a texel or two
// around each point afterwards, so that fewer will do.
#define CASTER_WIDE         1.5f // texels: wider ribbons have points beside each other, too
#define CASTER_DEEP         0.5f // points in a texel
#define CASTER_DEEP_WIDE    2.0f
#define CASTER_FIRST        1.0f
#define CASTER_COARSE       0.5f
#define CASTER_COARSE_SLACK 0.5f // points that a segment of a coarse map may lack
#define CASTER_FIRST_WIDE   1.42f
#define CASTER_MOST_ALONG   512.0f

// The width in texels of a ribbon between two points of these radii (m) and places.
SHARED_FUNCTION float caster_width(float texels, float radius, float next_radius, float w,
                                   float next_w)
{
    return 2.0f * texels * (radius + next_radius) / (w + next_w);
}

// Points along a segment that is `size` texels long; `density`: in a texel.
SHARED_FUNCTION float caster_along(float size, float density, float slack)
{
    float dense = SHARED_MIN(size * density, CASTER_MOST_ALONG) - slack, whole = FLOAT(INT(dense));
    return SHARED_MAX(whole < dense ? whole + 1.0f : whole, 1.0f);
}

// What each of its points adds to a texel, in steps of which a fibre has `unit`: the segment's area
// is width * size texels, its depth that of fibre_depth. (own_layer_depth says why.)
SHARED_FUNCTION uint caster_part(float depth, float width, float size, float unit, float points)
{
    float sum = SHARED_MAX(depth * width * size * unit, 0.0f);
    return UINT(INT(SHARED_MIN(sum / points, 2e9f) + 0.5f));
}
