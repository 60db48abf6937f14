// SPDX-License-Identifier: MIT
// The vector from the eye through a point of the picture (px), to the plane one metre in front of
// the eye (needs draw.h).
//
// At the eye, clip x, y and w are 0. So a point at the offset q from the eye has clip x, y, w = (a
// q, b q, c q), with the rows a, b, c of the matrix. For w = 1 they are x, y and 1; Cramer's rule
// solves for q.
vec3 ray_through(vec2 px)
{
    mat4 rows = transpose(draw_params.clip_from_world);
    vec3 a = rows[0].xyz, b = rows[1].xyz, c = rows[3].xyz, bc = cross(b, c);
    vec2 clip = 2.0 * px / vec2(draw_params.width, draw_params.height) - 1.0;
    return (clip.x * bc + clip.y * cross(c, a) + cross(a, b)) / dot(a, bc);
}
