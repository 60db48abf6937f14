// SPDX-License-Identifier: MIT
// A step of `hybrid`: tractrices as the length constraint, in two passes instead of the n pulls of
// `emulation`. Second order.
//
//   1. Targets p of the particles: midpoint.glsl.
//   2. Tip to root: every segment follows its tip's new place as a tractrix, in the frame of its
//      root end's target, which moves.
//   3. Root to tip: the root is pulled home, and the strand follows.
//   4. Velocities: projected on what the new shape allows, energy balanced (constrain.glsl).
//
// The tractrices keep long steps calm: with the directions of p alone, or with one pass, the
// energy of loose strands rises without end.
#include "sim/hybrid_params.h"
#include "sim/particles.glsl"
#define FIRST_KEPT 1
#include "sim/keep.glsl"
#include "sim/strand.glsl"
#include "sim/tractrix.glsl"
#include "sim/tridiagonal.glsl"
#include "sim/midpoint.glsl"
#include "sim/constrain.glsl"

// From tip to root: stores the segments' directions. Returns where the root ends, relative to where
// it must be.
vec3 pull_tip(Strand strand, inout Middle middle)
{
    vec3 q = fetch_position(strand, LAST), y = middle_place(middle, strand, LAST, q);
    for (int j = LAST; j >= 1; --j) {
        vec3 q_before = j == 1 ? vec3(0.0) : fetch_position(strand, j - 1);
        vec3 move = limit_move(y - q - strand.dt * middle.w);
        float l = fetch_rest(strand, j).w;
        vec3 d = tractrix_turn(direction(q_before - q), l, move);
        y += l * d;
        keep(j, vec4(-d, 0.0));
        if (j > 1) middle_place(middle, strand, j - 1, q_before);
        q = q_before;
    }
    return y;
}

void pull_root(inout Constraint constraint, Strand strand, vec3 move)
{
    int last = LAST;
    vec3 x = vec3(0.0);
    for (int k = 0; k < last; ++k) {
        int j = k + 1;
        float l = fetch_rest(strand, j).w;
        vec3 d = tractrix_renormalise(recall(j).xyz);
        d = tractrix_renormalise(tractrix_turn(d, l, move));
        x += l * d;
        constrain_add(constraint, strand, j, d, x);
    }
}

void step_strand(int s)
{
    Strand strand = strand_open(s, hybrid_params.spring);
    Middle middle = middle_open(strand);
    vec3 root_off = pull_tip(strand, middle);
    Constraint constraint = constrain_open(strand);
    pull_root(constraint, strand, limit_move(-root_off));
    constrain_finish(constraint, strand, middle.gained);
}
#include "sim/each_strand.glsl"
