// SPDX-License-Identifier: MIT
// Contact of hair with the colliders, after the solver's step, each strand as a whole.
//
// Let x* be the positions that the solver gave to the particles. Contacts and tensions move them to
// the x that are nearest to x*, with the masses as measure, among all that keep the links' lengths
// and the distance `need` from the colliders: Gauss's principle of least constraint (Moreau:
// Quadratic programming in mechanics, SIAM J. Control 1966). A solver that keeps lengths has made
// x* in the same way, and a projection onto a part of a set may follow one onto the set; so x is
// what one solve with all constraints would give. A lifted particle is pulled back by both its
// neighbours.
//
// If strands bend (BENDS 1, rod), the turns of the links against each other are part of the
// measure: the solver's x* is the minimum of an energy whose second derivative has them, too.
//
// Rounds of Newton's method find x (contact_solve.glsl). Then
// velocities are changed in the same way, which is linear: none may point into a surface. What is
// too deep after the last round is pushed out link by link, from root to tip.
//
// A root may lie inside a collider. It stays there, and the needed distance of the other particles
// grows with the arc length from the root. In a groom at rest (CLEARANCE 1), a particle may be
// nearer to a collider than the margin: it needs the margin or its clearance, the distance that it
// has in the groom (negative inside), whichever is less. So contacts at rest do not push.
//
// MODE 0: positions and velocities
// MODE 1: unit directions and the tip (split): pushed out from root to tip, since particles have no
//   velocities
// MODE 2: drawn positions: the same, without friction
// MODE 3: pushes nothing; computes the clearances, once, from positions in the head's frame
// CLEARANCE 1: particles have clearances; MODE 0 and 2
// CONES: number of cones (spheres and capsules) in registers, or 0: any number, fetched
// FIELD 1: one more collider, a mesh (distance_field.glsl)
// BENDS 1: strands resist bending
// MIDPOINT 1: the solver's rule is v+ = 2 u/dt - v with the displacement u; what contact adds to u
//   then adds to v+ before velocities are changed
// BOUND 1: strands grow on a mesh that deforms
// STRANDS: strands of a lane, which use the same scratch memory
// ORDERED: see particles.glsl; here, too, a lane fetches the values of its strand before it stores
// there
#include "sim/collide_params.h"
#include "common/hair_address.glsl"
#include "common/rigid.glsl"
#if FIELD
#include "field/distance_field.glsl"
#endif
#include "sim/colliders.glsl"

#define PARTICLES 0
#define SEGMENTS  1
#define DRAWN     2
#define FINDING   3
#define SOLVES    (MODE == PARTICLES)

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
#if SOLVES
#include "sim/scratch.glsl"
#include "sim/rod_front.glsl"
#include "sim/contact.glsl"
#include "sim/relative.glsl"
#endif
#if MODE == SEGMENTS
// Unit direction, length.
layout(std430, binding = BIND_STATE_OUT) buffer Segments { vec4 segments[]; };
// Per strand: position and number of limited moves; velocity.
layout(std430, binding = BIND_TIPS) buffer Tips { vec4 tips[]; };
#endif
#if MODE == PARTICLES || MODE == DRAWN
layout(std430, binding = BIND_POSITION_OUT) buffer Positions { vec4 positions[]; };
#endif
#if MODE == FINDING
layout(std430, binding = BIND_CLEARANCE_OUT) writeonly buffer Clearances { float clearances[]; };
#endif
#if CLEARANCE
layout(binding = BIND_CLEARANCE) uniform samplerBuffer clearances;
#endif
#if MODE == PARTICLES
layout(std430, binding = BIND_STATE_OUT) buffer Velocities { vec4 velocities[]; };
#endif
#if BOUND && MODE == SEGMENTS
layout(binding = BIND_FRAMES) uniform samplerBuffer frames; // see shared.h
#endif
#if MODE == PARTICLES || MODE == SEGMENTS
layout(binding = BIND_REST) uniform samplerBuffer rest;
// Per particle: its position at the end of step w. In the root's place: split's tip.
layout(std430, binding = BIND_CONTACTS) buffer Contacts { vec4 contacts[]; };
#if SOLVES
// Per particle, for the contact of that step: its force (xyz), in lengths by which it moves the
// particle alone, and whether it sticks (w).
layout(std430, binding = BIND_CONTACT_FORCES) buffer Forces { vec4 forces[]; };
#endif
// Per strand, for its last step with contacts: number of contacts and the step. For all steps, as
// bits of floats: largest depth before and after the push.
layout(std430, binding = BIND_CONTACT_COUNTS) buffer Counts { uvec4 counts[]; };
#endif

#if ORDERED && MODE != FINDING
#define position_before(address) positions[address]
#define velocity_before(address) velocities[address]
#define segment_before(address)  segments[address]
#define contact_before(address)  contacts[address]
#define force_before(address)    forces[address]
#else
layout(binding = BIND_POSITION) uniform samplerBuffer position_texels;
layout(binding = BIND_STATE) uniform samplerBuffer state_texels;
layout(binding = BIND_CONTACTS_BEFORE) uniform samplerBuffer contact_texels;
layout(binding = BIND_CONTACT_FORCES_BEFORE) uniform samplerBuffer force_texels;
#define position_before(address) texelFetch(position_texels, address)
#define velocity_before(address) texelFetch(state_texels, address)
#define segment_before(address)  texelFetch(state_texels, address)
#define contact_before(address)  texelFetch(contact_texels, address)
#define force_before(address)    texelFetch(force_texels, address)
#endif

const int ROUNDS = CONTACT_PUSH_ROUNDS;
// Accuracy with which the end of a link is put on a surface, in lengths of the link.
const float EXACT = 1e-6;
// Depth that is given up per length along the strand: hair is out of a collider after twice its
// root's depth.
const float LEAVING = 0.5;

int n = 0;
float margin = 0.0, friction = 0.0;

#if MODE == FINDING
// Strands need this much (relative to the longest strand) less distance than required; otherwise
// rounding and solver errors would count as contacts.
const float SLACK = 1e-4;

void step_strand(int s)
{
    for (int j = 0; j < n; ++j) {
        int a = particle_address(s, j, n);
        vec3 p = rotate(collide_params.head_rotation, position_before(a).xyz) +
                 collide_params.head_translation.xyz;
        clearances[a] = nearest_surface(p).distance - SLACK * collide_params.longest;
    }
}
#else
// The strand's particle after the one at `from`.
vec3 particle_before(int address, vec3 from)
{
#if MODE == SEGMENTS
    vec4 segment = segment_before(address);
    return from + segment.w * segment.xyz;
#else
    return position_before(address).xyz;
#endif
}

// The depth below the margin that a particle may have, at arc length `arc` behind a root that is
// `inside` deep.
float allowed(float inside, float arc) { return max(inside - LEAVING * arc, 0.0); }

// The distance that a particle should have, at arc length `arc` behind a root that is `inside`
// deep.
float needed(int address, float inside, float arc)
{
#if CLEARANCE
    return min(margin, texelFetch(clearances, address).x);
#else
    return margin - allowed(inside, arc);
#endif
}

vec3 normalise_or(vec3 v, vec3 otherwise)
{
    float square = dot(v, v);
    return square > 1e-24 ? v * inversesqrt(square) : otherwise;
}

vec3 perpendicular(vec3 unit)
{
    return normalize(abs(unit.y) < 0.9 ? cross(unit, vec3(0.0, 1.0, 0.0))
                                       : cross(unit, vec3(1.0, 0.0, 0.0)));
}

// The direction of a link of length l after its end is raised by `depth` along n.
vec3 turned(vec3 d, vec3 normal, float depth, float l)
{
    float along = dot(normal, d), up = clamp(along + depth / l, -1.0, 1.0);
    return up * normal +
           sqrt(1.0 - up * up) * normalise_or(d - along * normal, perpendicular(normal));
}

#if MODE == SEGMENTS
// The motion along the surface that friction leaves, if the motion is pressed onto the surface by
// `pressed`.
vec3 held_back(vec3 motion, vec3 normal, float pressed)
{
    vec3 along = motion - dot(motion, normal) * normal;
    return along * min(friction * pressed * inversesqrt(max(dot(along, along), 1e-30)), 1.0);
}

// The velocity after a contact: not into the surface, which moves by `surface`, and slowed down
// along it.
vec3 velocity_after(vec3 v, vec3 surface, vec3 normal)
{
    vec3 relative = v - surface;
    float stopped = max(-dot(relative, normal), 0.0);
    return v + stopped * normal - held_back(relative, normal, stopped);
}
#endif

struct Strand {
    int number, first; // address of the root
    vec3 root;
    float longest; // m
};

// Finds how deep any particle is in the collider of the expression DISTANCE, beyond the depth that
// the root permits.
#define PROBE(DISTANCE)                                                                            \
    {                                                                                              \
        vec3 p = strand.root, unused;                                                              \
        float at_root = DISTANCE, own = max(margin - at_root, 0.0);                                \
        inside = max(inside, own);                                                                 \
        int last = at_root < margin + 2.0 * strand.longest ? n : 1;                                \
        for (int j = 1; j < last; ++j) {                                                           \
            int a = strand.first + j * STRAND_TILE;                                                \
            p = particle_before(a, p);                                                             \
            deepest = max(deepest, needed(a, own, float(j) * spacing) - DISTANCE);                 \
        }                                                                                          \
        p = tip;                                                                                   \
        deepest = max(deepest, needed(last_address, own, strand.longest) - DISTANCE);              \
    }

// Whether the strand touches anything. `inside`: depth of the root.
bool touches(Strand strand, out float inside)
{
    float deepest = -1.0, spacing = strand.longest / float(n - 1);
    int last_address = strand.first + (n - 1) * STRAND_TILE;
#if MODE == SEGMENTS
    vec3 tip = tips[2 * strand.number].xyz;
#else
    vec3 tip = position_before(last_address).xyz;
#endif
    inside = 0.0;
    int group = 1;
    ivec3 range;
    for (int i = 0; i < CONES_IN_ALL; ++i) {
        Cone cone = CONE(i);
        PROBE(cone_distance(cone, p, unused))
    }
#define PROBE_OTHER(kind, name, numbers, frame)                                                    \
    LOOP_OTHER(kind, name, PROBE(name##_distance(i, p, normal)))
    COLLIDERS(COLLIDER_NONE, PROBE_OTHER)
#if FIELD
    PROBE(field_distance(p, unused))
#endif
    return deepest > 0.0;
}

struct Tally {
    float contacts, found, left;
};

#if MODE != DRAWN
// The displacement of the surface in this step, at a point of it.
vec3 surface_displacement(vec3 at, float moved)
{
    vec3 surface = min(moved, 1.0) * head_displacement(at);
#if BOUND && FIELD
    vec4 before_turn = product(collide_params.head_turn_back, collide_params.head_rotation);
    if (moved > 1.5) surface += collide_params.part * rotate(before_turn, field_moved(at));
#endif
    return surface;
}
#endif

#if SOLVES
#include "sim/contact_solve.glsl"
#endif

// Pushes out a particle at `at`, which hangs on p by a link of length l, until it has at least the
// distance `need`, or, if it `touches`, just that. With friction, of the way that the particle has
// come along the surface since the step before, a part is undone: friction times the depth. Returns
// the surface and the gap. `address`: of the stored contact.
Nearest push_out(inout vec3 at, vec3 p, float l, float need, bool touches, int address,
                 out float gap)
{
    Nearest nearest = nearest_surface(at);
    gap = nearest.distance - need;
    if (gap < -EXACT * l || touches) {
        vec3 aim = at;
#if MODE == SEGMENTS
        vec4 before = contact_before(address);
        vec3 slip = at - before.xyz - surface_displacement(at, nearest.moved);
        if (before.w == collide_params.stamp_before) aim -= held_back(slip, nearest.normal, -gap);
#endif
        vec3 d = normalise_or(aim - p, nearest.normal);
        gap += dot(p + l * d - at, nearest.normal);
        for (int round = 0; round < ROUNDS && abs(gap) > EXACT * l; ++round) {
            d = turned(d, nearest.normal, -gap, l);
            at = p + l * d;
            nearest = nearest_surface(at);
            gap = nearest.distance - need;
        }
    }
    return nearest;
}

// From root to tip: pushes out what is still too deep, and writes the places.
void walk(Strand strand, float inside, inout Tally tally, out vec3 tip_moved)
{
    vec3 p = strand.root, p_before = p, x_before = p;
    float arc = 0.0;
    for (int j = 1; j < n; ++j) {
        int a = strand.first + j * STRAND_TILE;
        vec3 x = particle_before(a, x_before), at = x;
#if SOLVES
        vec4 here = recall_here(j), force = recall_force(j);
        if (here.xyz != recall_free(j)) at = strand.root + here.xyz;
        float need = force.w;
        bool touching = here.w != FREE;
#else
        const bool touching = false;
#endif
        vec3 aim = at, link = aim - p_before;
        float l = length(link), gap;
        if (p != p_before) at = p + l * normalise_or(aim - p, link / l);
        arc += l;
#if !SOLVES
        float need = j < int(collide_params.carried) ? -1e30 : needed(a, inside, arc);
#endif
#if MODE == SEGMENTS
        float found = need - nearest_surface(at).distance;
        tally.found = max(tally.found, found);
        tally.contacts += found > 0.0 ? 1.0 : 0.0;
#endif
        Nearest nearest = push_out(at, p, l, need, touching, a, gap);
        tally.left = max(tally.left, -gap);
#if MODE != DRAWN
        contacts[a] = vec4(at, collide_params.stamp);
#endif
#if SOLVES
        tally.contacts += here.w != FREE ? 1.0 : 0.0;
        rest_on(strand, j, at - strand.root, nearest, here.w != FREE ? min(gap, 0.0) : gap, l);
        keep_here(j, at - strand.root, here.w);
        forces[a] = vec4(force.xyz, here.w);
#endif
#if MODE == SEGMENTS
        if (at != x || p != x_before) segments[a] = vec4((at - p) / l, l);
#else
        // where nothing is pushed, what relative.glsl stores stays
        if (at != x) positions[a] = vec4(at, 0.0);
#endif
        x_before = x, p_before = aim, p = at;
    }
    tip_moved = p - x_before;
}

#if MODE == SEGMENTS
// The tip moves with the strand's end, and is pushed out itself.
void push_tip(Strand strand, vec3 moved)
{
    vec4 tip = tips[2 * strand.number], v = tips[2 * strand.number + 1];
    vec3 at = tip.xyz + moved;
    float gap;
    Nearest nearest =
        push_out(at, strand.root, length(at - strand.root), margin, false, strand.first, gap);
    if (gap < EXACT * strand.longest)
        v.xyz = velocity_after(v.xyz, surface_displacement(at, nearest.moved) / collide_params.dt,
                               nearest.normal);
    tips[2 * strand.number] = vec4(at, tip.w);
    tips[2 * strand.number + 1] = v;
    contacts[strand.first] = vec4(at, collide_params.stamp);
}
#endif

#if MODE != DRAWN
void write_counts(Strand strand, Tally tally)
{
    uvec4 count = counts[strand.number];
    count.zw = floatBitsToUint(max(uintBitsToFloat(count.zw), vec2(tally.found, tally.left)));
    if (tally.contacts > 0.0) count.xy = uvec2(uint(tally.contacts), uint(collide_params.stamp));
    counts[strand.number] = count;
}
#endif

#if SOLVES
void solve(Strand strand, float inside)
{
    int places = int(collide_params.rounds), rounds = places + CONTACT_VELOCITY_ROUNDS;
    bool rates = false;
    Tally tally = Tally(0.0, 0.0, 0.0);
    vec3 moved;
    open_strand(strand, inside);
    for (int round = 0; round < rounds; ++round) {
        backward(strand, rates, round == 0 || round == places, tally);
        float most = forward(rates);
        bool settled = round > 0 && round != places && most < SETTLED * SETTLED;
        if (rates && settled) break;
        if (!rates && (settled || round == places - 1)) {
            walk(strand, inside, tally, moved);
            for (int j = 1; j < n; ++j) {
#if MIDPOINT
                int a = strand.first + j * STRAND_TILE;
                vec3 pushed = recall_here(j).xyz - recall_free(j);
                if (pushed != vec3(0.0))
                    velocities[a] =
                        velocity_before(a) + vec4(2.0 / collide_params.dt * pushed, 0.0);
#endif
                keep_free(j, vec3(0.0));
                keep_here(j, recall_here(j).xyz, FREE);
                keep_force(j, vec3(0.0), 0.0);
            }
            round = places - 1, rates = true;
        }
    }
    for (int j = 1; j < n; ++j) {
        int a = strand.first + j * STRAND_TILE;
        vec3 change = recall_free(j);
        if (change != vec3(0.0)) velocities[a] = velocity_before(a) + vec4(change, 0.0);
    }
    write_counts(strand, tally);
}
#else
void solve(Strand strand, float inside)
{
    vec3 moved;
    Tally tally = Tally(0.0, 0.0, 0.0);
    walk(strand, inside, tally, moved);
#if MODE == SEGMENTS
    push_tip(strand, moved);
    write_counts(strand, tally);
#endif
}
#endif

void step_strand(int s)
{
    int first = particle_address(s, 0, n);
    float longest = collide_params.longest;
#if MODE != DRAWN
    vec4 root = texelFetch(rest, first);
    longest = root.w;
#endif
#if MODE == SEGMENTS
    vec3 at = root.xyz;
#if BOUND
    at = rotate(texelFetch(frames, 4 * s + 2), at) + texelFetch(frames, 4 * s + 3).xyz;
#endif
    at = rotate(collide_params.head_rotation, at) + collide_params.head_translation.xyz;
#else
    vec3 at = position_before(first).xyz;
#endif
    Strand strand = Strand(s, first, at, longest);
    float inside;
    if (touches(strand, inside)) solve(strand, inside);
}
#endif

void main()
{
    n = int(collide_params.vertex_count);
    margin = collide_params.margin;
    friction = collide_params.friction;
    open_cones();
#if SOLVES
    keep_base = scratch_base(PLACES, n);
#endif
    int s = group_index() * GROUP_SIZE * STRANDS + int(gl_LocalInvocationID.x);
    for (int i = 0; i < STRANDS && s < int(collide_params.strand_count); ++i, s += GROUP_SIZE)
        step_strand(s);
}
