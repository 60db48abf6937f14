// SPDX-License-Identifier: MIT
// Strands on the screen, for all shaders that draw them: the places of particles, their widths, and
// the test whether a particle can be left out (needs draw.h).
#include "kernel/ribbon.h"

// A local copy, because each use of a uniform costs a load.
mat4 clip_from_world = draw_params.clip_from_world;
vec2 size = vec2(draw_params.width, draw_params.height); // of the picture, px
float near_distance = draw_params.near_distance, focal = draw_params.focal;

// Moves a point in front of the near plane (clip space) to that plane, towards the neighbour that
// is behind it.
vec4 clip_near(vec4 x, vec4 before, vec4 after)
{
    vec4 other = after.w >= near_distance ? after : before;
    float share = (near_distance - x.w) / max(other.w - x.w, 1e-20);
    return x.w >= near_distance || other.w < near_distance ? x : mix(x, other, share);
}

RibbonPoint project(vec4 clip, float radius)
{
    return ribbon_project(clip.x, clip.y, clip.w, radius, size.x, size.y, near_distance, focal);
}

vec3 unit(vec3 v)
{
    float square = dot(v, v);
    return square > 0.0 ? v * inversesqrt(max(square, 1e-36)) : vec3(0.0, 1.0, 0.0);
}

// A particle on the screen.
struct Particle {
    RibbonPoint at;
    vec3 color;
};

vec2 way_from(Particle a, Particle b) { return vec2(b.at.x - a.at.x, b.at.y - a.at.y); }

// The unit direction from a to b on the screen; 0 if they coincide.
vec2 direction(Particle a, Particle b)
{
    vec2 way = way_from(a, b);
    float square = dot(way, way);
    return square > 1e-12 && a.at.inverse_w > 0.0 && b.at.inverse_w > 0.0
               ? way * inversesqrt(square)
               : vec2(0.0);
}

// Like ribbon_bend, with an additional limit for the error of colours, below what is visible.
float bend(Particle a, Particle p, Particle b)
{
    vec3 off = abs(p.color - mix(a.color, b.color, ribbon_share(a.at, p.at, b.at))) /
               (0.02 * p.color + 0.002);
    return max(ribbon_bend(a.at, p.at, b.at), max(max(off.r, off.g), off.b));
}

// `normal`: a vector of any length across the ribbon.
float outline_half_width(Particle p, vec2 normal)
{
    return p.at.half_width * ribbon_widening(normal.y, -normal.x, p.at.x - draw_params.axis.x,
                                             p.at.y - draw_params.axis.y, focal);
}
