// SPDX-License-Identifier: MIT
// The point of a triangle that is closest to another point.

vec3 closest_on_edge(vec3 p, vec3 a, vec3 b)
{
    vec3 e = b - a;
    return a + clamp(dot(p - a, e) / max(dot(e, e), 1e-30), 0.0, 1.0) * e;
}

vec3 closer(vec3 p, vec3 a, vec3 b)
{
    vec3 to_a = a - p, to_b = b - p;
    return dot(to_a, to_a) <= dot(to_b, to_b) ? a : b;
}

// The foot of the perpendicular if it is inside the triangle, otherwise a point on an edge.
// cross(edge, normal) points outwards.
vec3 closest_on_triangle(vec3 p, vec3 a, vec3 b, vec3 c)
{
    vec3 n = cross(b - a, c - a);
    float nn = dot(n, n);
    bool over = dot(cross(b - a, n), p - a) <= 0.0 && dot(cross(c - b, n), p - b) <= 0.0 &&
                dot(cross(a - c, n), p - c) <= 0.0;
    vec3 edge = closer(p, closest_on_edge(p, a, b),
                       closer(p, closest_on_edge(p, b, c), closest_on_edge(p, c, a)));
    return over && nn > 0.0 ? p - n * (dot(n, p - a) / nn) : edge;
}
