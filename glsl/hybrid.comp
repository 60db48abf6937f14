// SPDX-License-Identifier: MIT
// A step of `hybrid`: tractrices as the length constraint, in two passes instead of the emulation's n.
//
//   1. predict every particle (kick, style spring)
//   2. tip to root: every segment follows its tip's new place as a tractrix, seen from its root end's own prediction, which moves along
//   3. root to tip: the root is pulled home, the strand follows
//   4. velocities: the kicked ones, projected on what the new shape allows (project.glsl)
#include "particles.glsl"
#include "keep.glsl"
#include "lane.glsl"
#include "tractrix.glsl"
#include "tridiagonal.glsl"
#include "project.glsl"

// Root to tip, where there is a style: the predicted moves, for the way back.
void predict(Lane lane)
{
    int last = LAST;
    vec3 style = vec3(0.0);
    for (int j = 1; j <= last; ++j) keep(j, vec4(predicted_move(lane, j, fetch_position(lane, j), style), 0.0));
}

vec3 move_of(Lane lane, int j, vec3 q)
{
    if (j == 0) return vec3(0.0);
#if STYLED
    return recall(j).xyz;
#else
    vec3 style = vec3(0.0);
    return predicted_move(lane, j, q, style);
#endif
}

// Tip to root. Keeps the segments' directions; gives where the root ends, relative to where it must go.
vec3 pull_tip(Lane lane)
{
    vec3 q = fetch_position(lane, LAST), move = move_of(lane, LAST, q), y = (q - lane.root) + move;
    for (int j = LAST; j >= 1; --j) {
        vec3 q_before = j == 1 ? lane.root_old : fetch_position(lane, j - 1);
        vec3 move_before = move_of(lane, j - 1, q_before), rest_move = limit_move(y - (q - lane.root) - move_before);
        float l = fetch_rest(lane, j).w;
        vec3 d = tractrix_turn(direction(q_before - q), l, rest_move);
        y += l * d;
        keep(j, vec4(-d, 0.0));
        q = q_before;
    }
    return y;
}

void pull_root(Lane lane, vec3 move)
{
    int last = LAST;
    vec3 x = vec3(0.0), style = vec3(0.0);
    Projection projection = project_open(lane);
    for (int j = 1; j <= last; ++j) {
        float l = fetch_rest(lane, j).w;
        vec3 q = fetch_position(lane, j), d = tractrix_renormalise(recall(j).xyz);
        d = tractrix_renormalise(tractrix_turn(d, l, move));
        x += l * d;
        project_add(projection, lane, j, d, x, q, predicted_move(lane, j, q, style));
    }
}

void main()
{
    int s = first_strand();
    if (s >= int(step_params.strand_count)) return;
    keep_open(s);
    Lane lane = lane_open(s);
#if STYLED
    predict(lane);
#endif
    vec3 root_off = pull_tip(lane);
    pull_root(lane, limit_move(-root_off));
    project_finish(lane);
}
