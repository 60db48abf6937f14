// SPDX-License-Identifier: MIT
// Draws hair into a light's shadow map: the place of a point in the light's view, and the points
// that a segment of a ribbon is drawn by. For shaders and for vectorised C.
#ifdef __STDC__
#pragma once
#endif
#include "common/shared_math.h"

// A matrix as rows, as in shadow.h. Element i of row k is m[k][i] in both languages.
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

// u, v in texels; depth, 0..1 over the hair's range; w: distance in m for a lamp, 1 for a
// directional light.
SHARED_STRUCT(CasterPlace) { float u, v, z, w; };

// Points beside or behind a lamp are moved far away.
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

// --- Points of a segment: their number for each texel that they are drawn to, along and across the
// segment. Sums of layers are smoothed afterwards, so few points are enough, except for wide
// ribbons, where their pattern would show. First depths need a point near each place of the
// segment; a wide ribbon needs one in each texel, which holds if points are at most sqrt(1/2)
// texels apart (the texel's inscribed circle). A coarse map's depths are spread by one or two
// texels afterwards, so it needs fewer points.
#define CASTER_WIDE         1.5f // texels: wider ribbons also have points across them
#define CASTER_DEEP         0.5f // points for each texel
#define CASTER_DEEP_WIDE    2.0f
#define CASTER_FIRST        1.0f
#define CASTER_COARSE       0.5f
#define CASTER_COARSE_SLACK 0.5f // a segment of a coarse map may have this many points less
#define CASTER_FIRST_WIDE   1.42f
#define CASTER_MOST_ALONG   512.0f

// The width in texels of a ribbon between two points with these radii (m) and distances w.
SHARED_FUNCTION float caster_width(float texels, float radius, float next_radius, float w,
                                   float next_w)
{
    return 2.0f * texels * (radius + next_radius) / (w + next_w);
}

// The number of points along a segment that is `size` texels long. `density`: points for each
// texel.
SHARED_FUNCTION float caster_along(float size, float density, float slack)
{
    float dense = SHARED_MIN(size * density, CASTER_MOST_ALONG) - slack, whole = FLOAT(INT(dense));
    return SHARED_MAX(whole < dense ? whole + 1.0f : whole, 1.0f);
}

// The value that each point adds to a texel, in integer steps; `unit` steps are one fibre. The
// segment's area is width * size texels; its optical depth is fibre_depth. (own_layer_depth gives
// the reason.)
SHARED_FUNCTION uint caster_part(float depth, float width, float size, float unit, float points)
{
    float sum = SHARED_MAX(depth * width * size * unit, 0.0f);
    return UINT(INT(SHARED_MIN(sum / points, 2e9f) + 0.5f));
}
