// SPDX-License-Identifier: MIT
// Computes the followers' positions (follow_plan.h): beside their guide, or between three guides.
// One strand a lane; the followers of a guide lie side by side. CLUMPS 1: followers approach their
// guide towards the tip.
#include "sim/follow_params.h"
#include "common/hair_address.glsl"
#include "common/rigid.glsl"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(binding = BIND_POSITION) uniform samplerBuffer guides;
layout(binding = BIND_FOLLOW_OFFSETS) uniform samplerBuffer offsets;
layout(binding = BIND_FOLLOW_GUIDES) uniform usamplerBuffer others; // INTERPOLATE only
layout(std430, binding = BIND_POSITION_OUT) writeonly buffer Positions { vec4 positions[]; };

void main()
{
    int s = lane_index(), n = int(follow_params.vertex_count);
    if (s >= int(follow_params.strand_count)) return;
    vec4 own = texelFetch(offsets, s);
    vec3 offset = rotate(follow_params.head_rotation, own.xyz),
         spread = offset * (follow_params.tip_separation / float(n - 1));
    int a = particle_address(int(follow_params.first_guide) + s / int(follow_params.per_guide), 0,
                             n),
        to = particle_address(s, 0, n);
#if INTERPOLATE
    uvec4 other = texelFetch(others, s);
    int b = particle_address(int(other.x), 0, n), c = particle_address(int(other.y), 0, n);
    float share_b = own.w, share_c = uintBitsToFloat(other.z);
#endif
    for (int j = 0; j < n; ++j) {
        int at = j * STRAND_TILE;
        vec3 x = texelFetch(guides, a + at).xyz;
#if INTERPOLATE
        x += share_b * (texelFetch(guides, b + at).xyz - x) +
             share_c * (texelFetch(guides, c + at).xyz - x);
#endif
        x += offset + float(j) * spread;
#if CLUMPS
        float gathered = follow_params.clump * float(j) / float(n - 1);
        x += gathered * (texelFetch(guides, a + at).xyz - x);
#endif
        positions[to + at] = vec4(x, 0.0);
    }
}
