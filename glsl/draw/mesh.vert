// SPDX-License-Identifier: MIT
// The head or body, moved by the head's motion.
#include "draw/draw.h"
#include "common/rigid.glsl"

layout(location = 0) in vec3 position; // m, the head's frame
layout(location = 1) in vec3 normal;
// Shares of the sky: with hair and mesh in the way, with the mesh.
layout(location = 2) in vec2 open;
layout(location = 3) in vec3 tint; // factors of the mesh's colour

invariant gl_Position; // the same in both of its programs
out vec3 world_position;
out vec3 world_normal; // its length is the visible share of the sky
out vec4 own_tint;

void main()
{
    world_position = rotate(draw_params.head_rotation, position) + draw_params.head_translation.xyz;
    world_normal = open.x * rotate(draw_params.head_rotation, normal);
    own_tint = vec4(tint, open.y);
    gl_Position = draw_params.clip_from_world * vec4(world_position, 1.0);
}
