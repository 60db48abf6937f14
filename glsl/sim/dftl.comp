// SPDX-License-Identifier: MIT
// Dynamic follow-the-leader (Mueller, Kim, Chentanez: Fast Simulation of Inextensible Hair and
// Fur, VRIPHYS 2012).
//
// From the root on, every particle is predicted, p = x + v dt, and put at its length from its
// leader, x' = leader + l (p - leader)/|p - leader|. That alone acts as if all mass sat at the
// leaders. So the velocity gets back what the follower's correction d' took:
//     v_i = (x'_i - x_i)/dt - s d'_{i+1}/dt,      s: ftl_damping
// The stored velocity is that of the drawn strand, u = (x'_i - x_i)/dt. Its fourth component is s
// d'_{i+1}/dt as a share of the segment; d' lies along the segment.
//
// STYLED 1: before that, p is pulled towards the style (style_spring.h).
//
// GUARDED 1: corrections do not add energy to the drawn strand (energy_account.glsl). Nearly
// always the next step pays for the energy, so no particle is visited twice. If the strand has
// gained more than PAID_ABOVE of what gravity could give to it, and of the energy that it has, its
// velocities are reduced by the share `paid`, towards the root's velocity, when the next step
// begins. That next step is expected to add about as much energy as this step did, before it can
// pay, so that much is paid in advance. `paid` is stored in the fourth component of the tip's
// velocity.
#include "sim/dftl_params.h"
#include "sim/particles.glsl"
#include "sim/strand.glsl"

const float ALLOWED = 0.003; // share of the energy
#define SLOWS_AGAIN 1
#include "sim/energy_account.glsl"

const float PAID_ABOVE = 0.001; // share of the energy

void main()
{
    int s = first_strand(), last = int(step_params.vertex_count) - 1;
    if (s >= int(step_params.strand_count)) return;
    Strand strand = strand_open(s, dftl_params.spring);
    int tip = strand.address + last * STRAND_TILE;
    float per_second = 1.0 / strand.dt, given = dftl_params.damping * per_second;
    vec3 leader = vec3(0.0), leader_before = vec3(0.0), leader_moved = vec3(0.0),
         leader_velocity = strand.root_velocity, style = vec3(0.0),
         along = rotate(strand.rotation, fetch_rest(strand, 1).xyz), x = fetch_position(strand, 1);
#if GUARDED
    Account account = account_open(strand);
    float paid = velocity_before(tip).w;
#endif
    store_root(strand);
    for (int j = 1; j <= last; ++j) {
        int a = strand.address + j * STRAND_TILE;
        vec3 ahead = fetch_position(strand, min(j + 1, last));
        vec4 u = velocity_before(a), segment = fetch_rest(strand, j);
#if GUARDED
        u.xyz = mix(u.xyz, account.moved_before / strand.dt, paid);
#endif
        // u leads to x + move, v to x + move + back, relative to the root
        vec3 kicked = kicked_velocity(strand, j, u.xyz), move = strand.dt * kicked - strand.moved,
             back = strand.dt * (kicked_velocity(strand, j, u.xyz - u.w * (ahead - x)) - kicked);
#if STYLED
        float pull = spring_of(strand, j).pull;
        style = next_style(style, segment, strand.rotation);
        move += pull * (style - x - move);
        back -= pull * back;
#endif
        vec3 link = x - leader_before, pulled = move + back - leader_moved, reach = link + pulled;
        float square = dot(reach, reach), size = sqrt(square),
              longer = relative_longer(link, pulled, segment.w, size, 0.0);
        // if it is on its leader, the last direction (at first the style's) continues
        along = square > 1e-24 ? reach * inversesqrt(square) : along;
        velocities[a - STRAND_TILE] = vec4(leader_velocity, -given * longer / segment.w);
        leader_moved += relative_turn(link, pulled, segment.w, size, 0.0, along);
        leader += segment.w * along;
        store_position(strand, a, leader);
#if GUARDED
        account_add(account, strand, leader_moved, move, u.xyz);
#endif
        leader_velocity = per_second * (leader_moved + strand.moved);
        leader_before = x, x = ahead;
    }
    velocities[tip] = vec4(leader_velocity, 0.0);
#if GUARDED
    float per_square = 0.5 * per_second * per_second,
          rise = per_square * (account.squares + account.linear + account.constant),
          gained = account_close(account, strand, last), kinetic = per_square * account.squares,
          fall = account_fall(strand, last),
          over = gained + max(rise, 0.0) - PAID_ABOVE * (fall + kinetic);
    over = clamp(over < 1e30 ? over : 0.0, 0.0, kinetic);
    if (over > 0.0) velocities[tip].w = 1.0 - root_of_rest(over / kinetic);
    velocities[strand.address] = vec4(strand.root_velocity, gained - over);
#endif
}
