// SPDX-License-Identifier: MIT
// A step of `emulation`: every particle is pulled to where it wants to go, and both sides of the strand follow as tractrices. O(n^2).
//
//   1. predict every particle (kick, style spring)
//   2. in a random order, the same for all strands, new in every step: pull particle i to its prediction, tip's side and root's side follow
//   3. pull the root to where the head carries it
//   4. velocities: the kicked ones, projected on what the new shape allows (project.glsl)
// THESIS: order from root to tip, no implicit spring, and as published v = (x - q)/dt + k (style - x) dt. That is unstable: hair without
// drag speeds up to 3 .. 14 m/s by itself.
//
// State of the pulls: unit directions d (j - 1 to j) with lengths, in shared memory where it suffices (nothing is shared: it is the memory
// that can be addressed fastest). Where the particle that is pulled next has come to is summed up on the way.
#include "particles.glsl"
#include "lane.glsl"
#include "shuffle.glsl"
#include "tractrix.glsl"
#include "tridiagonal.glsl"

#define EXPLICIT_STIFFNESS step_params.own[0].y // thesis: k, 1/s^2
#define SHUFFLE            step_params.passes

#if IN_REGISTERS
#define LAST (VERTICES - 1)
shared vec4 kept[VERTICES * GROUP_SIZE];

void keep_open(int strand) {}
void keep(int j, vec4 a) { kept[j * GROUP_SIZE + int(gl_LocalInvocationID.x)] = a; }
vec4 recall(int j) { return kept[j * GROUP_SIZE + int(gl_LocalInvocationID.x)]; }
#else
#define LAST int(step_params.vertex_count - 1u)
layout(std430, binding = BIND_SCRATCH) buffer Scratch { vec4 scratch[]; };
int keep_base;

void keep_open(int strand) { keep_base = particle_address(strand, 0, int(step_params.vertex_count)); }
void keep(int j, vec4 a) { scratch[keep_base + j * STRAND_TILE] = a; }
vec4 recall(int j) { return scratch[keep_base + j * STRAND_TILE]; }
#endif
#include "project.glsl"

// Root to tip: predictions, relative to the new root, lie where velocities will; directions are kept.
void predict(Lane lane)
{
    int last = int(step_params.vertex_count - 1u);
    vec3 q_before = lane.root_old, style = vec3(0.0);
    for (int j = 1; j <= last; ++j) {
        vec3 q = fetch_position(lane, j), p = (q - lane.root) + predicted_move(lane, j, q, style);
        keep(j, vec4(direction(q - q_before), fetch_rest(lane, j).w));
        velocities[lane.address + j * STRAND_TILE] = vec4(p, 0.0);
        q_before = q;
    }
}

// Pulls particle i, now at x, to its prediction. Gives where particle `next` is then.
vec3 pull(Lane lane, int i, int next, vec3 x)
{
    int last = int(step_params.vertex_count - 1u);
    vec3 target = velocities[lane.address + i * STRAND_TILE].xyz, at = target;
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

// In the order of the moves; gives where the root ends.
vec3 pull_all(Lane lane)
{
    int count = int(step_params.vertex_count - 1u);
#if THESIS
    int i = 1;
#else
    Shuffle order = shuffle_open(SHUFFLE, uint(count));
    int i = 1 + int(shuffle_next(order));
#endif
    vec3 x = fetch_position(lane, i) - lane.root;
    for (int k = 1; k <= count; ++k) {
#if THESIS
        int next = k == count ? 0 : i + 1;
#else
        int next = 1 + int(shuffle_next(order));
        if (k == count) next = 0;
#endif
        x = pull(lane, i, next, x);
        i = next;
    }
    return x;
}

void pull_root(Lane lane, vec3 move)
{
    int last = int(step_params.vertex_count - 1u);
    vec3 x = vec3(0.0), style = vec3(0.0);
    Projection projection = project_open(lane);
    for (int j = 1; j <= last; ++j) {
        vec4 link = recall(j);
        int a = lane.address + j * STRAND_TILE;
        vec3 q = fetch_position(lane, j), wanted = velocities[a].xyz - (q - lane.root);
        vec3 d = tractrix_renormalise(tractrix_turn(tractrix_renormalise(link.xyz), link.w, move));
        x += link.w * d;
#if THESIS
        style = next_style(style, fetch_rest(lane, j), lane.rotation);
        velocities[a] = vec4((x - (q - lane.root)) / lane.dt + EXPLICIT_STIFFNESS * lane.dt * (style - x), 0.0);
        positions[a] = vec4(lane.root + x, 1.0);
#else
        project_add(projection, lane, j, d, x, q, wanted);
#endif
    }
}

void main()
{
    int s = first_strand();
    if (s >= int(step_params.strand_count)) return;
    keep_open(s);
    Lane lane = lane_open(s);
    predict(lane);
    vec3 root_off = pull_all(lane);
    pull_root(lane, limit_move(-root_off));
#if !THESIS
    project_finish(lane);
#endif
}
