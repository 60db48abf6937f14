// SPDX-License-Identifier: MIT
// Points of strands, between particles and screen (needs material.h, hair_address.glsl).
//   SMOOTH 0: straight from particle to particle
//   SMOOTH 1: smooth curves with material.smooth_parts parts for each segment: Catmull-Rom with
//       centripetal knots (through all particles) or the uniform cubic B-spline
//
// The B-spline, too, begins and ends at the strand's ends (kernel/curve.h).
#include "kernel/curve.h"

layout(binding = BIND_POSITION) uniform samplerBuffer position;

struct Curve {
    int root, segments, parts;
};

Curve curve_open(int root, int n)
{
#if SMOOTH
    return Curve(root, n - 1, int(material.smooth_parts));
#else
    return Curve(root, n - 1, 1);
#endif
}

vec3 particle(Curve c, int j) { return texelFetch(position, c.root + j * STRAND_TILE).xyz; }

#if SMOOTH
// A segment's ends b and d, and their neighbours a and e.
struct Around {
    vec3 a, b, d, e;
};

Around curve_around(Curve c, int j)
{
    vec3 b = particle(c, j), d = particle(c, j + 1);
    vec3 a = j > 0 ? particle(c, j - 1) : 2.0 * b - d,
         e = j + 2 <= c.segments ? particle(c, j + 2) : 2.0 * d - b;
    return Around(a, b, d, e);
}

float curve_knot_of(vec3 way) { return curve_knot(way.x, way.y, way.z); }

CurveKnots curve_knots_of(Around o)
{
    return curve_knots(curve_knot_of(o.b - o.a), curve_knot_of(o.d - o.b),
                       curve_knot_of(o.e - o.d));
}

vec3 curve_sum(Around o, CurveWeights w)
{
    return w.before * (o.b - o.a) + w.own * (o.d - o.b) + w.after * (o.e - o.d);
}

// Four points whose convex hull contains all of segment j of the curve: those of the B-spline, or
// of a Bezier curve.
vec3[4] curve_hull(Curve c, int j)
{
    Around o = curve_around(c, j);
    CurveKnots knots = curve_knots_of(o);
    vec3 from = curve_sum(o, curve_tangent_from(knots)), to = curve_sum(o, curve_tangent_to(knots));
    bool spline = material.smooth_curve != 0u;
    return vec3[4](spline ? o.a : o.b, spline ? o.b : o.b + from / 3.0,
                   spline ? o.d : o.d - to / 3.0, spline ? o.e : o.d);
}
#endif

// Point k = 0 .. segments * parts.
vec3 curve_point(Curve c, int k)
{
    k = min(k, c.segments * c.parts);
#if SMOOTH
    int j = min(k / c.parts, c.segments - 1);
    float t = float(k - j * c.parts) / float(c.parts);
    Around o = curve_around(c, j);
    if (material.smooth_curve != 0u) return o.b + curve_sum(o, curve_spline(t));
    return o.b + curve_sum(o, curve_hermite(curve_knots_of(o), t));
#else
    return particle(c, k);
#endif
}

// The place of point k, counted in particles.
float curve_place(Curve c, int k) { return float(k) / float(c.parts); }
