// SPDX-License-Identifier: MIT
// Position-based rope: particles fly, then sweeps over the links from root to tip move the two
// ends of each link towards the link's length.
//
// BULLET 1: as btSoftBody::PSolve_Links (Bullet 2 and 3), with all sweeps at the end of one step.
// A link with ends a, b of weights w (0 for the root, 1 for others), r = b - a and rest length l:
//     k = (l^2 - r.r) / ((w_a + w_b) (l^2 + r.r)),    a -= w_a k r,  b += w_b k r
// To first order in the stretch this is the usual projection, without a square root; at large
// stretch it overshoots.
//
// BULLET 0: XPBD in small steps (Macklin, Mueller, Chentanez: XPBD, MIG 2016; Macklin et al.:
// Small Steps in Physics Simulation, SCA 2019). Each sweep ends a small step of its own, so the
// multiplier starts at 0. With the compliance alpha and the small step h,
//     lambda = (l - |r|) / (w_a + w_b + alpha/h^2),   a -= w_a lambda r/|r|,  b += w_b lambda r/|r|
//
// Then v = (1 - damping) m/h, where m is the particle's whole displacement in the small step, by
// flight and sweeps. m is not computed as x - q, with the position q before the flight: that
// difference has the rounding error of x in each small step, while gravity contributes only g h^2.
// So each move is added to m. (With 12,000 small steps a second and drag 1/s, the difference was
// off by 0.015 of the length after 2 s; the sum is off by 4e-6.)
//
// For the same reason the sweeps work on links, r = x_b - x_a, and not on positions: what moves an
// end is added to its links.
//
// STYLED 1: after each flight particles are pulled towards the style (style_spring.h). A rope
// stretches; stretch.glsl says how it is drawn.
#include "sim/particles.glsl"
#include "sim/rope_params.h"
#include "sim/stretch.glsl"

vec3 mended(vec3 r, float l, float weights)
{
#if BULLET
    float rr = dot(r, r), ll = l * l;
    return r * ((ll - rr) / (weights * (ll + rr)));
#else
    float inverse = inversesqrt(max(dot(r, r), 1e-36));
    return r * ((l * inverse - 1.0) / (weights + rope_params.softness));
#endif
}

// In all small steps but the first, particle j moves by carried_share(j) m + fall_of(j) (Verlet
// with drag); the first starts from a velocity. If parameters differ along the strand (VARIES),
// these functions also give the decay and gain of the first small step, and both pulls towards the
// style.
float carried_share(int j)
{
#if VARIES
    return rope_params.kept * forces_along(j).x;
#else
    return rope_params.kept * step_params.decay;
#endif
}

vec3 fall_of(int j, vec3 wind) { return step_params.dt * kick_at(j, vec3(0.0), wind); }

vec3 first_flight(int j, vec3 v, vec3 wind)
{
#if VARIES
    vec4 own = own_along(j), forces = forces_along(j);
    return step_params.dt * (v * own.x + (forces.w * frame_gravity + forces.z * wind) * own.y);
#else
    return step_params.dt * (v * rope_params.first_decay +
                             (frame_gravity + step_params.drag * wind) * rope_params.first_gain);
#endif
}

float pull_at(int j, bool first)
{
#if VARIES
    vec4 own = own_along(j);
    return first ? own.z : own.w;
#else
    return first ? rope_params.first_spring.pull : rope_params.spring.pull;
#endif
}

void finish(int a, Root root, vec3 r, float l, vec3 moved, inout vec3 drawn, inout vec3 along)
{
    draw_link(a, root, r, l, moved * (rope_params.kept / step_params.dt),
              rope_params.stretch_drawn != 0u, drawn, along);
}

#if IN_REGISTERS
const int LAST = VERTICES - 1; // turns of the loops, entries of arrays: see keep.glsl

void main()
{
    int s = first_strand();
    if (s >= int(step_params.strand_count)) return;
    int base = strand_base(s);
    open_frame(s);
    vec4 rest_root = strand_root(base), rotation = frame_rotation;
    Root root = relative_root(frame_root(rest_root.xyz), rest_root.w),
         root_old = relative_root(position_before(base).xyz, rest_root.w);
    // r: link, m: displacement of the particle at its end
    vec3 r[LAST], m[LAST], wind = strand_wind(rest_root.xyz, root.at);
    float l[LAST];
    int small_steps = rope_params.small_steps, sweeps = rope_params.sweeps;
    vec3 drawn = vec3(0.0), carry = frame_move(rest_root.xyz) / float(small_steps);
#if STYLED
    vec3 style[VERTICES], at = vec3(0.0); // relative to the root
    style[0] = vec3(0.0);
#endif
    for (int k = 0; k < LAST; ++k) {
        int j = k + 1, a = base + j * STRAND_TILE;
        vec3 next = relative_fetch(position_before(a), root_old);
        vec4 v = velocity_before(a);
        vec4 segment = texelFetch(rest, a);
        l[k] = segment.w;
        r[k] = link_before(drawn, next, l[k], v.w);
        drawn = next;
        m[k] = first_flight(j, v.xyz, wind);
#if STYLED
        at += r[k];
        style[j] = next_style(style[j - 1], segment, rotation);
        m[k] += pull_at(j, true) * (style[j] - (at + (m[k] - carry)));
#endif
    }

#if BULLET
    vec3 moved_before = carry;
    for (int k = 0; k < LAST; ++k) r[k] += m[k] - moved_before, moved_before = m[k];
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        vec3 push = vec3(0.0);
        for (int k = 0; k < LAST; ++k) {
            vec3 link = r[k] - push;
            float weights = k == 0 ? 1.0 : 2.0;
            push = mended(link, l[k], weights);
            if (k > 0) r[k - 1] -= push, m[k - 1] -= push;
            r[k] = link + weights * push, m[k] += push;
        }
    }
#else
    // The displacement in the first small step is known. A particle flies just before its first
    // link is corrected.
    for (int step = 0; step < small_steps; ++step) {
        vec3 gone = carry;
#if STYLED
        at = vec3(0.0);
#endif
        for (int k = 0; k < LAST; ++k) {
            int j = k + 1;
            float weights = k == 0 ? 1.0 : 2.0;
            vec3 move = step > 0 ? carried_share(j) * m[k] + fall_of(j, wind) : m[k];
#if STYLED
            at += r[k];
            move += (step > 0 ? pull_at(j, false) : 0.0) * (style[j] - (at + (move - carry)));
#endif
            vec3 link = r[k] + (move - gone), push = mended(link, l[k], weights);
            if (k > 0) r[k - 1] -= push, m[k - 1] = gone - push;
            r[k] = link + weights * push, gone = move + push;
        }
        m[LAST - 1] = gone;
    }
#endif

    drawn = vec3(0.0);
    vec3 along = rotate(rotation, texelFetch(rest, base + STRAND_TILE).xyz);
    carry_lead(base);
    positions[base] = vec4(root.at, 0.0);
    for (int k = 0; k < LAST; ++k)
        finish(base + (k + 1) * STRAND_TILE, root, r[k], l[k], m[k], drawn, along);
}
#else
// Strands of any length: each dispatch (phase) is one sweep along the strand in scratch memory. A
// particle flies just before its first link is corrected in a small step; after the very last sweep
// it is drawn.
layout(std430, binding = BIND_SCRATCH) buffer Scratch { vec4 scratch[]; }; // a particle: r; m

void main()
{
    int s = first_strand(), n = int(step_params.vertex_count);
    if (s >= int(step_params.strand_count)) return;
    int phase = int(step_params.phase), step = phase / rope_params.sweeps, a = strand_base(s);
    bool loads = phase == 0, flies = phase == step * rope_params.sweeps,
         draws = phase + 1 == rope_params.small_steps * rope_params.sweeps;
    open_frame(s);
    vec4 rest_root = strand_root(a), rotation = frame_rotation;
    Root root = relative_root(frame_root(rest_root.xyz), rest_root.w),
         root_old = relative_root(position_before(a).xyz, rest_root.w);
    vec3 wind = strand_wind(rest_root.xyz, root.at),
         carry = frame_move(rest_root.xyz) / float(rope_params.small_steps);
    vec3 drawn_before = vec3(0.0), at = vec3(0.0), style_at = vec3(0.0), r = vec3(0.0), m = carry,
         push = vec3(0.0);
    vec3 drawn = vec3(0.0), along = rotate(rotation, texelFetch(rest, a + STRAND_TILE).xyz);
    float weights = 1.0, l = 0.0, l_before = 0.0;
    if (draws) {
        carry_lead(a);
        positions[a] = vec4(root.at, 0.0);
    }
    // Link j is corrected while link j - 1 is in `r`, and the displacement of its end in `m`; then
    // both of these are finished.
    for (int j = 1; j < n; ++j, a += STRAND_TILE) {
        int b = a + STRAND_TILE;
        vec3 next, next_m;
        vec4 segment = texelFetch(rest, b);
        l = segment.w;
        if (loads) {
            vec3 to = relative_fetch(position_before(b), root_old);
            vec4 v = velocity_before(b);
            next = link_before(drawn_before, to, l, v.w);
            drawn_before = to;
            next_m = first_flight(j, v.xyz, wind);
        } else {
            next = scratch[2 * b].xyz;
            next_m = scratch[2 * b + 1].xyz;
            if (flies) next_m = carried_share(j) * next_m + fall_of(j, wind);
        }
#if STYLED
        style_at = next_style(style_at, segment, rotation);
        at += next;
        if (flies) next_m += pull_at(j, loads) * (style_at - (at + (next_m - carry)));
#endif
        next += flies ? next_m - m : -push;
        push = mended(next, l, weights);
        if (j > 1) {
            r -= push, m -= push;
            if (draws) {
                finish(a, root, r, l_before, m, drawn, along);
            } else {
                scratch[2 * a] = vec4(r, 0.0);
                scratch[2 * a + 1] = vec4(m, 0.0);
            }
        }
        r = next + weights * push;
        m = next_m + push;
        l_before = l;
        weights = 2.0;
    }
    if (draws) {
        finish(a, root, r, l, m, drawn, along);
    } else {
        scratch[2 * a] = vec4(r, 0.0);
        scratch[2 * a + 1] = vec4(m, 0.0);
    }
}
#endif
