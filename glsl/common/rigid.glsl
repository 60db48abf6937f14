// SPDX-License-Identifier: MIT
// Rotations as unit quaternions (x, y, z, w).

vec3 rotate(vec4 q, vec3 v)
{
    vec3 t = 2.0 * cross(q.xyz, v);
    return v + q.w * t + cross(q.xyz, t);
}

// The rotation p followed by q.
vec4 product(vec4 q, vec4 p)
{
    return vec4(q.w * p.xyz + p.w * q.xyz + cross(q.xyz, p.xyz), q.w * p.w - dot(q.xyz, p.xyz));
}

// x, rotated by the smallest rotation from the unit vector a to the unit vector b.
vec3 turn_between(vec3 a, vec3 b, vec3 x)
{
    vec3 k = cross(a, b);
    float c = dot(a, b);
    return c * x + cross(k, x) + k * (dot(k, x) / max(1.0 + c, 1e-6));
}
