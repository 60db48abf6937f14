// SPDX-License-Identifier: MIT
// A step of `rod`: rigid segments that bend and twist, with material parameters; second order in
// dt.
//
// In the frame that moves with the root, u = x+ - x is a particle's displacement in the step, v its
// velocity at the step's start. The implicit midpoint rule in energy-momentum form (Simo, Tarnow,
// Wong: Exact energy-momentum conserving algorithms, CMAME 1992) is
//     m (2 u/dt^2 - 2 v/dt) = forces(u) - J(middle)^T lambda,   |segments of x+| = l,
//     v+ = 2 u/dt - v
// Tensions act along the segments' middle directions e = (e_old + e_new)/2, so they do no work and
// none is too stiff: (e_new - e_old).e = 0.
// - Gravity, wind and drag c act so that a free particle moves exactly: with the gain h f of
//   forces.glsl, m (2 u/gain/dt - (2/gain - c) v - (g + c w)).
// - Bending and twist (rod_joint.glsl) are taken at x + share u, share = 1/2 + eta/dt: that is
//   Kelvin-Voigt damping of time eta.
// - The springs of the style are taken at x+.
//
// A round of Newton's method:
//   1. forward, from root to tip: the solution of the round before; then directions and frames.
//   2. backward, from tip to root: the moment G of the joints, the residual of each particle, its
//      running sum N, tensions lambda_j = -N_j.e_j/|e_j|^2, and the elimination (rod_front.glsl).
//      The matrix is the second derivative of the energy by turns of the frames, t_j = exp(w_j) t_j
//      and a_j = exp(v) a_j with v = w_{j-1} (rest_shape.c derives it): with M = gamma (tau -
//      tau0), c = a.t, h = (a + t)/(1 + c), k = t x a/(1 + c) and f = dE/d(segment), its forms are
//          beta/2 (|w|^2 - (w.a)(w.t) + |v|^2 - (v.a)(v.t)) - beta (c w.v - (w.a)(v.t))
//          gamma/2 (h.(w - v))^2 + M/2 (v.(h x w) - (h.(w - v)) (k.(w - v))) - (w.e)(w.f)/2
//      The exact first two terms have c |w|^2, c |v|^2; with 1 the strands of a fast step are off
//      by half as much. Without the terms in M and f, loaded curls at rest diverge at long steps.
// There are two rounds, and a third for strands that turned far in the second.
//
// The limiter: the step's energy X = E+ - E + sum u.(residual without joints) - work of the clamp's
// turn vanishes for an exact solution; at long steps it may be a gain. The gain that is not paid
// yet, and that exceeds ALLOWED of the energy that gravity could give, is taken from the
// velocities. Without it, hair in free fall blows up at long steps.
//
// JOINTS 0: no bending and no twist. EQUAL 1: particles have equal masses, as in other solvers.
//
// State: twist tau_j in velocities[].w; in the root's, the gain that is not paid.
#include "sim/rod_params.h"
#include "sim/particles.glsl"
#include "sim/strand.glsl"
#include "sim/rod_front.glsl"
#include "sim/rod_keep.glsl"
#include "sim/rod_joint.glsl"

const float FAR_TURN = 0.3;    // rad; a round turns no segment by more
const float THIRD_ROUND = 0.1; // rad; a strand that turned farther in the second round has a third
const float ALLOWED = 0.005;
const float NOISE = 1e-6; // of a strand's length; rounding errors are 6e-8
// 1/dt times the root's new velocity, less the mean of the step, over that mean less the old one,
// plus 1. 2 is of second order, but a root that starts suddenly then alternates between 0 and twice
// its velocity for ever. 1.95 delays the root's acceleration by 0.013 dt.
const float ROOT_TURNS = 1.95;

// Number of strands that the limiter has slowed down, in all steps.
layout(std430, binding = BIND_TIPS) buffer Slowed { uint slowed; };

// What acts on the particles of a strand, in the root's frame.
struct Drive {
    vec3 clamp_turn;              // rotation vector of the clamp in the step
    vec4 clamp;                   // its rotation when bending is taken
    vec3 root_before, root_after; // velocities of the root, m/s
};

Drive drive_open(Strand strand)
{
    Drive drive;
    drive.root_before = velocity_before(strand.address).xyz;
    drive.root_after = drive.root_before + ROOT_TURNS * (strand.root_velocity - drive.root_before);
    vec4 old = frame_rotation_old, now = strand.rotation;
    if (dot(old, now) < 0.0) old = -old;
    drive.clamp_turn = 2.0 * (old.w * now.xyz - now.w * old.xyz - cross(now.xyz, old.xyz));
    vec4 between = mix(old, now, rod_params.share);
    drive.clamp = between * inversesqrt(dot(between, between));
    return drive;
}

// The velocity relative to the root at the step's start.
vec3 fetch_speed(Strand strand, int j, Drive drive)
{
    return fetch_velocity(strand, j) - drive.root_before;
}

// Mass of particle j over rho A of the root, m. EQUAL 1: all particles have the same mass.
float mass_at(Strand strand, float l, float l_beyond, int j)
{
#if EQUAL
    return strand.total_length / float(LAST);
#elif VARIES
    return 0.5 * (l + l_beyond) * own_along(j).y;
#else
    return 0.5 * (l + l_beyond);
#endif
}

// Acceleration that particle j lacks without joints: inertia, drag, gravity and wind. `stiff`: its
// derivative by u.
vec3 inertia(Strand strand, Drive drive, int j, vec3 u, vec3 v, out float stiff)
{
#if VARIES
    vec4 forces = forces_along(j);
    float gain = forces.y, drag = forces.z;
    vec3 push = forces.w * frame_gravity + drag * strand.wind;
#else
    float gain = step_params.gain, drag = step_params.drag;
    vec3 push = strand.push / step_params.gain;
#endif
    vec3 root_gain = strand.root_velocity - drive.root_before;
    stiff = 2.0 / (strand.dt * gain);
    return stiff * u - (2.0 / gain - drag) * v - push +
           (2.0 / gain - (2.0 - ROOT_TURNS) / strand.dt) * root_gain + drag * drive.root_before;
}

#if BALANCED
layout(binding = BIND_HELD) uniform samplerBuffer held;
// The part of the groom's weight that its joints do not carry; turns with the head.
vec3 held_force(Strand strand, int j)
{
    return rotate(strand.rotation, texelFetch(held, strand.address + j * STRAND_TILE).xyz);
}
#else
vec3 held_force(Strand strand, int j) { return vec3(0.0); }
#endif

float style_stiffness(int j)
{
#if VARIES
    return own_along(j).x;
#else
    return rod_params.spring.stiffness;
#endif
}

// The residual of particle j without joints. `place`: relative to the root, after the step.
vec3 residual(Strand strand, Drive drive, int j, float mass, vec3 u, vec3 v, vec3 place, vec3 style,
              out float stiff)
{
    vec3 a = inertia(strand, drive, j, u, v, stiff);
#if STYLED
    float k = style_stiffness(j);
    a += k * (place - style);
    stiff += k;
#endif
    stiff *= mass;
    return mass * a - held_force(strand, j);
}

vec3 style_of_tip(Strand strand)
{
    vec3 style = vec3(0.0);
#if STYLED
    for (int k = 0; k < LAST; ++k)
        style = next_style(style, fetch_rest(strand, k + 1), strand.rotation);
#endif
    return style;
}

// The segment's change in the step, such that r + d keeps the length l. What rounding made of the
// length of r is no change.
vec3 exact_length(vec3 r, vec3 d, float l)
{
    vec3 e = r + d;
    return relative_turn(r, d, l, length(e), 0.0, direction(e));
}

// From root to tip. SOLVED: applies the solution of the round before; otherwise predicts that
// relative velocities stay. Then finds the unloaded directions. Returns the largest turn's square.
float forward(Strand strand, Drive drive, bool solved)
{
    vec3 q_before = vec3(0.0), v_before = vec3(0.0), u = vec3(0.0), u_old = vec3(0.0),
         dx = vec3(0.0), w_before = vec3(0.0);
    vec4 frame = drive.clamp;
    float most = 0.0;
    int last = LAST;
    for (int k = 0; k < last; ++k) {
        int j = k + 1;
        vec3 q = fetch_position(strand, j), r = q - q_before, d;
        float l = fetch_rest(strand, j).w, tau;
        if (solved) {
            vec4 old = recall_move(j);
            Turn turn = recall_turn(j);
            vec3 d_old = old.xyz - u_old, e = r + 0.5 * d_old, w = turn.v - turn.U * dx;
            tau = old.w;
#if JOINTS
            w -= turn.W * w_before;
#endif
            vec3 z = cross(w, e);
            float turned = dot(z, z) / (l * l);
            float cut = turned > FAR_TURN * FAR_TURN ? FAR_TURN * inversesqrt(turned) : 1.0;
            if (!(turned < 1e30)) w = z = vec3(0.0); // too much for float32
            w *= cut;
            most = max(most, turned);
            d = exact_length(r, d_old + cut * z, l);
            dx += cut * z;
#if JOINTS
            vec3 axis = twist_axis(recall_goal(j), direction(r + rod_params.share * d_old));
            tau += rod_params.share * dot(axis, w - w_before);
#endif
            u_old = old.xyz, w_before = w;
        } else {
            vec3 v = fetch_speed(strand, j, drive);
            d = exact_length(r, strand.dt * (v - v_before), l);
            tau = velocity_before(strand.address + j * STRAND_TILE).w;
            v_before = v;
        }
        u += d;
        keep_move(j, vec4(u, tau));
#if JOINTS
        vec3 a = rotate(frame, fetch_natural(strand, j).xyz);
        keep_goal(j, a);
        frame = frame_beyond(frame, a, direction(r + rod_params.share * d), tau);
#endif
        q_before = q;
    }
    return most;
}

mat3 symmetric(vec3 a, vec3 b) { return outerProduct(a, b) + outerProduct(b, a); }

// The linear map v -> h x v.
mat3 across(vec3 h) { return mat3(0.0, h.z, -h.y, -h.z, 0.0, h.x, h.y, -h.x, 0.0); }

// From tip to root. Returns the moment at the clamp.
vec3 backward(Strand strand, Drive drive)
{
    Front front = front_open();
    Moment moment = NO_MOMENT;
    vec3 N = vec3(0.0), by_beyond = vec3(0.0), q = fetch_position(strand, LAST),
         style = style_of_tip(strand);
    float l_beyond = 0.0, share = rod_params.share;
    vec4 move = recall_move(LAST), rest_here = fetch_rest(strand, LAST);
    for (int j = LAST; j >= 1; --j) {
        vec3 q_before = j > 1 ? fetch_position(strand, j - 1) : vec3(0.0);
        vec4 move_before = j > 1 ? recall_move(j - 1) : vec4(0.0),
             rest_before = fetch_rest(strand, j - 1);
        float l = rest_here.w, stiff, mass = mass_at(strand, l, l_beyond, j);
        vec3 r = q - q_before, d = move.xyz - move_before.xyz, e = r + 0.5 * d;
        vec3 R = residual(strand, drive, j, mass, move.xyz, fetch_speed(strand, j, drive),
                          q + move.xyz, style, stiff);
#if JOINTS
        float beta = joint_stiffness(strand, j, l);
        vec3 a = recall_goal(j), t = direction(r + share * d), beyond = moment.G,
             by = joint_gradient(beta, l, a, t, moment);
        R += by - by_beyond;
        by_beyond = by;
#endif
        N += R;
        front.A += diagonal(stiff);
        front.p -= R;

        // The share of `stiff` keeps the twist of strands of almost no stiffness regular.
        float ee = max(dot(e, e), 1e-30), tension = 0.5 * max(-dot(N, e) / ee, 0.0);
        front.E += diagonal(tension * ee) + (1e-4 * stiff - tension) * outerProduct(e, e);
        float kb = 0.0;
        mat3 G = ZERO3, E_before = ZERO3;
#if JOINTS
        kb = share * beta;
        float c = dot(a, t);
        mat3 bent = 0.5 * kb * symmetric(a, t);
        front.E += diagonal(kb) - bent - 0.5 * share * symmetric(e, by);
        G = kb * (outerProduct(a, t) - diagonal(c)), E_before = diagonal(kb) - bent;
        vec3 h = twist_axis(a, t), k = cross(t, a) / max(1.0 + c, 0.1);
        float gamma = beta * rod_params.twist, M = gamma * (move.w - fetch_natural(strand, j).w),
              off = M + dot(beyond, t);
        mat3 twist = share * (gamma * outerProduct(h, h) - 0.5 * M * symmetric(h, k));
        front.E += twist;
        front.s -= off * h;
        G -= twist + 0.5 * share * M * across(h);
        E_before += twist;
#endif
        keep_turn(j, front_eliminate(front, e, G, E_before, 2.0 * kb + stiff * ee));
#if JOINTS
        front.s += off * h;
#endif
#if STYLED
        style -= next_style(vec3(0.0), rest_here, strand.rotation);
#endif
        q = q_before, move = move_before, l_beyond = l, rest_here = rest_before;
    }
    return moment.G;
}

// The energy that a strand could gain by falling, and that of rounding errors, per rho A.
float allowed_gain(Strand strand)
{
    float speed = NOISE * strand.total_length / strand.dt;
    return strand.total_length *
           (ALLOWED * 0.5 * strand.total_length * length(strand.push) / step_params.gain +
            0.5 * speed * speed);
}

// E at the step's start. It is not stored by the step before: collisions have moved the strand
// since.
float stored_energy(Strand strand)
{
    float energy = 0.0;
#if JOINTS
    vec3 q_before = vec3(0.0);
    vec4 frame = frame_rotation_old;
    int last = LAST;
    for (int j = 1; j <= last; ++j) {
        vec3 q = fetch_position(strand, j), t = direction(q - q_before);
        vec4 s = fetch_natural(strand, j);
        float tau = velocity_before(strand.address + j * STRAND_TILE).w;
        vec3 a = rotate(frame, s.xyz);
        energy +=
            joint_energy(joint_stiffness(strand, j, fetch_rest(strand, j).w), a, t, tau - s.w);
        frame = frame_beyond(frame, a, t, tau);
        q_before = q;
    }
#endif
    return energy;
}

// From root to tip: writes positions and velocities and accounts for the energy.
void finish(Strand strand, Drive drive, vec3 clamp_moment, float energy_before)
{
    int last = LAST;
    float energy = 0.0, worked = -dot(clamp_moment, drive.clamp_turn), kinetic = 0.0,
          owed = velocity_before(strand.address).w;
    vec3 q_before = vec3(0.0), u_before = vec3(0.0), style = vec3(0.0), x = vec3(0.0);
    vec4 frame = strand.rotation;
    for (int k = 0; k < last; ++k) {
        int j = k + 1, at = strand.address + j * STRAND_TILE;
        vec4 rest_here = fetch_rest(strand, j), move = recall_move(j);
        float l = rest_here.w, l_beyond = j < last ? fetch_rest(strand, j + 1).w : 0.0, stiff,
              mass = mass_at(strand, l, l_beyond, j);
        vec3 q = fetch_position(strand, j), v = fetch_speed(strand, j, drive), u = move.xyz,
             t = direction(q - q_before + (u - u_before));
        x += l * t;
#if STYLED
        style = next_style(style, rest_here, strand.rotation);
#endif
        worked += dot(u, residual(strand, drive, j, mass, u, v, q + u, style, stiff));
#if JOINTS
        vec4 s = fetch_natural(strand, j);
        vec3 a = rotate(frame, s.xyz);
        energy += joint_energy(joint_stiffness(strand, j, l), a, t, move.w - s.w);
        frame = frame_beyond(frame, a, t, move.w);
#endif
        vec3 v_now = 2.0 / strand.dt * u - v;
        kinetic += 0.5 * mass * dot(v_now, v_now);
        velocities[at] = vec4(drive.root_after + v_now, move.w);
        store_position(strand, at, x);
        q_before = q, u_before = u;
    }
    float gained = owed + energy - energy_before + worked;
    float over = gained - allowed_gain(strand);
    if (over > 0.0 && over < 1e30) {
        atomicAdd(slowed, 1u);
        float paid = min(over, kinetic), kept = sqrt(max(1.0 - paid / max(kinetic, 1e-30), 0.0));
        for (int j = 1; j <= last; ++j) {
            int at = strand.address + j * STRAND_TILE;
            vec4 v = velocities[at];
            velocities[at] = vec4(mix(drive.root_after, v.xyz, kept), v.w);
        }
        gained -= paid;
    }
    if (!(gained > 0.0 && gained < 1e30)) gained = 0.0;
    store_root(strand);
    velocities[strand.address] = vec4(drive.root_after, gained);
}

void step_strand(int s)
{
    Strand strand = strand_open(s, rod_params.spring);
    Drive drive = drive_open(strand);
    float energy = stored_energy(strand);
    forward(strand, drive, false);
    vec3 clamp_moment;
    for (int round = 0; round < 3; ++round) {
        clamp_moment = backward(strand, drive);
        float most = forward(strand, drive, true);
        if (round == 1 && !(most > THIRD_ROUND * THIRD_ROUND)) break;
    }
    finish(strand, drive, clamp_moment, energy);
}
#include "sim/each_strand.glsl"
