// SPDX-License-Identifier: MIT
// Moves a solver's state as one rigid body, and gives it that body's velocity. BOUND 1: each
// strand has a motion of its own. For points, their velocities and directions:
//     x' = R x + T,    v' = R v + V + W x x',    d' = R d
#include "sim/carry_params.h"
#include "common/rigid.glsl"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(std430, binding = BIND_POSITION_OUT) buffer Points { vec4 points[]; };
layout(std430, binding = BIND_STATE_OUT) buffer Vectors { vec4 vectors[]; };
#if BOUND
layout(binding = BIND_FRAMES) uniform samplerBuffer motions; // per strand: R, T, V, W
#endif

void main()
{
    int i = lane_index();
    if (i >= int(carry_params.count)) return;
    int p = i * int(carry_params.stride), v = p + int(carry_params.beside);
    vec4 R = carry_params.rotation, vector = vectors[v];
    vec3 T = carry_params.translation.xyz, V = carry_params.velocity.xyz, W = carry_params.spin.xyz;
#if BOUND
    int particles = STRAND_TILE * int(carry_params.vertex_count),
        strand = carry_params.beside != 0u ? i : i / particles * STRAND_TILE + i % STRAND_TILE;
    R = texelFetch(motions, 4 * strand);
    T = texelFetch(motions, 4 * strand + 1).xyz;
    V = texelFetch(motions, 4 * strand + 2).xyz;
    W = texelFetch(motions, 4 * strand + 3).xyz;
#endif
    vec3 gained = vec3(0.0);
    if (carry_params.directions == 0u) {
        vec4 point = points[p];
        vec3 x = rotate(R, point.xyz) + T;
        points[p] = vec4(x, point.w);
        gained = V + cross(W, x);
    }
    vectors[v] = vec4(rotate(R, vector.xyz) + gained, vector.w);
}
