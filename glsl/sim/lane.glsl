// SPDX-License-Identifier: MIT
// A strand on its way through a step: what solvers of particles with an implicit style spring begin with (needs particles.glsl).
// Macros: STYLED, whether there is a style spring. own[0].x: its pull, see style_spring.glsl.
#include "sim/style_spring.glsl"

const float SAFE_MOVE = 1e15; // metres: keeps squares finite whatever the head does

struct Lane {
    int address; // of the root
    vec3 root, root_old, root_velocity;
    float length;  // of the strand
    vec3 push;     // what forces add to a velocity
    vec4 rotation; // of the head
    float dt, decay, pull;
};

Lane lane_open(int strand)
{
    Lane lane;
    lane.address = strand_base(strand);
    vec4 root_rest = strand_root(lane.address);
    lane.root = root_position(root_rest);
    lane.root_old = texelFetch(position_before, lane.address).xyz;
    lane.root_velocity = (lane.root - lane.root_old) / step_params.dt;
    lane.length = root_rest.w;
    lane.push = kick(vec3(0.0), strand_wind(texelFetch(strand_id, strand).x, lane.root));
    lane.rotation = step_params.head_rotation;
    lane.dt = step_params.dt;
    lane.decay = step_params.decay;
    lane.pull = STYLE_PULL;
    carry_lead(lane.address);
    return lane;
}

vec3 fetch_position(Lane lane, int j) { return texelFetch(position_before, lane.address + j * STRAND_TILE).xyz; }
vec3 fetch_velocity(Lane lane, int j) { return texelFetch(velocity_before, lane.address + j * STRAND_TILE).xyz; }
vec4 fetch_rest(Lane lane, int j) { return texelFetch(rest, lane.address + j * STRAND_TILE); }

// How far particle j, now at q, would go without constraints. `style` goes from particle to particle, 0 at the root.
vec3 predicted_move(Lane lane, int j, vec3 q, inout vec3 style)
{
    vec3 move = lane.dt * (lane.decay * fetch_velocity(lane, j) + lane.push);
#if STYLED
    style = next_style(style, fetch_rest(lane, j), lane.rotation);
    move += lane.pull * (style - (q - lane.root) - move);
#endif
    return move;
}

vec3 limit_move(vec3 move) { return clamp(move, -SAFE_MOVE, SAFE_MOVE); }

vec3 direction(vec3 v)
{
    float vv = dot(v, v);
    return vv > 0.0 ? v * inversesqrt(vv) : vec3(0.0, 1.0, 0.0);
}
