// SPDX-License-Identifier: MIT
// Strands on the way from their particles to the screen (needs material.h, hair_address.glsl).
//   SMOOTH 0: from particle to particle
//   SMOOTH 1: smooth curves, in material.smooth_parts parts a segment: Catmull-Rom with centripetal
//      knots (through all particles) or the uniform cubic B-spline
//
// Before the root and behind the tip stands the neighbour's mirror image: so the B-spline, too,
// begins and ends at the strand's ends.
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
// A segment's ends b and d, and their neighbours.
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

// The knots' distances are the roots of the particles', and the tangents at b and d those of the
// parabolas through three knots (Barry and Goldman 1988), over the segment's own distance.
void curve_tangents(Around o, out vec3 from, out vec3 to)
{
    float before = max(sqrt(length(o.b - o.a)), 1e-9), own = max(sqrt(length(o.d - o.b)), 1e-9),
          after = max(sqrt(length(o.e - o.d)), 1e-9);
    vec3 way = o.d - o.b;
    from = way + own * ((o.b - o.a) / before - (o.d - o.a) / (before + own));
    to = way + own * ((o.e - o.d) / after - (o.e - o.b) / (own + after));
}

// Four points whose convex hull has all of segment j of the curve: the B-spline's own, or Bezier's.
vec3[4] curve_hull(Curve c, int j)
{
    Around o = curve_around(c, j);
    vec3 from, to;
    curve_tangents(o, from, to);
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
    if (material.smooth_curve != 0u) {
        float s = 1.0 - t;
        return (s * s * s * o.a + (3.0 * t * t * t - 6.0 * t * t + 4.0) * o.b +
                (3.0 * s * s * s - 6.0 * s * s + 4.0) * o.d + t * t * t * o.e) *
               (1.0 / 6.0);
    }
    vec3 way = o.d - o.b, from, to;
    curve_tangents(o, from, to);
    return o.b + t * (from + t * (3.0 * way - 2.0 * from - to + t * (from + to - 2.0 * way)));
#else
    return particle(c, k);
#endif
}

// Where point k lies among the particles.
float curve_place(Curve c, int k) { return float(k) / float(c.parts); }
