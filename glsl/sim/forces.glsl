// SPDX-License-Identifier: MIT
// The forces on a velocity, the same for all solvers (needs frame.glsl).

// The wind that the head does not block (SHELTER). On the lee side, as seen from the middle of the
// head, the air increasingly moves with the head. Only velocities relative to the head matter, so a
// head that moves in still air and wind on a head at rest have the same effect.
vec3 sheltered(vec3 wind, vec3 root)
{
    vec3 blows = wind - step_params.head_velocity.xyz, out_of_head = root - step_params.shelter.xyz;
    float cosine = dot(blows, out_of_head) *
                   inversesqrt(max(dot(blows, blows) * dot(out_of_head, out_of_head), 1e-30));
    return wind - step_params.shelter.w * smoothstep(0.0, 1.0, cosine) * blows;
}

// A smooth wave of period 1 between 0 and 1.
float wave(float t)
{
    float way = abs(2.0 * fract(t) - 1.0);
    return way * way * (3.0 - 2.0 * way);
}

// The wind at a strand whose root is at `place` in the head's frame at rest (m) and now at `root`.
// Mixes the four wind directions with weights that vary with the place, by curved waves of about
// 0.3 m. So neighbours move alike and locks hold together, but hair a hand's breadth away does not
// move in step.
vec3 strand_wind(vec3 place, vec3 root)
{
    float x = dot(place, vec3(2.1, 1.3, -2.3)), y = dot(place, vec3(-1.7, 2.6, 1.4));
    vec2 mixing = vec2(wave(x + 0.3 * wave(y)), wave(y + 0.3 * wave(x)));
    vec3 left = mix(step_params.wind[0].xyz, step_params.wind[1].xyz, mixing.x);
    vec3 right = mix(step_params.wind[2].xyz, step_params.wind[3].xyz, mixing.x);
    vec3 wind = mix(left, right, mixing.y);
#if SHELTER
    wind = sheltered(wind, root);
#endif
    return wind;
}

#if VARIES
// Two texels for each of the solver's vertices, from the root on: the solver's own data; then
// e^{-ch}, h f, c, and the ratio of gravity's share to its mean (recipe.h).
layout(binding = BIND_ALONG) uniform samplerBuffer along_strand;

vec4 own_along(int j) { return texelFetch(along_strand, 2 * j); }
vec4 forces_along(int j) { return texelFetch(along_strand, 2 * j + 1); }
#endif

// Applies constant acceleration and drag c relative to the wind w. Exact for any step: v e^{-ch} +
// (g + c w) h (1 - e^{-ch})/(ch).
vec3 kick(vec3 v, vec3 wind)
{
    return v * step_params.decay + (frame_gravity + step_params.drag * wind) * step_params.gain;
}

// The same at vertex j if drag and gravity may differ along the strand (VARIES).
vec3 kick_at(int j, vec3 v, vec3 wind)
{
#if VARIES
    vec4 forces = forces_along(j);
    return v * forces.x + (forces.w * frame_gravity + forces.z * wind) * forces.y;
#else
    return kick(v, wind);
#endif
}
