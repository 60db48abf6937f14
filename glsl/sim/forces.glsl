// SPDX-License-Identifier: MIT
// Forces on a velocity, the same for all solvers (needs frame.glsl).

#include "common/hash.h"

// What the head leaves of the wind behind it (SHELTER): seen from its middle, roots on the lee side
// feel air that more and more goes with the head. Only velocities relative to the head count, so
// that wind at rest feels the same as a head in motion.
vec3 sheltered(vec3 wind, vec3 root)
{
    vec3 blows = wind - step_params.head_velocity.xyz, out_of_head = root - step_params.shelter.xyz;
    float cosine = dot(blows, out_of_head) *
                   inversesqrt(max(dot(blows, blows) * dot(out_of_head, out_of_head), 1e-30));
    return wind - step_params.shelter.w * smoothstep(0.0, 1.0, cosine) * blows;
}

// The wind at the strand of number `id` whose root the head has carried to `root`: the four
// directions mixed with weights from the number, so that neighbours do not move in step.
vec3 strand_wind(uint id, vec3 root)
{
    uint h = hash_bits(id);
    vec2 mixing = vec2(float(int(h & 0xffffu)), float(int(h >> 16))) * (1.0 / 65535.0);
    vec3 left = mix(step_params.wind[0].xyz, step_params.wind[1].xyz, mixing.x);
    vec3 right = mix(step_params.wind[2].xyz, step_params.wind[3].xyz, mixing.x);
    vec3 wind = mix(left, right, mixing.y);
#if SHELTER
    wind = sheltered(wind, root);
#endif
    return wind;
}

#if VARIES
// Of the solver's vertices from its root on, two texels each: the solver's own; then e^{-ch}, h f,
// c, and gravity's share over its mean (recipe.h).
layout(binding = BIND_ALONG) uniform samplerBuffer along_strand;

vec4 own_along(int j) { return texelFetch(along_strand, 2 * j); }
vec4 forces_along(int j) { return texelFetch(along_strand, 2 * j + 1); }
#endif

// Constant acceleration and drag c relative to the wind w, exact for any step: v e^{-ch} + (g + c
// w) h (1 - e^{-ch})/(ch).
vec3 kick(vec3 v, vec3 wind)
{
    return v * step_params.decay + (frame_gravity + step_params.drag * wind) * step_params.gain;
}

// The same at vertex j, where drag and gravity may differ along the strand (VARIES).
vec3 kick_at(int j, vec3 v, vec3 wind)
{
#if VARIES
    vec4 forces = forces_along(j);
    return v * forces.x + (forces.w * frame_gravity + forces.z * wind) * forces.y;
#else
    return kick(v, wind);
#endif
}
