// SPDX-License-Identifier: MIT
// The exact share of a square pixel that a straight ribbon covers.

// Share of the pixel on the positive side of a line at the signed distance t from its middle. `a`
// >= `b` > 0 are the sides of the pixel as the distance sees them, that is the absolute components
// of its gradient: the pixel's profile across the line is a box of width a spread by a box of width
// b, a trapezoid. `scale` is 1 / (2 a b).
float share_above(float t, float a, float b, float scale)
{
    float x = abs(t);
    float ramp = clamp(0.5 * (a + b) - x, 0.0, b);
    float share = scale * (ramp * ramp + 2.0 * b * max(0.5 * (a - b) - x, 0.0));
    return t < 0.0 ? 1.0 - share : share;
}

// Coverage of the pixel by |across| < half_width, with the gradient of `across` by pixel. That is near
// 1, but where hundreds of particles share a pixel slivers of triangles have any, even infinite.
float ribbon_coverage(float across, float half_width, vec2 gradient)
{
    gradient = min(abs(gradient), 1e6);
    float a = max(max(gradient.x, gradient.y), 1e-3), b = clamp(min(gradient.x, gradient.y), 1e-3 * a, a);
    float scale = 0.5 / (a * b);
    return share_above(across - half_width, a, b, scale) - share_above(across + half_width, a, b, scale);
}

// The same for many pixels at once, with what they share taken out. With A(t) = (m - max(m - (a - b)/2,
// 0)^2 / (2 b)) / a, m = min(t, (a + b)/2), the area of the trapezoid between its middle and t >= 0,
// the coverage at the distance d of |across| < h is A(d + h) - sign(d - h) A(|d - h|).
struct Profile {
    float half_width;
    float inner, outer; // (a - b)/2, (a + b)/2
    float factor;       // 1/a, times what the coverage is wanted times
    float curve;        // 1/(2 b)
};

// `direction`: unit, of the ribbon.
Profile ribbon_profile(vec2 direction, float half_width, float amount)
{
    float a = max(abs(direction.x), abs(direction.y)), b = max(min(abs(direction.x), abs(direction.y)), 1e-3);
    return Profile(half_width, 0.5 * (a - b), 0.5 * (a + b), amount / a, 0.5 / b);
}

float profile_area(Profile p, float t)
{
    float m = min(t, p.outer), u = max(m - p.inner, 0.0);
    return m - p.curve * (u * u);
}

float profile_coverage(Profile p, float across)
{
    float d = abs(across), near = d - p.half_width;
    float before = profile_area(p, abs(near));
    return p.factor * (profile_area(p, d + p.half_width) - (near < 0.0 ? -before : before));
}
