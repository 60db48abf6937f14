// SPDX-License-Identifier: MIT
// The tractrix: the curve of the tail of a rigid segment while its head moves straight.
//
// Head h, tail t, length L, d = (t - h)/L. The head moves by S, s = |S|, e = S/s. The tail's
// velocity is along the segment, so d obeys d d/ds = (d (d.e) - e)/L. On the sphere of directions
// this is a flow from the pole e to the pole -e. In stereographic coordinates it scales tan(half
// the angle to -e) by E = e^{-s/L}, which is a Lorentz boost of (1, d) of rapidity s/L. Solved for
// d':
//
//     d' = ((E^2 (1+a) - (1-a)) e + 2E (d - a e)) / ((1-a) + E^2 (1+a)),     a = d.e
//
// The code uses a form without cancellation. With M = |d - e|^2 = 2 (1 - a) the denominator is D/2,
// D = M + E^2 (4 - M), and
//
//     d' - d = f/D (A d - B e),     f = 1 - E,  A = 4E - M (1+E),  B = A + 2M.
//
// The tail moves by S + L (d' - d), never farther than the head.

// log2(e). With exponents below -60, D would underflow if the head pushes exactly along the segment
// (M = 0).
const float TRACTRIX_LOG2_E = 1.44269504;
const float TRACTRIX_MAX_EXPONENT = 60.0;

// Turns the unit direction d (head to tail) of a segment of length L > 0 whose head moves by
// `move`. Returns the new direction; `move` becomes the tail's displacement. Components of `move`
// up to 1e18 are safe; a move below 1e-18 only translates the segment. If not `turns`, both stay: a
// loop over registers visits segments that a pull does not reach.
vec3 tractrix_turn(vec3 d, float L, inout vec3 move, bool turns)
{
    float ss = max(dot(move, move), 1e-36);
    float inverse = inversesqrt(ss);
    vec3 e = move * inverse;
    float E = exp2(-min(ss * inverse * (TRACTRIX_LOG2_E / L), TRACTRIX_MAX_EXPONENT));
    float f = 1.0 - E;
    vec3 m = d - e;
    float M = dot(m, m);
    float A = 4.0 * E - M * (1.0 + E);
    float B = A + 2.0 * M;
    float D = M + E * E * (4.0 - M);
    vec3 change = (turns ? f / D : 0.0) * (A * d - B * e);
    move += L * change;
    return d + change;
}

vec3 tractrix_turn(vec3 d, float L, inout vec3 move) { return tractrix_turn(d, L, move, true); }

// Normalises a direction that is off only by rounding, with one Newton step. (If the head has
// pushed almost exactly along the segment so far that it flipped, the result's direction and length
// depend on rounding.)
vec3 tractrix_renormalise(vec3 d)
{
    float dd = dot(d, d);
    return d * (abs(dd - 1.0) < 1e-3 ? 1.5 - 0.5 * dd : inversesqrt(dd));
}

// The unit vector along v, and its length, at any scale: divides by the largest component before
// squaring.
vec3 tractrix_direction(vec3 v, out float len)
{
    vec3 a = abs(v);
    float largest = max(a.x, max(a.y, a.z));
    vec3 u = largest > 0.0 ? v / largest : vec3(0.0);
    float norm = sqrt(dot(u, u));
    len = norm * largest;
    return largest > 0.0 ? u / norm : u;
}

// The tail's new position when the head of the segment (h, t) moves to p. If the head does not
// move, the tail stays; a segment without length moves to p.
vec3 tractrix_step(vec3 h, vec3 t, vec3 p)
{
    float L, s;
    vec3 d = tractrix_direction(t - h, L);
    vec3 e = tractrix_direction(p - h, s);
    vec3 unit_move = e * (s / L); // in segment lengths, so that no scale overflows
    if (L == 0.0) return p;
    vec3 turned = tractrix_renormalise(tractrix_turn(d, 1.0, unit_move));
    return s == 0.0 ? t : p + L * turned;
}
