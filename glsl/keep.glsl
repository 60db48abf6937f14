// SPDX-License-Identifier: MIT
// What a solver keeps of each particle between two sweeps along the strand: a vec4, and a number beside it. In registers where the
// strand is short enough for that (loops over a constant count unroll), else in scratch memory (needs particles.glsl,
// recipe.scratch = 2).

#if IN_REGISTERS
#define LAST (VERTICES - 1)
vec4 kept[VERTICES];
float kept_beside[VERTICES];

void keep_open(int strand) {}
void keep(int j, vec4 a) { kept[j] = a; }
void keep_beside(int j, float b) { kept_beside[j] = b; }
vec4 recall(int j) { return kept[j]; }
float recall_beside(int j) { return kept_beside[j]; }
#else
#define LAST int(step_params.vertex_count - 1u)
layout(std430, binding = BIND_SCRATCH) buffer Scratch { vec4 scratch[]; };
int keep_base;

void keep_open(int strand) { keep_base = particle_address(strand, 0, 2 * int(step_params.vertex_count)); }
void keep(int j, vec4 a) { scratch[keep_base + 2 * j * STRAND_TILE] = a; }
void keep_beside(int j, float b) { scratch[keep_base + (2 * j + 1) * STRAND_TILE].x = b; }
vec4 recall(int j) { return scratch[keep_base + 2 * j * STRAND_TILE]; }
float recall_beside(int j) { return scratch[keep_base + (2 * j + 1) * STRAND_TILE].x; }
#endif
