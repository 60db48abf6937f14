// SPDX-License-Identifier: MIT
// The strand between two steps. Particles move on straight lines in the head's frame, so that
// roots stay on the head (BOUND 1: on the mesh). A segment that turns by an angle a from step to
// step is drawn shorter by at most a^2/8: 1 % at 16 degrees.
#include "sim/inbetween_params.h"
#include "common/hair_address.glsl"
#include "common/rigid.glsl"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(binding = BIND_POSITION) uniform samplerBuffer earlier;
layout(binding = BIND_STATE) uniform samplerBuffer later;
#if BOUND
layout(binding = BIND_FRAMES) uniform samplerBuffer frames; // see shared.h
#endif
layout(std430, binding = BIND_POSITION_OUT) writeonly buffer Positions { vec4 positions[]; };

vec4 conjugate(vec4 q) { return vec4(-q.xyz, q.w); }

void main()
{
    int s = lane_index(), n = int(inbetween_params.vertex_count);
    if (s >= int(inbetween_params.strand_count)) return;
    vec4 before = inbetween_params.earlier_rotation, after = inbetween_params.later_rotation,
         to_now = inbetween_params.now_rotation;
    vec3 at_earlier = inbetween_params.earlier_translation.xyz,
         at_later = inbetween_params.later_translation.xyz;
    vec3 at_now = inbetween_params.now_translation.xyz;
#if BOUND
    at_earlier += rotate(before, texelFetch(frames, 6 * s + 1).xyz);
    at_later += rotate(after, texelFetch(frames, 6 * s + 3).xyz);
    at_now += rotate(to_now, texelFetch(frames, 6 * s + 5).xyz);
    before = product(before, texelFetch(frames, 6 * s));
    after = product(after, texelFetch(frames, 6 * s + 2));
    to_now = product(to_now, texelFetch(frames, 6 * s + 4));
#endif
    vec4 from_earlier = conjugate(before), from_later = conjugate(after);
    float share = inbetween_params.share;
    int first = particle_address(s, 0, n);
    for (int j = 0; j < n; ++j) {
        int a = first + j * STRAND_TILE;
        vec3 p = rotate(from_earlier, texelFetch(earlier, a).xyz - at_earlier);
        vec3 q = rotate(from_later, texelFetch(later, a).xyz - at_later);
        positions[a] = vec4(rotate(to_now, p + share * (q - p)) + at_now, 0.0);
    }
}
