// SPDX-License-Identifier: MIT
// The way from the eye through a point of the picture (px), as long as it is to one metre before
// the eye's plane (needs draw.h).
//
// The eye is where clip x, y and w are 0, so a point q off it has (a q, b q, c q) for them with the
// rows a, b, c of the matrix. For w = 1 these are x, y and 1; Cramer's rule gives q.
vec3 ray_through(vec2 px)
{
    mat4 rows = transpose(draw_params.clip_from_world);
    vec3 a = rows[0].xyz, b = rows[1].xyz, c = rows[3].xyz, bc = cross(b, c);
    vec2 clip = 2.0 * px / vec2(draw_params.width, draw_params.height) - 1.0;
    return (clip.x * bc + clip.y * cross(c, a) + cross(a, b)) / dot(a, bc);
}
