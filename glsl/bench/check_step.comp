// SPDX-License-Identifier: MIT
// Runs tractrix_step or, with PUBLISHED 1, the thesis's version on test vectors. A case has three
// vec4 as input (head, tail, the head's target); the output is the new tail.
#include "common/shared.h"
#include "sim/tractrix.glsl"
#include "bench/tractrix_published.glsl"

#define GROUP_SIZE 8
layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(std430, binding = BIND_STATE_OUT) readonly buffer Cases { vec4 cases[]; };
layout(std430, binding = BIND_POSITION_OUT) writeonly buffer Tails { vec4 tails[]; };

void main()
{
    int i = lane_index();
    if (i >= tails.length()) return;
    vec3 head = cases[3 * i].xyz, tail = cases[3 * i + 1].xyz, target = cases[3 * i + 2].xyz;
#if PUBLISHED
    tails[i] = vec4(tractrix_published(head, tail, target), 0.0);
#else
    tails[i] = vec4(tractrix_step(head, tail, target), 0.0);
#endif
}
