// SPDX-License-Identifier: MIT
// What `rod` keeps for each particle between two sweeps, in scratch memory. (Strands of 32 vertices
// in registers take nine tenths of the time but compile for 14 s instead of 0.7 s on a CPU driver.)
// Needs particles.glsl, rod_front.glsl.
#define LAST int(step_params.vertex_count - 1u)
#include "sim/scratch.glsl"
const int PLACES = 7;
int keep_base;

void keep_open() { keep_base = scratch_base(PLACES, int(step_params.vertex_count)); }
int place(int j, int i) { return keep_base + (PLACES * j + i) * STRAND_TILE; }
void keep_move(int j, vec4 a) { scratch[place(j, 0)] = a; }
void keep_goal(int j, vec3 a) { scratch[place(j, 1)].xyz = a; }
void keep_turn(int j, Turn a)
{
    scratch[place(j, 2)] = vec4(a.U[0], a.v.x);
    scratch[place(j, 3)] = vec4(a.U[1], a.v.y);
    scratch[place(j, 4)] = vec4(a.U[2], a.v.z);
#if JOINTS
    scratch[place(j, 5)] = vec4(a.W[0], a.W[2].x);
    scratch[place(j, 6)] = vec4(a.W[1], a.W[2].y);
    scratch[place(j, 1)].w = a.W[2].z;
#endif
}
vec4 recall_move(int j) { return scratch_at(place(j, 0)); }
vec3 recall_goal(int j) { return scratch_at(place(j, 1)).xyz; }
Turn recall_turn(int j)
{
    vec4 a = scratch_at(place(j, 2)), b = scratch_at(place(j, 3)), c = scratch_at(place(j, 4));
    mat3 W = ZERO3;
#if JOINTS
    vec4 d = scratch_at(place(j, 5)), e = scratch_at(place(j, 6));
    W = mat3(d.xyz, e.xyz, vec3(d.w, e.w, scratch_at(place(j, 1)).w));
#endif
    return Turn(mat3(a.xyz, b.xyz, c.xyz), W, vec3(a.w, b.w, c.w));
}
