// SPDX-License-Identifier: MIT
// The closest surface point of each grid point that has a nearest triangle; w is 1 for these points
// and 0 for others.
#include "field/field.glsl"
#include "field/closest.glsl"

layout(std430, binding = 0) readonly buffer Nearest { uint nearest[]; };
layout(std430, binding = 1) writeonly buffer Closest { vec4 closest[]; };

void main()
{
    ivec3 at = grid_point();
    if (at.x >= int(field_params.size_x)) return;
    int address = grid_address(at);
    uint triangle = nearest[address];
    bool near = triangle != 0xffffffffu;
    uint which = near ? triangle : 0u;
    vec3 p = closest_on_triangle(field_params.low.w * vec3(at), corner(which, 0), corner(which, 1),
                                 corner(which, 2));
    closest[address] = vec4(p, near ? 1.0 : 0.0);
}
