// SPDX-License-Identifier: MIT
// Pushes hair out of the colliders after the solver's step, each strand from root to tip.
//
// Let x be the position that the solver gave to particle j, and p the position of the particle
// before it, which this pass may have moved. Particle j keeps its distance l: it goes from p
// towards x by l. So no particle moves farther than the particle before it. `need` is the distance
// from the collider that a particle should have. If the particle is too deep, the link turns about
// p. With the surface's normal n, the new direction d' has n.d' = n.d + depth/l and the rest along
// the tangent of d. This puts a particle exactly on a plane, and on a curved surface after a few
// rounds (Newton's method). So lengths stay the same, and hair at rest comes back to the same
// place in every step.
//
// Friction is Coulomb's.
// - Positions: of the way that the particle has come along the surface since the step before, a
//   part is undone: friction times the depth that is pushed out, at most all of the way. Otherwise
//   hair at rest would creep by g dt^2 a step.
// - Velocities, relative to the surface: the part into the surface is removed, and along the
//   surface at most friction times as much. Nothing gains speed except by the push itself.
// - Particles that move only because the particle before them was pushed keep their velocity.
//   (Giving them the displacement over dt, all of it or only what slows them down, made styled
//   strands that lie on a sphere flutter for ever.)
//
// A root may lie inside a collider. It stays there, and the needed distance of the other particles
// grows with the arc length from the root. In a groom at rest (CLEARANCE 1), a particle may be
// nearer to a collider than the margin: it needs the margin or its clearance, the distance that it
// has in the groom (negative inside), whichever is less. So contacts at rest do not push.
//
// MODE 0: positions and velocities
// MODE 1: unit directions and the tip (split)
// MODE 2: drawn positions, without velocities and friction
// MODE 3: pushes nothing; computes the clearances, once, from positions in the head's frame
// CLEARANCE 1: particles have clearances; MODE 0 and 2
// CONES: number of cones (spheres and capsules) in registers, or 0: any number, fetched
// FIELD 1: one more collider, a mesh (distance_field.glsl)
// BOUND 1: strands grow on a mesh that deforms
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

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
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
// Per strand, for its last step with contacts: number of contacts and the step. For all steps, as
// bits of floats: largest depth before and after the push.
layout(std430, binding = BIND_CONTACT_COUNTS) buffer Counts { uvec4 counts[]; };
#endif

#if ORDERED && MODE != FINDING
#define position_before(address) positions[address]
#define velocity_before(address) velocities[address]
#define segment_before(address)  segments[address]
#define contact_before(address)  contacts[address]
#else
layout(binding = BIND_POSITION) uniform samplerBuffer position_texels;
layout(binding = BIND_STATE) uniform samplerBuffer state_texels;
layout(binding = BIND_CONTACTS_BEFORE) uniform samplerBuffer contact_texels;
#define position_before(address) texelFetch(position_texels, address)
#define velocity_before(address) texelFetch(state_texels, address)
#define segment_before(address)  texelFetch(state_texels, address)
#define contact_before(address)  texelFetch(contact_texels, address)
#endif

const int ROUNDS = 3;
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

void main()
{
    int s = lane_index();
    n = int(collide_params.vertex_count);
    if (s >= int(collide_params.strand_count)) return;
    open_cones();
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

// Pushes out a particle at `at`, which hangs on p by a link of length l, until it has at least the
// distance `need`. `address` is that of its stored contact.
void push_out(inout vec3 at, inout vec3 v, vec3 p, float l, float need, int address,
              inout Tally tally)
{
    Nearest nearest = nearest_surface(at);
    float depth = need - nearest.distance;
    bool contact = depth > 0.0;
    tally.contacts += contact ? 1.0 : 0.0;
    tally.found = max(tally.found, depth);
    vec3 aim = at;
#if MODE != DRAWN
    vec4 before = contact_before(address);
#if BOUND && FIELD
    vec3 surface = min(nearest.moved, 1.0) * head_displacement(at);
    vec4 before_turn = product(collide_params.head_turn_back, collide_params.head_rotation);
    surface += nearest.moved > 1.5 ? collide_params.part * rotate(before_turn, field_moved(at))
                                   : vec3(0.0);
#else
    vec3 surface = nearest.moved * head_displacement(at);
#endif
    vec3 slip = at - before.xyz - surface;
    aim -= before.w == collide_params.stamp_before
               ? held_back(slip, nearest.normal, max(depth, 0.0))
               : vec3(0.0);
#endif
    vec3 d = normalise_or(aim - p, nearest.normal);
    depth -= contact ? dot(p + l * d - at, nearest.normal) : 0.0;
    for (int round = 0; round < ROUNDS && contact && abs(depth) > EXACT * l; ++round) {
        d = turned(d, nearest.normal, depth, l);
        at = p + l * d;
        nearest = nearest_surface(at);
        depth = need - nearest.distance;
    }
    tally.left = max(tally.left, contact ? depth : 0.0);
#if MODE != DRAWN
    // A particle that was moved along with a pushed one may be just at the surface. Rounding must
    // not decide whether it flies into the surface.
    float rounding = EXACT * (l + max(abs(at.x), max(abs(at.y), abs(at.z))));
    v = contact || depth > -rounding
            ? velocity_after(v, surface / collide_params.dt, nearest.normal)
            : v;
#endif
}

void walk(Strand strand, float inside, bool touched)
{
    vec3 p = strand.root, p_before = p;
    float arc = 0.0;
    Tally tally = Tally(0.0, 0.0, 0.0);
    int last = touched ? n : 0;
    for (int j = 1; j < last; ++j) {
        int a = strand.first + j * STRAND_TILE;
        vec3 x = particle_before(a, p_before), link = x - p_before, at = x, v = vec3(0.0);
        float l = length(link);
#if MODE == PARTICLES
        vec4 velocity = velocity_before(a);
        v = velocity.xyz;
#endif
        if (p != p_before) {
            at = p + l * normalise_or(x - p, link / l);
        }
        arc += l;
        float need = j < int(collide_params.carried) ? -1e30 : needed(a, inside, arc);
        push_out(at, v, p, l, need, a, tally);
#if MODE == SEGMENTS
        segments[a] = at == x && p == p_before ? segment_before(a) : vec4((at - p) / l, l);
#else
        // where nothing is pushed, what relative.glsl stores stays
        positions[a] = at == x ? position_before(a) : vec4(at, 0.0);
#endif
#if MODE == PARTICLES
        velocities[a] = vec4(v, velocity.w);
#endif
#if MODE != DRAWN
        contacts[a] = vec4(at, collide_params.stamp);
#endif
        p_before = x;
        p = at;
    }
    int ends = touched ? 1 : 0;
    for (int end = 0; end < ends; ++end) {
#if MODE == SEGMENTS
        vec4 tip = tips[2 * strand.number], v = tips[2 * strand.number + 1];
        vec3 at = tip.xyz + (p - p_before);
        push_out(at, v.xyz, strand.root, length(at - strand.root), margin, strand.first, tally);
        tips[2 * strand.number] = vec4(at, tip.w);
        tips[2 * strand.number + 1] = v;
        contacts[strand.first] = vec4(at, collide_params.stamp);
#endif
#if MODE != DRAWN
        uvec4 count = counts[strand.number];
        count.zw = floatBitsToUint(max(uintBitsToFloat(count.zw), vec2(tally.found, tally.left)));
        if (tally.contacts > 0.0)
            count.xy = uvec2(uint(tally.contacts), uint(collide_params.stamp));
        counts[strand.number] = count;
#endif
    }
}

void main()
{
    int s = lane_index();
    n = int(collide_params.vertex_count);
    if (s >= int(collide_params.strand_count)) return;
    margin = collide_params.margin;
    friction = collide_params.friction;
    open_cones();
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
    bool touched = touches(strand, inside);
    walk(strand, inside, touched);
}
#endif
