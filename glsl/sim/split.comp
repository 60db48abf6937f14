// SPDX-License-Identifier: MIT
// A step of `split`: the tip is simulated, the strand follows as a chain of tractrices.
//
// State: unit directions of the segments with their rest lengths (j > 0 from particle j - 1 to j), and the tip particle.
//   1. kick the tip; where it flies to is the target                       (THESIS 0 or 1, below)
//   2. pull the strand's end to the target: every tail is the next head    (tip -> root)
//   3. pull the root back to where the head carries it                     (root -> tip)
//   Without THESIS 2 and 3 are repeated.
//
// DRAGGED 0: all moves are seen from the root, which carries the strand along, so that a head at constant speed is like one at rest.
// DRAGGED 1: the strand is also pulled through the world by the root.
//
// After a pull the far end has moved by what is left in `move`; the next pull begins there and undoes it, so each pull is the
// same loop over the strand turned round: order reversed, directions negated. With IN_REGISTERS the strand stays in
// registers for the whole step (VERTICES is known, loops unroll); without, any length goes through memory. A lane takes
// STRANDS strands: their chains of dependent arithmetic overlap in the pipeline of a CPU.
#include "sim/step.h"
#include "common/hair_address.glsl"
#include "common/rigid.glsl"
#include "sim/forces.glsl"
#include "sim/tractrix.glsl"

layout(local_size_x = GROUP_SIZE) in;
layout(binding = BIND_REST) uniform samplerBuffer rest;
layout(binding = BIND_STRAND_ID) uniform usamplerBuffer strand_id;
#include "sim/strand_root.glsl"
layout(binding = BIND_STATE) uniform samplerBuffer segments_before; // the same buffer, fetched before anything is written
layout(std430, binding = BIND_STATE_OUT) buffer Segments { vec4 segments[]; };
layout(std430, binding = BIND_TIPS) buffer Tips { vec4 tips[]; }; // a strand: position, times limited; velocity

// A tip flung further than this in one step, in strand lengths, would fold segments in float32: its velocity is cut.
const float MOVE_LIMIT = 100.0;
const float SAFE_MOVE = 1e15; // metres: keeps squares finite whatever the head does

#if IN_REGISTERS
const int LINKS = VERTICES - 1;
#else
#define LINKS int(step_params.vertex_count - 1u)
#endif

vec3 root_at(vec4 rotation, vec4 translation, vec4 root) { return rotate(rotation, root.xyz) + translation.xyz; }

struct Tip {
    vec3 position, velocity;
    float limited; // how often its velocity was cut
};

#if THESIS
// The published rule: the tip flies straight; its velocity follows from where the pulls have left it.
vec3 tip_target(inout Tip tip, vec3 root_old, vec3 root, float R, vec3 push)
{
    return tip.position + tip.velocity * step_params.dt;
}
#else
// The tip is a mass on an inextensible string of length R from the root: it flies freely inside the ball, and on leaving it
// lands on the sphere, displaced along the old string (the direction of the constraint's force, which makes it second order) if
// the string was taut then and the step is not too long for that, else radially.
//
// Moved so, what goes on from step to step is R sin(delta), delta the angle that it turns in a step, where the arc R delta should: energy
// at the bottom of a swing would be too large by its share delta^2/4 (0.028 m g L at 30 Hz). Forces across the string that push by k
// in a step shall turn it by k/R, so that their push along the motion acts by cos(delta) and across it by sin(delta)/delta, to
// fourth order k - k delta^2/6 - (k.m) m/3 with m = delta along the motion, in the step's middle. (DRAGGED keeps to the reference traces.)
vec3 tip_target(inout Tip tip, vec3 root_old, vec3 root, float R, vec3 push)
{
    vec3 target = tip.position + tip.velocity * step_params.dt;
    vec3 s = target - root, r = tip.position - root_old;
    float ss = dot(s, s), rr = dot(r, r), sr = dot(s, r), excess = ss - R * R;
#if !DRAGGED
    vec3 pushed = push * step_params.dt, middle = s - 0.5 * pushed;
    pushed -= r * (dot(pushed, r) / rr), middle -= r * (dot(middle, r) / rr);
    float bent = dot(middle, middle) / (R * R);
    if (excess > 0.0 && rr > 0.99 * R * R && sr > 0.0 && bent < 1.0) {
        s -= pushed * (bent / 6.0) + middle * (dot(pushed, middle) / (3.0 * R * R));
        ss = dot(s, s), sr = dot(s, r), excess = max(ss - R * R, 0.0);
        target = root + s;
    }
#endif
    if (excess > 0.0) {
        float disc = sr * sr - rr * excess;
        if (rr > 0.99 * R * R && sr > 0.0 && disc > 0.1 * sr * sr) s -= r * (excess / (sr + sqrt(disc)));
        target = root + s * (R * inversesqrt(dot(s, s)));
    }
    tip.velocity = (target - tip.position) / step_params.dt;
    return target;
}
#endif

void limit_speed(inout Tip tip, float R)
{
    float most = MOVE_LIMIT * R / step_params.dt;
    float fastest = max(abs(tip.velocity.x), max(abs(tip.velocity.y), abs(tip.velocity.z)));
    if (fastest > most) {
        vec3 v = tip.velocity / fastest;
        tip.velocity = v * (most * inversesqrt(dot(v, v)));
        tip.limited += 1.0;
    }
}

void main()
{
    // Strands of a lane are GROUP_SIZE apart; those past the end, if any, are the copies that fill the last tile.
    int first = int(gl_WorkGroupID.x) * GROUP_SIZE * STRANDS + int(gl_LocalInvocationID.x);
    if (first >= int(step_params.strand_count)) return;
    int s[STRANDS], base[STRANDS]; // strand, address of its root
    vec3 move[STRANDS], home[STRANDS], target[STRANDS];
    Tip tip[STRANDS];
#if IN_REGISTERS
    vec4 link[STRANDS][LINKS]; // link 0 is pulled first: direction head -> tail, length
#endif

    for (int k = 0; k < STRANDS; ++k) {
        s[k] = first + k * GROUP_SIZE;
        base[k] = particle_address(s[k], LEAD, LINKS + 1 + LEAD);
        vec4 root_rest = strand_root(base[k]);
#if LEAD
        vec4 lead = texelFetch(rest, base[k]);
        segments[base[k]] = vec4(rotate(step_params.head_rotation, lead.xyz), lead.w);
#endif
        float R = root_rest.w;
        vec3 root_old = root_at(step_params.head_rotation_old, step_params.head_translation_old, root_rest);
        vec3 root = root_at(step_params.head_rotation, step_params.head_translation, root_rest);

        vec3 span = vec3(0.0); // root -> strand's end
        for (int i = 0; i < LINKS; ++i) {
            vec4 segment = texelFetch(segments_before, base[k] + (LINKS - i) * STRAND_TILE);
            span += segment.w * segment.xyz;
#if IN_REGISTERS
            link[k][i] = vec4(-segment.xyz, segment.w);
#endif
        }
        vec4 at = tips[2 * s[k]], v = tips[2 * s[k] + 1];
        tip[k] = Tip(at.xyz, kick(v.xyz, strand_wind(texelFetch(strand_id, s[k]).x, root)), at.w);
        limit_speed(tip[k], R);
        target[k] = tip_target(tip[k], root_old, root, R, kick(vec3(0.0), strand_wind(texelFetch(strand_id, s[k]).x, root)));
#if DRAGGED
        home[k] = root - root_old;
#else
        home[k] = vec3(0.0);
#endif
        move[k] = target[k] - (root - home[k] + span);
    }

    for (int pass = 0; pass < int(step_params.passes); ++pass) {
        for (int k = 0; k < STRANDS; ++k) move[k] = clamp(move[k], -SAFE_MOVE, SAFE_MOVE);
#if IN_REGISTERS
        vec4 turned[STRANDS][LINKS];
        for (int i = 0; i < LINKS; ++i)
            for (int k = 0; k < STRANDS; ++k)
                turned[k][LINKS - 1 - i] = vec4(-tractrix_turn(link[k][i].xyz, link[k][i].w, move[k]), link[k][i].w);
        link = turned;
#else
        bool from_tip = (pass & 1) == 0;
        for (int i = 0; i < LINKS; ++i)
            for (int k = 0; k < STRANDS; ++k) {
                int a = base[k] + (from_tip ? LINKS - i : 1 + i) * STRAND_TILE;
                vec4 segment = segments[a];
                vec3 d = tractrix_turn(from_tip ? -segment.xyz : segment.xyz, segment.w, move[k]);
                segments[a] = vec4(from_tip ? -d : d, segment.w);
            }
#endif
        for (int k = 0; k < STRANDS; ++k) {
            target[k] = pass == int(step_params.passes) - 1 ? target[k] + move[k] : target[k]; // where the last pull left the end
            move[k] = home[k] - move[k];
            home[k] = vec3(0.0);
        }
    }

    for (int k = 0; k < STRANDS; ++k) {
        for (int i = 0; i < LINKS; ++i) {
#if IN_REGISTERS
            vec4 segment = link[k][i];
            segments[base[k] + (LINKS - i) * STRAND_TILE] = vec4(tractrix_renormalise(-segment.xyz), segment.w);
#else
            int a = base[k] + (1 + i) * STRAND_TILE;
            vec4 segment = segments[a];
            segments[a] = vec4(tractrix_renormalise(segment.xyz), segment.w);
#endif
        }
#if THESIS
        tip[k].velocity = (target[k] - tip[k].position) / step_params.dt;
        tip[k].position = target[k];
#else
        tip[k].position += tip[k].velocity * step_params.dt;
#endif
        tips[2 * s[k]] = vec4(tip[k].position, tip[k].limited);
        tips[2 * s[k] + 1] = vec4(tip[k].velocity, 0.0);
    }
}
