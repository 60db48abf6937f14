// SPDX-License-Identifier: MIT
// The state of a strand during a step, for solvers of particles with an implicit style spring
// (needs particles.glsl). Positions are relative to the root, and velocities are computed from
// displacements, not from differences of positions: a short step moves particles by less than the
// positions are rounded by.
// Macros: STYLED: there is a style spring. VARIES: the spring or the forces differ along the
// strand; then `push`, `decay` and `spring` are means.
#include "sim/style_spring.h"

const float SAFE_MOVE = 1e15; // m; keeps squares finite whatever the head does

struct Strand {
    int address;         // of the root
    Root root, root_old; // at the step's end and start
    vec3 moved, root_velocity;
    float total_length; // of the strand
    vec3 push;          // velocity that forces add
#if VARIES
    vec3 wind;
#endif
    vec4 rotation; // of the head
    float dt, decay;
    StyleSpring spring;
};

Strand strand_open(int number, StyleSpring spring)
{
    Strand strand;
    strand.address = strand_base(number);
    open_frame(number);
    vec4 root_rest = strand_root(strand.address);
    strand.root = relative_root(frame_root(root_rest.xyz), root_rest.w);
    strand.root_old = relative_root(position_before(strand.address).xyz, root_rest.w);
    strand.moved = frame_move(root_rest.xyz);
    strand.root_velocity = strand.moved / step_params.dt;
    strand.total_length = root_rest.w;
    vec3 wind = strand_wind(root_rest.xyz, strand.root.at);
#if VARIES
    strand.wind = wind;
#endif
    strand.push = kick(vec3(0.0), wind);
    strand.rotation = frame_rotation;
    strand.dt = step_params.dt;
    strand.decay = step_params.decay;
    strand.spring = spring;
    carry_lead(strand.address);
    return strand;
}

// The position of particle j at the step's start, relative to the root.
vec3 fetch_position(Strand strand, int j)
{
    return relative_fetch(position_before(strand.address + j * STRAND_TILE), strand.root_old);
}
// Stores the position x of a particle at the step's end, relative to the root.
void store_position(Strand strand, int address, vec3 x)
{
    positions[address] = relative_store(x, strand.root);
}
void store_root(Strand strand) { positions[strand.address] = vec4(strand.root.at, 0.0); }

vec3 fetch_velocity(Strand strand, int j)
{
    return velocity_before(strand.address + j * STRAND_TILE).xyz;
}
vec4 fetch_rest(Strand strand, int j) { return texelFetch(rest, strand.address + j * STRAND_TILE); }

// The velocity v of particle j after the forces have acted.
vec3 kicked_velocity(Strand strand, int j, vec3 v)
{
#if VARIES
    return kick_at(j, v, strand.wind);
#else
    return strand.decay * v + strand.push;
#endif
}

// The spring of particle j.
StyleSpring spring_of(Strand strand, int j)
{
#if VARIES
    vec4 a = own_along(j);
    return StyleSpring(a.x, a.y, a.z, a.w);
#else
    return strand.spring;
#endif
}

// The displacement relative to the root that particle j, now at q, would have without constraints.
// `style` advances from particle to particle and is 0 at the root.
vec3 predicted_move(Strand strand, int j, vec3 q, inout vec3 style)
{
    vec3 move = strand.dt * kicked_velocity(strand, j, fetch_velocity(strand, j)) - strand.moved;
#if STYLED
    style = next_style(style, fetch_rest(strand, j), strand.rotation);
    move += spring_of(strand, j).pull * (style - q - move);
#endif
    return move;
}

vec3 limit_move(vec3 move) { return clamp(move, -SAFE_MOVE, SAFE_MOVE); }

vec3 direction(vec3 v)
{
    float vv = dot(v, v);
    return vv > 0.0 ? v * inversesqrt(vv) : vec3(0.0, 1.0, 0.0);
}
