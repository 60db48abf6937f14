// SPDX-License-Identifier: MIT
// The floor, a disc: a fan whose first vertex is its middle.
#include "draw/draw.h"
#include "draw/floor.glsl"

out vec3 world_position;

void main()
{
    float angle = float(gl_VertexID - 1) * (6.28318531 / float(FLOOR_CORNERS));
    vec2 way = gl_VertexID == 0 ? vec2(0.0) : vec2(cos(angle), sin(angle));
    world_position = floor_middle.xyz + floor_reach.z * vec3(way.x, 0.0, way.y);
    gl_Position = draw_params.clip_from_world * vec4(world_position, 1.0);
}
