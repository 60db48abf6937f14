// SPDX-License-Identifier: MIT
// Strands on the screen, before they are drawn in whatever way: where their particles lie, how wide
// they are, and which of them may be left out (needs draw.h).

const float PAD = 0.71;          // px; the corner of a pixel is sqrt(1/2) from its middle
const float LEAST_COSINE = 0.25; // of the joints' 1 + n0.n1
const float MITRE_MAX = 2.9;     // bound of |m|: sqrt(2 x) / max(x, LEAST_COSINE) over all x

// Read once: a uniform costs a load wherever it is named.
mat4 clip_from_world = draw_params.clip_from_world;
vec2 size = vec2(draw_params.width, draw_params.height); // of the picture, px
float near_distance = draw_params.near_distance, focal = draw_params.focal;

// Where the strand is drawn instead, all in clip space, when `x` lies behind the near plane: on
// that plane, towards the neighbour that is in sight.
vec4 clip_near(vec4 x, vec4 before, vec4 after)
{
    vec4 other = after.w >= near_distance ? after : before;
    float share = (near_distance - x.w) / max(other.w - x.w, 1e-20);
    return x.w >= near_distance || other.w < near_distance ? x : mix(x, other, share);
}

// x, y (px), 1/w (0: not in sight), half-width (px).
vec4 project(vec4 clip, float radius)
{
    float inverse = 1.0 / max(clip.w, 1e-20);
    vec2 px = (0.5 * clamp(clip.xy * inverse, -1e4, 1e4) + 0.5) * size;
    return vec4(px, clip.w >= 0.999 * near_distance ? inverse : 0.0, focal * radius * inverse);
}

vec3 unit(vec3 v)
{
    float square = dot(v, v);
    return square > 0.0 ? v * inversesqrt(max(square, 1e-36)) : vec3(0.0, 1.0, 0.0);
}

// A particle on the screen.
struct Particle {
    vec4 at; // x, y (px), 1/w (0: not in sight), half-width (px)
    vec3 color;
};

// Unit direction from a to b on the screen, 0 where there is none.
vec2 direction(Particle a, Particle b)
{
    vec2 way = b.at.xy - a.at.xy;
    float square = dot(way, way);
    return square > 1e-12 && a.at.z > 0.0 && b.at.z > 0.0 ? way * inversesqrt(square) : vec2(0.0);
}

// How far `p` is from what stands in its place if the ribbon runs straight from a to b: 1 is as
// much as may be. Positions within STRAIGHT px, depth and half-width by share, colours so that it
// cannot be seen.
const float STRAIGHT = 0.05;

float bend(Particle a, Particle p, Particle b)
{
    vec2 chord = b.at.xy - a.at.xy, arm = p.at.xy - a.at.xy;
    float t = clamp(dot(arm, chord) / max(dot(chord, chord), 1e-12), 0.0, 1.0);
    vec4 off = abs(p.at - mix(a.at, b.at, t)) /
               vec4(STRAIGHT, STRAIGHT, 0.001 * p.at.z + 1e-20, 0.05 * p.at.w);
    vec3 shift = abs(p.color - mix(a.color, b.color, t)) / (0.02 * p.color + 0.002);
    return max(max(max(off.x, off.y), max(off.z, off.w)), max(max(shift.r, shift.g), shift.b));
}

// A cylinder's outline seen off the optical axis is wider: where its tangent planes through the eye
// cut the screen at the distance q from the axis, by sqrt(1 + (q/focal)^2). `normal` of any length
// lies across the ribbon.
float outline_half_width(Particle p, vec2 normal)
{
    float q = dot(normal, p.at.xy - draw_params.axis.xy) *
              inversesqrt(max(dot(normal, normal), 1e-12)) / focal;
    return p.at.w * sqrt(1.0 + q * q);
}
