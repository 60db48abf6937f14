// SPDX-License-Identifier: MIT
// Sums up the particles of each cell: their number, their densities at rest, their velocities. One
// strand a lane.
//
// SEGMENTS 1: for `split`, whose particles have the tip's velocity times their share of the way
// from root to tip
#define WHO 0
#include "sim/volume.glsl"

#if SEGMENTS
layout(std430, binding = BIND_TIPS) readonly buffer Tips { vec4 tips[]; };
#else
layout(binding = BIND_STATE) uniform samplerBuffer velocity;
#endif
layout(binding = BIND_VOLUME_REST) uniform usamplerBuffer rest_density;
layout(std430, binding = BIND_VOLUME_SUMS_OUT) buffer Sums { int sums[]; };

void main()
{
    int s = lane_index(), n = int(volume_params.vertex_count);
    if (s >= int(volume_params.strand_count)) return;
    int first = particle_address(s, 0, n);
    vec3 away = volume_params.head_velocity.xyz;
#if SEGMENTS
    vec3 tip = tips[2 * s + 1].xyz - away;
#endif
    for (int j = int(volume_params.carried); j < n; j += GRAIN) {
        int cell = grain_cell(first, j, n - 1), count = 0;
        ivec3 sum = ivec3(0);
        for (int i = 0; i < GRAIN; ++i) {
            int at = min(j + i, n - 1);
#if SEGMENTS
            vec3 v = share_of(at, n) * tip;
#else
            vec3 v = texelFetch(velocity, first + at * STRAND_TILE).xyz - away;
#endif
            bool counts = j + i < n && is_slow(v);
            sum += counts ? ivec3(round(v * VOLUME_STEPS)) : ivec3(0);
            count += counts ? 1 : 0;
        }
        if (cell >= 0 && count > 0) {
            int at = VOLUME_SUMS * cell;
            atomicAdd(sums[at], count);
            atomicAdd(sums[at + 1],
                      count * int(texelFetch(rest_density, first + j * STRAND_TILE).x));
            atomicAdd(sums[at + 2], sum.x);
            atomicAdd(sums[at + 3], sum.y);
            atomicAdd(sums[at + 4], sum.z);
        }
    }
}
