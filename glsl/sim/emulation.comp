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
#define FIRST_KEPT 1
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

// The root's position so far (xyz) and the energy gained in the step's middle (w).
#if IN_REGISTERS
vec4 kept_root;
#else
#define kept_root scratch[keep_base]
#endif

vec4 link_at(Strand strand, int j, vec3 q, vec3 q_before)
{
    return vec4(direction(q - q_before), fetch_rest(strand, j).w);
}

// Computes the targets, and the links at the step's start. The root is at 0 (thesis: the new root).
#if THESIS
void predict(Strand strand)
{
    vec3 q_before = vec3(0.0), style = vec3(0.0);
    for (int k = 0; k < LAST; ++k) {
        int j = k + 1;
        vec3 q = fetch_position(strand, j), p = q + predicted_move(strand, j, q, style);
        keep(j, link_at(strand, j, q, q_before));
        keep_velocity(strand.address + j * STRAND_TILE, j, vec4(p, 0.0));
        q_before = q;
    }
    kept_root = vec4(-strand.moved, 0.0);
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
        vec3 q_before = j == 1 ? vec3(0.0) : fetch_position(strand, j - 1);
        middle_place(middle, strand, j, q);
        keep(j, link_at(strand, j, q, q_before));
        q = q_before;
    }
    kept_root = vec4(vec3(0.0), middle.gained);
}

vec3 aim_of(Strand strand, int j)
{
    return j == 0 ? vec3(0.0) : recall_aim(strand.address + j * STRAND_TILE, j);
}
#endif

// Where the sweeps of a pull of particle i begin. Sweeps over registers visit all links.
#if IN_REGISTERS
#define FIRST_BEYOND(i) 0
#define FIRST_BEFORE(i) LAST
#else
#define FIRST_BEYOND(i) (i)
#define FIRST_BEFORE(i) (i)
#endif

// The target of particle i, which only the order of pulls knows. To read an array in registers at
// such a place would take llvmpipe three seconds more to compile.
vec3 target_of(Strand strand, int i)
{
#if IN_REGISTERS
    vec3 target = vec3(0.0);
    for (int k = 0; k < LAST; ++k) target = k + 1 == i ? aim_of(strand, k + 1) : target;
    return target;
#else
    return aim_of(strand, i);
#endif
}

#if !THESIS
// Pulls particle i to its target; the others follow in the frames of their own targets. Returns the
// position of particle `next` afterwards, like pull.
vec3 pull_along(Strand strand, vec3 target, int i, int next)
{
    vec3 at = target, x = target;
    for (int k = FIRST_BEYOND(i); k < LAST; ++k) {
        int j = k + 1;
        vec4 link = recall(j);
        vec3 move = limit_move(x + link.w * link.xyz - aim_of(strand, j));
        vec3 d = tractrix_turn(link.xyz, link.w, move, j > i);
        keep(j, vec4(d, link.w));
        x += (j > i ? link.w : 0.0) * d;
        at = j <= next ? x : at;
    }
    x = target;
    for (int j = FIRST_BEFORE(i); j >= 1; --j) {
        vec4 link = recall(j);
        vec3 move = limit_move(x - link.w * link.xyz - aim_of(strand, j - 1));
        vec3 d = -tractrix_turn(-link.xyz, link.w, move, j <= i);
        keep(j, vec4(d, link.w));
        x -= (j <= i ? link.w : 0.0) * d;
        at = j > next && j <= i ? x : at;
    }
    return at;
}
#endif

// Turns link j, on the tip's side of particle i, which is pulled. `at` becomes the position of
// particle `next` when the sweep has passed it.
void turn_beyond(int j, int i, int next, inout vec3 move, inout vec3 at)
{
    vec4 link = recall(j);
    vec3 d = tractrix_turn(link.xyz, link.w, move, j > i);
    keep(j, vec4(d, link.w));
    at += (j > i && j <= next ? link.w : 0.0) * d;
}

// The same on the root's side.
void turn_before(int j, int i, int next, inout vec3 move, inout vec3 at)
{
    vec4 link = recall(j);
    vec3 d = -tractrix_turn(-link.xyz, link.w, move, j <= i);
    keep(j, vec4(d, link.w));
    at -= (j > next && j <= i ? link.w : 0.0) * d;
}

// Pulls particle i, now at x, to its target. Returns the position of particle `next` afterwards.
// In registers the two sides take turns, so that a processor computes them at the same time.
vec3 pull(vec3 target, int i, int next, vec3 x)
{
    vec3 at = target;
    vec3 move = limit_move(target - x), move_before = move;
    for (int k = FIRST_BEYOND(i); k < LAST; ++k) {
        turn_beyond(k + 1, i, next, move, at);
#if IN_REGISTERS
        turn_before(LAST - k, i, next, move_before, at);
    }
#else
    }
    for (int j = i; j >= 1; --j) turn_before(j, i, next, move_before, at);
#endif
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

// Does the moves of this phase and returns whether they were the last.
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
    vec3 x = kept_root.xyz, target = target_of(strand, i);
    for (int k = 0; k < FIRST_BEFORE(i); ++k) {
        vec4 link = recall(k + 1);
        x += (k < i ? link.w : 0.0) * link.xyz;
    }
#if !THESIS
    if (phase == 0u) {
        int next = next_mover(order, end);
        x = pull_along(strand, target, i, next);
        target = target_of(strand, next);
        i = next, --moves;
    }
#endif
    for (int k = 0; k < moves; ++k) {
        int next = next_mover(order, end);
        vec3 next_target = target_of(strand, next);
        x = pull(target, i, next, x);
        target = next_target, i = next;
    }
    kept_root.xyz = x;
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
    vec3 move = limit_move(-kept_root.xyz), x = vec3(0.0);
#if THESIS
    vec3 style = vec3(0.0);
    velocities[strand.address] = vec4(strand.root_velocity, 0.0);
    store_root(strand);
    for (int k = 0; k < LAST; ++k) {
        int j = k + 1, a = strand.address + j * STRAND_TILE;
        vec4 r = fetch_rest(strand, j);
        vec3 q = fetch_position(strand, j);
        x += r.w * home(move, j);
        style = next_style(style, r, strand.rotation);
        velocities[a] = vec4((x - q + strand.moved) / strand.dt +
                                 strand.spring.stiffness * strand.dt * (style - x),
                             0.0);
        store_position(strand, a, x);
    }
#else
    Constraint constraint = constrain_open(strand);
    for (int k = 0; k < LAST; ++k) {
        int j = k + 1;
        vec3 d = home(move, j);
        x += fetch_rest(strand, j).w * d;
        constrain_add(constraint, strand, j, d, x);
    }
    constrain_finish(constraint, strand, kept_root.w);
#endif
}

void step_strand(int s)
{
    Strand strand = strand_open(s, emulation_params.spring);
    if (step_params.phase == 0u) predict(strand);
    if (pull_all(strand)) finish(strand);
}
#include "sim/each_strand.glsl"
