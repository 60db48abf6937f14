// SPDX-License-Identifier: MIT
// Moves a solver's state as one rigid body, and gives it the velocity of one:
//     x' = R x + T,    v' = R v + V + W x x',    d' = R d    (points, their velocities, directions)
#include "sim/carry_params.h"
#include "common/rigid.glsl"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(std430, binding = BIND_POSITION_OUT) buffer Points { vec4 points[]; };
layout(std430, binding = BIND_STATE_OUT) buffer Vectors { vec4 vectors[]; };

void main()
{
    int i = lane_index();
    if (i >= int(carry_params.count)) return;
    int p = i * int(carry_params.stride), v = p + int(carry_params.beside);
    vec4 R = carry_params.rotation, vector = vectors[v];
    vec3 gained = vec3(0.0);
    if (carry_params.directions == 0u) {
        vec4 point = points[p];
        vec3 x = rotate(R, point.xyz) + carry_params.translation.xyz;
        points[p] = vec4(x, point.w);
        gained = carry_params.velocity.xyz + cross(carry_params.spin.xyz, x);
    }
    vectors[v] = vec4(rotate(R, vector.xyz) + gained, vector.w);
}
