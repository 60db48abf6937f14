// SPDX-License-Identifier: MIT
// A step of `split`: the tip is a mass, and the strand follows it as a chain of tractrices.
//
//   1. Kick the tip. The place to which it flies is the target.
//   2. Pull the strand's end to the target, from tip to root: the tail of each segment is the head
//      of the next.
//   3. Pull the root back to where the head carries it, from root to tip. Then 2 and 3 again: the
//      second round brings the end nearer to the target.
//   4. Pose: turn the drawn directions towards the style's (pose.comp).
//
// State: unit directions of the segments with their rest lengths (segment j > 0 goes from particle
// j - 1 to j), and the tip, which relative.glsl stores: its fourth component in that of the
// velocity. Positions are relative to the root. All moves are relative to the root, which carries
// the strand along, so a head at constant speed is like a head at rest. DRAGGED 1: the published
// rules, split_published.glsl.
#include "sim/split_params.h"
#include "sim/step_params.h"
#include "common/hair_address.glsl"
#include "common/rigid.glsl"
#include "sim/frame.glsl"
#include "sim/forces.glsl"
#include "sim/relative.glsl"
#include "sim/tractrix.glsl"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(binding = BIND_REST) uniform samplerBuffer rest;
#include "sim/strand_root.glsl"
#include "sim/split_links.glsl"
layout(std430, binding = BIND_TIPS) buffer Tips { vec4 tips[]; }; // see open_strand

// A tip that moves farther than this in one step, in strand lengths, would fold segments in
// float32, so its velocity is limited.
const float MOVE_LIMIT = 100.0;

struct Strand {
    int number, address;     // address of the root
    float total_length;      // R, m
    Root root_old, root;     // at the step's start and end
    vec3 moved;              // displacement of the root
    vec3 push;               // velocity that forces add in this step, m/s
    vec3 position, velocity; // of the tip
    float limited;           // number of times its velocity was limited
};

// The root as the head moves it, and the tip after its kick.
Strand open_strand(int number)
{
    Strand strand;
    strand.number = number;
    strand.address = particle_address(number, LEAD, LINKS + 1 + LEAD);
    vec4 root = strand_root(strand.address), tip = tips[2 * number], v = tips[2 * number + 1];
    strand.total_length = root.w;
    open_frame(number);
    strand.root_old = relative_root(frame_root_old(root.xyz), root.w);
    strand.root = relative_root(frame_root(root.xyz), root.w);
    strand.moved = frame_move(root.xyz);
    vec3 wind = strand_wind(root.xyz, strand.root.at);
    strand.push = kick(vec3(0.0), wind);
    strand.position = relative_fetch(vec4(tip.xyz, v.w), strand.root_old);
    strand.velocity = kick(v.xyz, wind);
    strand.limited = tip.w;
    float most = MOVE_LIMIT * strand.total_length / step_params.dt;
    float fastest =
        max(abs(strand.velocity.x), max(abs(strand.velocity.y), abs(strand.velocity.z)));
    if (fastest > most) {
        vec3 u = strand.velocity / fastest;
        strand.velocity = u * (most * inversesqrt(dot(u, u)));
        strand.limited += 1.0;
    }
    for (int i = 0; i < LEAD; ++i) {
        int a = strand.address - i * STRAND_TILE;
        vec4 lead = texelFetch(rest, a);
        segments[a] = vec4(rotate(frame_rotation, lead.xyz), lead.w);
    }
    return strand;
}

// Whether the tip is on the sphere of radius R but for rounding, which is more than the move of a
// short step.
bool on_sphere(vec3 r, float R) { return abs(dot(r, r) - R * R) < 1e-6 * R * R; }

// |r + m|^2 - R^2: more than 0 if m leads out of the ball of radius R.
float excess_of(vec3 r, vec3 m, float R)
{
    return on_sphere(r, R) ? dot(2.0 * r + m, m) : dot(r + m, r + m) - R * R;
}

// The tip is on an inextensible string of length R. If its flight by m relative to the root ends
// outside the ball of radius R, it lands on the sphere. If the string was taut and the step is not
// too long, the tip is displaced along the old string (the direction of the constraint's force,
// which makes this second order), otherwise radially. Returns where it lands.
vec3 land(inout Strand strand, vec3 m)
{
    vec3 r = strand.position, s = r + m;
    float R = strand.total_length, rr = dot(r, r), sr = dot(s, r), excess = excess_of(r, m, R);
    if (excess > 0.0) {
        float disc = sr * sr - rr * excess;
        bool taut = rr > 0.99 * R * R && sr > 0.0 && disc > 0.1 * sr * sr;
        if (taut) m -= r * (excess / (sr + sqrt(disc)));
        s = r + m;
        float size = sqrt(dot(s, s));
        vec3 d = s / size;
        s = R * d;
        m = on_sphere(r, R) ? relative_turn(r, m, R, size, 0.0, d) : s - r;
    }
    strand.velocity = (m + strand.moved) / step_params.dt;
    return s;
}

#if DRAGGED
#include "sim/split_published.glsl"
#else
// Where the tip flies to. Landing as above turns the string by an angle delta per step and
// preserves R sin(delta) from step to step, where it should preserve the arc R delta: the energy at
// the bottom of a swing would be too large by the share delta^2/4 (0.028 m g L at 30 Hz). Forces
// across the string that push by k in a step should turn it by k/R. So their push is multiplied by
// cos(delta) along the motion and by sin(delta)/delta across it; to fourth order this is k - k
// delta^2/6 - (k.m) m/3, where m = delta along the motion, in the step's middle.
vec3 fly(inout Strand strand)
{
    vec3 r = strand.position, flown = strand.velocity * step_params.dt - strand.moved,
         k = strand.push * step_params.dt, m = r + flown - 0.5 * k;
    float R = strand.total_length, rr = dot(r, r);
    k -= r * (dot(k, r) / rr), m -= r * (dot(m, r) / rr);
    float bent = dot(m, m) / (R * R);
    if (excess_of(r, flown, R) > 0.0 && rr > 0.99 * R * R && dot(r + flown, r) > 0.0 && bent < 1.0)
        flown -= k * (bent / 6.0) + m * (dot(k, m) / (3.0 * R * R));
    return land(strand, flown);
}

// The pull by the root besides carrying the strand along.
vec3 drag_of(Strand strand) { return vec3(0.0); }

// Sets the tip at the step's end: its target. The pulls have moved the strand's end to `end`.
void settle(inout Strand strand, vec3 target, vec3 end) { strand.position = target; }
#endif

// A lane takes STRANDS strands, GROUP_SIZE apart, so that their dependent chains of arithmetic
// overlap in a CPU's pipeline. Strands beyond the end are the copies that fill the last tile.
void main()
{
    int first = group_index() * GROUP_SIZE * STRANDS + int(gl_LocalInvocationID.x);
    if (first >= int(step_params.strand_count)) return;
    Strand strand[STRANDS];
    vec3 target[STRANDS], move[STRANDS], drag[STRANDS];
    int address[STRANDS];

    for (int k = 0; k < STRANDS; ++k) {
        strand[k] = open_strand(first + k * GROUP_SIZE);
        address[k] = strand[k].address;
        vec3 span = open_links(k, address[k]);
        target[k] = fly(strand[k]);
        drag[k] = drag_of(strand[k]);
        move[k] = target[k] - (span - drag[k]);
    }

    // Pulls the end and the root in turn. The other end moves by the remaining `move`; the next
    // pull starts there and takes it back: the root to the head, the end to its target.
    for (int pull = 0; pull < split_params.pulls; ++pull) {
        pull_links(address, move, (pull & 1) == 0);
        for (int k = 0; k < STRANDS; ++k) move[k] = drag[k] - move[k], drag[k] = vec3(0.0);
    }

    for (int k = 0; k < STRANDS; ++k) {
        close_links(k, address[k]);
        settle(strand[k], target[k], target[k] - move[k]);
        vec4 tip = relative_store(strand[k].position, strand[k].root);
        tips[2 * strand[k].number] = vec4(tip.xyz, strand[k].limited);
        tips[2 * strand[k].number + 1] = vec4(strand[k].velocity, tip.w);
    }
}
