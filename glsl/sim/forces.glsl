// SPDX-License-Identifier: MIT
// Forces on a velocity, the same for all solvers (needs step.h).

#include "common/hash.glsl"

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

// Constant acceleration and drag c relative to the wind w, exact for any step: v e^{-ch} + (g + c
// w) h (1 - e^{-ch})/(ch).
vec3 kick(vec3 v, vec3 wind)
{
    return v * step_params.decay +
           (step_params.gravity.xyz + step_params.drag * wind) * step_params.gain;
}
