// SPDX-License-Identifier: MIT
// A step of `emulation`: every particle is pulled to its target, and both sides of the strand
// follow as tractrices. O(n^2).
//
//   1. Targets p of the particles: midpoint.glsl.
//   2. In a random order, which is the same for all strands and steps: pull particle i to p_i; the
//      strand follows on the tip's side and on the root's side. In the first pull every segment
//      follows in the frame of its own tail's target, which moves (as in hybrid.comp). The other
//      pulls then have little left to do, and their order hardly matters.
//   3. Pull the root to where the head carries it.
//   4. Velocities: projected on what the new shape allows, energy balanced (constrain.glsl).
//      Second order.
// THESIS: as published. The order is from root to tip, targets come from a kick alone, and v = (x
// - q)/dt + k (style - x) dt. This is unstable: hair without drag speeds up to 3 .. 14 m/s by
// itself.
//
// State of the pulls: unit directions d (from j - 1 to j) with lengths. A pull sums up on its way
// the position of the particle that is pulled next. A step of long strands takes several
// dispatches (step_params.phase), each with MOST_LINKS links to turn.
#include "sim/emulation_params.h"
#include "sim/particles.glsl"
#include "sim/keep.glsl"
#include "sim/strand.glsl"
#include "sim/shuffle.glsl"
#include "sim/tractrix.glsl"
#include "sim/tridiagonal.glsl"
#if !THESIS
#include "sim/midpoint.glsl"
#include "sim/constrain.glsl"
#endif

const uint MOST_LINKS = 40000u; // also in solver_emulation.c

vec4 link_at(Strand strand, int j, vec3 q, vec3 q_before)
{
    return vec4(direction(q - q_before), fetch_rest(strand, j).w);
}

// Computes the targets, and the links at the step's start. The root is at 0 (thesis: the new root).
#if THESIS
void predict(Strand strand)
{
    int last = int(step_params.vertex_count - 1u);
    vec3 q_before = strand.root_old, style = vec3(0.0);
    for (int j = 1; j <= last; ++j) {
        vec3 q = fetch_position(strand, j),
             p = (q - strand.root) + predicted_move(strand, j, q, style);
        keep(j, link_at(strand, j, q, q_before));
        keep_velocity(strand.address + j * STRAND_TILE, j, vec4(p, 0.0));
        q_before = q;
    }
    keep(0, vec4(strand.root_old - strand.root, 0.0));
}

vec3 aim_of(Strand strand, int j)
{
    return recall_velocity(strand.address + j * STRAND_TILE, j).xyz;
}
#else
void predict(Strand strand)
{
    Middle middle = middle_open(strand);
    vec3 q = fetch_position(strand, LAST);
    for (int j = LAST; j >= 1; --j) {
        vec3 q_before = j == 1 ? strand.root_old : fetch_position(strand, j - 1);
        middle_place(middle, strand, j, q);
        keep(j, link_at(strand, j, q, q_before));
        q = q_before;
    }
    keep(0, vec4(vec3(0.0), middle.gained));
}

vec3 aim_of(Strand strand, int j)
{
    return j == 0 ? vec3(0.0) : recall_aim(strand.address + j * STRAND_TILE, j);
}

// Pulls particle i to its target; the others follow in the frames of their own targets. Returns the
// position of particle `next` afterwards, like pull.
vec3 pull_along(Strand strand, int i, int next)
{
    int last = int(step_params.vertex_count - 1u);
    vec3 target = aim_of(strand, i), at = target, x = target;
    for (int j = i + 1; j <= last; ++j) {
        vec4 link = recall(j);
        vec3 move = limit_move(x + link.w * link.xyz - aim_of(strand, j));
        vec3 d = tractrix_turn(link.xyz, link.w, move);
        keep(j, vec4(d, link.w));
        x += link.w * d;
        at = j <= next ? x : at;
    }
    x = target;
    for (int j = i; j >= 1; --j) {
        vec4 link = recall(j);
        vec3 move = limit_move(x - link.w * link.xyz - aim_of(strand, j - 1));
        vec3 d = -tractrix_turn(-link.xyz, link.w, move);
        keep(j, vec4(d, link.w));
        x -= link.w * d;
        at = j > next ? x : at;
    }
    return at;
}
#endif

// Pulls particle i, now at x, to its target. Returns the position of particle `next` afterwards.
vec3 pull(Strand strand, int i, int next, vec3 x)
{
    int last = int(step_params.vertex_count - 1u);
    vec3 target = aim_of(strand, i), at = target;
    vec3 move = limit_move(target - x);
    for (int j = i + 1; j <= last; ++j) {
        vec4 link = recall(j);
        vec3 d = tractrix_turn(link.xyz, link.w, move);
        keep(j, vec4(d, link.w));
        at += (j <= next ? link.w : 0.0) * d;
    }
    move = limit_move(target - x);
    for (int j = i; j >= 1; --j) {
        vec4 link = recall(j);
        vec3 d = -tractrix_turn(-link.xyz, link.w, move);
        keep(j, vec4(d, link.w));
        at -= (j > next ? link.w : 0.0) * d;
    }
    return at;
}

// The next particle in the order, before place `end`; 0 if there is none.
int next_mover(inout Shuffle order, uint end)
{
#if THESIS
    return order.at < min(end, order.count) ? int(++order.at) : 0;
#else
    return shuffle_next(order, end) + 1;
#endif
}

// Does the moves of this phase and returns whether they were the last. Entry 0 stores the root's
// position so far and the energy gained in the step's middle.
bool pull_all(Strand strand)
{
    uint count = step_params.vertex_count - 1u, phase = step_params.phase;
    uint most = IN_REGISTERS == 1 ? 2u * count : MOST_LINKS / count, start = phase * most;
    Shuffle order = shuffle_open(emulation_params.order_seed, count, start);
    if (start >= order.size) return false; // this strand needs fewer phases than the longest
    uint end = min(start + most, order.size);
    Shuffle counted = order;
    int moves = 0;
    while (next_mover(counted, end) > 0) ++moves;
    int i = next_mover(order, end);
    vec4 root = recall(0);
    vec3 x = root.xyz;
    for (int j = 1; j <= i; ++j) {
        vec4 link = recall(j);
        x += link.w * link.xyz;
    }
#if !THESIS
    if (phase == 0u) {
        int next = next_mover(order, end);
        x = pull_along(strand, i, next);
        i = next, --moves;
    }
#endif
    for (int k = 0; k < moves; ++k) {
        int next = next_mover(order, end);
        x = pull(strand, i, next, x);
        i = next;
    }
    keep(0, vec4(x, root.w));
    return end == order.size;
}

// Pulls the root back to the head.
vec3 home(inout vec3 move, int j)
{
    vec4 link = recall(j);
    return tractrix_renormalise(tractrix_turn(tractrix_renormalise(link.xyz), link.w, move));
}

void finish(Strand strand)
{
    int last = int(step_params.vertex_count - 1u);
    vec4 root = recall(0);
    vec3 move = limit_move(-root.xyz), x = vec3(0.0);
#if THESIS
    vec3 style = vec3(0.0);
    velocities[strand.address] = vec4(strand.root_velocity, 0.0);
    positions[strand.address] = vec4(strand.root, 1.0);
    for (int j = 1; j <= last; ++j) {
        int a = strand.address + j * STRAND_TILE;
        vec4 r = fetch_rest(strand, j);
        vec3 q = fetch_position(strand, j);
        x += r.w * home(move, j);
        style = next_style(style, r, strand.rotation);
        velocities[a] = vec4((x - (q - strand.root)) / strand.dt +
                                 strand.spring.stiffness * strand.dt * (style - x),
                             0.0);
        positions[a] = vec4(strand.root + x, 1.0);
    }
#else
    Constraint constraint = constrain_open(strand);
    for (int j = 1; j <= last; ++j) {
        vec3 d = home(move, j);
        x += fetch_rest(strand, j).w * d;
        constrain_add(constraint, strand, j, d, x);
    }
    constrain_finish(constraint, strand, root.w);
#endif
}

void main()
{
    int s = first_strand();
    if (s >= int(step_params.strand_count)) return;
    keep_open(s);
    Strand strand = strand_open(s, emulation_params.spring);
    if (step_params.phase == 0u) predict(strand);
    if (pull_all(strand)) finish(strand);
}
