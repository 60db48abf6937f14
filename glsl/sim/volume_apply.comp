// SPDX-License-Identifier: MIT
// Particles take the velocity change of their cell, and a share of the way to the cell's velocity.
// One strand a lane.
//
// SEGMENTS 1: for `split`. The tip's change is the one that fits the changes of the drawn strand's
// particles best (least squares), as each particle moves by its share of the tip's change.
// ORDERED: see particles.glsl
#define WHO 0
#include "sim/volume.glsl"

#if SEGMENTS
layout(std430, binding = BIND_TIPS) buffer Tips { vec4 tips[]; };
#else
layout(std430, binding = BIND_STATE_OUT) buffer Velocities { vec4 velocities[]; };
#if ORDERED
#define velocity_before(address) velocities[address]
#else
layout(binding = BIND_STATE) uniform samplerBuffer velocity_texels;
#define velocity_before(address) texelFetch(velocity_texels, address)
#endif
#endif
layout(binding = BIND_VOLUME_CHANGES) uniform samplerBuffer changes;
layout(std430, binding = BIND_VOLUME_DENSE_OUT) readonly buffer Dense { uint dense[]; };

void main()
{
    int s = lane_index(), n = int(volume_params.vertex_count);
    if (s >= int(volume_params.strand_count) || dense[0] == 0u) return;
    int first = particle_address(s, 0, n);
    vec3 away = volume_params.head_velocity.xyz;
#if SEGMENTS
    vec4 tip = tips[2 * s + 1];
    vec3 pushed = vec3(0.0);
    float squares = 0.0;
    for (int j = 1; j < n; ++j) squares += share_of(j, n) * share_of(j, n);
#endif
    for (int j = int(volume_params.carried); j < n; j += GRAIN) {
        int cell = grain_cell(first, j, n - 1);
        vec4 change = cell < 0 ? vec4(0.0) : texelFetch(changes, cell);
        int end = change == vec4(0.0) ? 0 : n - j;
        if (end > 0) {
            for (int i = 0; i < GRAIN; ++i) {
#if SEGMENTS
                float share = share_of(j + i, n);
                vec3 v = share * (tip.xyz - away);
                pushed += i < end && is_slow(v) ? share * (change.xyz - change.w * v) : vec3(0.0);
#else
                int a = first + min(j + i, n - 1) * STRAND_TILE;
                vec4 v = velocity_before(a);
                vec3 relative = v.xyz - away;
                if (i < end && is_slow(relative))
                    velocities[a] = vec4(v.xyz + change.xyz - change.w * relative, v.w);
#endif
            }
        }
    }
#if SEGMENTS
    tips[2 * s + 1] = vec4(tip.xyz + pushed / squares, tip.w);
#endif
}
