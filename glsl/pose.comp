// SPDX-License-Identifier: MIT
// The strand that is drawn: rebuilt from the root, every direction turned from the physical one towards the style's.
//   MIX 0: the style alone (no solver, or style = 1)   1: the physical strand alone (style = 0)   2: both
#include "step.h"
#include "rigid.glsl"

layout(local_size_x = GROUP_SIZE) in;
layout(binding = BIND_REST) uniform samplerBuffer rest;
layout(binding = BIND_STATE) uniform samplerBuffer segments; // unit direction, rest length
layout(std430, binding = BIND_POSITION_OUT) writeonly buffer Positions { vec4 positions[]; };

// Turns the unit vector a towards b by the share w of their angle. Antiparallel vectors have no plane: a stays.
vec3 slerp(vec3 a, vec3 b, float w)
{
    float c = clamp(dot(a, b), -1.0, 1.0);
    vec3 r = b - c * a;
    float sine = sqrt(dot(r, r));
    float angle = w * atan(sine, c);
    vec3 across = r * (1.0 / max(sine, 1e-12));
    return sine < 1e-7 ? (c < 0.0 ? a : b) : cos(angle) * a + sin(angle) * across;
}

void main()
{
    int width = int(step_params.strand_count), s = min(int(gl_GlobalInvocationID.x), width - 1);
    vec4 root = texelFetch(rest, s);
    vec4 turn = step_params.head_rotation; // read once: a uniform costs a load wherever it is named
    float style = step_params.style;
    int vertex_count = int(step_params.vertex_count);
    vec3 x = rotate(turn, root.xyz) + step_params.head_translation.xyz;
    positions[s] = vec4(x, 1.0);
    for (int j = 1; j < vertex_count; ++j) {
        int a = j * width + s;
#if MIX == 1
        vec4 segment = texelFetch(segments, a);
        vec3 d = segment.xyz;
#else
        vec4 segment = texelFetch(rest, a);
        vec3 d = rotate(turn, segment.xyz);
#if MIX == 2
        d = slerp(texelFetch(segments, a).xyz, d, style);
#endif
#endif
        x += segment.w * d;
        positions[a] = vec4(x, 1.0);
    }
}
