// SPDX-License-Identifier: MIT
// Checks whether strands keep the rules after a step (stress_bound.h has the rules and their
// derivation). A lane for each strand.
//
// Energy is the mean over particles of mass 1, in the frame that moves with the root without
// rotating; x and v belong to the middle of the step:
//     E = mean(v.v/2 - g.(x - s)), where s is the place of a particle at the start.
//     B = mean(|g| l - g.s), where l is the distance along the strand, bounds mean(g.(x - s)).
// TIP 1: the strand is a single particle, its tip, with a velocity of its own (split).
#include "bench/stress_params.h"
#include "common/hair_address.glsl"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(binding = BIND_POSITION) uniform samplerBuffer position;
layout(binding = BIND_STRESS_BEFORE) uniform samplerBuffer before;
layout(binding = BIND_REST) uniform samplerBuffer rest;
layout(std430, binding = BIND_STRESS_WORST) buffer Worst { vec4 worst[]; };
layout(std430, binding = BIND_STRESS_FIRST) buffer First { uvec4 first[]; };
#if TIP
layout(std430, binding = BIND_TIPS) buffer Tips { vec4 tips[]; };
#endif

const float HUGE = 1e30;

float largest(vec3 v) { return max(abs(v.x), max(abs(v.y), abs(v.z))); }

// Written so that a NaN fails.
bool passes(float value) { return value <= stress_params.used_most; }

void main()
{
    int s = lane_index(), n = int(stress_params.vertex_count);
    if (s >= int(stress_params.strand_count)) return;
    int base = particle_address(s, 0, n);
    vec3 g = stress_params.gravity.xyz, first_g = stress_params.gravity_first.xyz,
         root = texelFetch(position, base).xyz, root_move = root - texelFetch(before, base).xyz;
    vec3 down = first_g / max(length(first_g), 1e-30);
    float strength = length(g), per_dt = stress_params.per_dt, rounding = stress_params.rounding;
    vec3 last = root, style = vec3(0.0);
    float along = 0.0, short_by = 0.0, lifted = 0.0, shortest = HUGE, highest = 0.0, kinetic = 0.0,
          potential = 0.0, budget = 0.0, began = 0.0, size = largest(root), off = 0.0, move = 0.0;
    bool finite = size < HUGE;
    // Vertex 1 is carried by the head if `carried` is 1.
    vec4 lead = texelFetch(rest, base + STRAND_TILE);
    float raised = stress_params.carried * (strength * lead.w + lead.w * dot(g, lead.xyz));
    for (int j = 1; j < n; ++j) {
        int a = base + j * STRAND_TILE;
        vec4 segment = texelFetch(rest, a);
        vec3 x = texelFetch(position, a).xyz, moved = x - texelFetch(before, a).xyz - root_move,
             v = per_dt * moved;
        float here = largest(x);
        finite = finite && here < HUGE;
        size = max(size, here);
        float now = distance(x, last);
        off = max(off, (abs(now - segment.w) - rounding * size) / segment.w);
        short_by += max(segment.w - now, 0.0);
        last = x;
        along += segment.w;
        shortest = min(shortest, segment.w);
        bool hangs = stress_params.hangs > 0.0 && float(j) > stress_params.carried;
        style += segment.w * (hangs ? down : segment.xyz);
        move = max(move, length(moved));
#if TIP
        if (j < n - 1) continue;
        x = tips[2 * s].xyz, v = tips[2 * s + 1].xyz - per_dt * root_move, moved = v / per_dt;
        finite = finite && largest(x) < HUGE && largest(v) < HUGE;
#endif
        kinetic += 0.5 * dot(v, v);
        potential += dot(g, x - root - 0.5 * moved - style);
        highest += along;
        lifted += strength * short_by + raised;
        budget += strength * along - dot(g, style);
        began += length(first_g) * along - dot(first_g, style);
    }
#if !TIP
    float mean = 1.0 / float(n - 1);
    kinetic *= mean, potential *= mean, budget *= mean, began *= mean, highest *= mean,
        lifted *= mean;
#endif
    float noise = rounding * size,
          bent = stress_params.bends * noise * noise / (shortest * shortest),
          noise_speed = stress_params.noise_steps * noise * per_dt;
    float added = stress_params.added + 4.0 * stress_params.changes * highest;
    float speed = sqrt(2.0 * (began + strength * noise) + added + bent) + stress_params.kicks +
                  stress_params.spun * lead.w + noise_speed;
    float allowed = 0.5 * speed * speed * (1.0 + stress_params.rise) +
                    stress_params.rise * stress_params.strongest * highest + lifted;
    vec4 value = vec4(0.0);
    float weight = strength * highest, pressed = weight > 0.0 ? budget / weight - 1.0 : 0.0;
    value.w = max(worst[s].w, float(stress_params.flutter * pressed > stress_params.most_flutter));
    if (stress_params.length_error > 0.0) value.x = off / stress_params.length_error;
    if (stress_params.energy != 0u && value.w == 0.0 && shortest > stress_params.resolved * noise &&
        allowed < HUGE && allowed > 0.0)
        value.y = (kinetic - potential + budget) / allowed;
    if (stress_params.rest_move > 0.0 && value.w == 0.0 && shortest > stress_params.rest_shortest &&
        shortest > stress_params.rest_resolved * noise)
        value.z = move / (stress_params.rest_move + noise);
    uvec4 broken = uvec4(!finite, !passes(value.x), !passes(value.y), !passes(value.z));
    uvec4 was = first[s];
    for (int i = 0; i < 4; ++i)
        first[s][i] = was[i] == 0u && broken[i] != 0u ? stress_params.step : was[i];
    worst[s] = max(worst[s], value);
}
