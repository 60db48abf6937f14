// SPDX-License-Identifier: MIT
// The exact share of a square pixel that a straight ribbon covers (src/lanes/composite.c computes
// it for several pixels at once).

// The share of the pixel on the positive side of a line at the signed distance t from its centre.
// `a` >= `b` > 0 are the absolute components of the distance's gradient. The pixel's profile across
// the line is a box of width a convolved with a box of width b, which is a trapezoid. `scale` is 1
// / (2 a b).
float share_above(float t, float a, float b, float scale)
{
    float x = abs(t);
    float ramp = clamp(0.5 * (a + b) - x, 0.0, b);
    float share = scale * (ramp * ramp + 2.0 * b * max(0.5 * (a - b) - x, 0.0));
    return t < 0.0 ? 1.0 - share : share;
}

// The coverage of the pixel by |across| < half_width; `gradient` is the change of `across` per
// pixel. It is near 1, except where hundreds of particles share a pixel: slivers of triangles can
// have any gradient, even an infinite one.
float ribbon_coverage(float across, float half_width, vec2 gradient)
{
    gradient = min(abs(gradient), 1e6);
    float a = max(max(gradient.x, gradient.y), 1e-3),
          b = clamp(min(gradient.x, gradient.y), 1e-3 * a, a);
    float scale = 0.5 / (a * b);
    return share_above(across - half_width, a, b, scale) -
           share_above(across + half_width, a, b, scale);
}
