// SPDX-License-Identifier: MIT
// Dynamic follow-the-leader (Mueller, Kim, Chentanez: Fast Simulation of Inextensible Hair and Fur,
// VRIPHYS 2012).
//
// From the root on, every particle is predicted, p = x + v dt, and put at its length from its
// leader, x' = leader + l (p - leader)/|p - leader|. That alone acts as if all mass sat at the
// leader; so the velocity gets back what the follower's correction d' took:
//     v_i = (x'_i - x_i)/dt - s d'_{i+1}/dt,      s: ftl_damping
//
// STYLED 1: before that, p is drawn to the style (style_spring.h).
#include "sim/dftl_params.h"
#include "sim/particles.glsl"

void main()
{
    int s = first_strand(), n = int(step_params.vertex_count);
    if (s >= int(step_params.strand_count)) return;
    int a = strand_base(s);
    vec3 wind = strand_wind(texelFetch(strand_id, s).x, root_position(strand_root(a)));
    float dt = step_params.dt, per_second = 1.0 / step_params.dt, damping = dftl_params.damping;
    vec3 leader = root_position(strand_root(a)), leader_velocity = vec3(0.0);
    vec4 rotation = step_params.head_rotation;
    vec3 root = leader, style = vec3(0.0),
         along = rotate(rotation, texelFetch(rest, a + STRAND_TILE).xyz);
    carry_lead(a);
    positions[a] = vec4(leader, 1.0);
    for (int j = 1; j < n; ++j, a += STRAND_TILE) {
        vec3 x = texelFetch(position_before, a + STRAND_TILE).xyz;
        vec3 predicted =
            x + dt * kick_at(j, texelFetch(velocity_before, a + STRAND_TILE).xyz, wind);
        vec4 segment = texelFetch(rest, a + STRAND_TILE);
#if STYLED
        style = next_style(style, segment, rotation);
#if VARIES
        float pull = own_along(j).y;
#else
        float pull = dftl_params.spring.pull;
#endif
        predicted += pull * (root + style - predicted);
#endif
        vec3 reach = predicted - leader;
        float square = dot(reach, reach);
        // on its leader: the last direction (first the style's) goes on
        along = square > 1e-24 ? reach * inversesqrt(square) : along;
        vec3 follower = leader + segment.w * along;
        velocities[a] = vec4(leader_velocity - damping * per_second * (follower - predicted), 0.0);
        positions[a + STRAND_TILE] = vec4(follower, 1.0);
        leader_velocity = per_second * (follower - x);
        leader = follower;
    }
    velocities[a] = vec4(leader_velocity, 0.0);
}
