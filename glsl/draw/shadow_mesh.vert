// SPDX-License-Identifier: MIT
// The head or body in the light's view.
#include "draw/shadow.h"
#include "common/rigid.glsl"

layout(location = 0) in vec3 position; // m, the head's frame
layout(location = 1) uniform int map;

void main()
{
    vec3 x = rotate(draw_params.head_rotation, position) + draw_params.head_translation.xyz;
    vec4 place = vec4(x, 1.0) * shadow_params.mesh_from_world[map];
    float side = float(shadow_params.mesh_side);
    gl_Position = vec4(2.0 * place.xy / side - place.w, 2.0 * place.z - place.w, place.w);
}
