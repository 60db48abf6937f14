// SPDX-License-Identifier: MIT
// For tests: the share of light 0 that reaches some points.
#include "draw/shadow.h"
#include "draw/shadow.glsl"

layout(local_size_x = 8) in;
layout(location = 0) uniform vec2 fibre; // the fibre that the points lie on
layout(std430, binding = 0) readonly buffer Points { vec4 points[]; };
layout(std430, binding = 1) writeonly buffer Shares { float shares[]; };

void main()
{
    int at = int(gl_GlobalInvocationID.x);
    shadow_fibre = fibre;
    shadow_find(points[at].xyz);
    shares[at] = light_left(0);
}
