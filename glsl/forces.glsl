// SPDX-License-Identifier: MIT
// Forces on a velocity, the same for all solvers (needs step.h).

#include "hash.glsl"

// The wind at a strand: the four directions mixed with weights from its number, so that neighbours do not move in step.
vec3 strand_wind(uint id)
{
    uint h = hash_bits(id);
    vec2 mixing = vec2(float(int(h & 0xffffu)), float(int(h >> 16))) * (1.0 / 65535.0);
    vec3 left = mix(step_params.wind[0].xyz, step_params.wind[1].xyz, mixing.x);
    vec3 right = mix(step_params.wind[2].xyz, step_params.wind[3].xyz, mixing.x);
    return mix(left, right, mixing.y);
}

// Constant acceleration and drag c relative to the wind w, exact for any step: v e^{-ch} + (g + c w) h (1 - e^{-ch})/(ch).
vec3 kick(vec3 v, vec3 wind)
{
    return v * step_params.decay + (step_params.gravity.xyz + step_params.drag * wind) * step_params.gain;
}
