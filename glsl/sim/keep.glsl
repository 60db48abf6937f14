// SPDX-License-Identifier: MIT
// Storage for each particle between two sweeps along the strand: a vec4 and a number, and in some
// solvers also the target position (aim) and velocity. It is in registers if the strand is short
// enough, otherwise in scratch memory (needs particles.glsl, recipe.scratch = 2). FIRST_KEPT: the
// first particle that is kept, 0 or 1.
//
// Registers need loops that the compiler unrolls. Mesa unrolls a long body only if the loop's
// counter, or the counter plus its step, indexes an array with as many entries as the loop has
// turns. So the arrays have no entry for a root that is not kept, sweeps towards the tip count from
// 0 (`k`, j = k + 1), and sweeps towards the root count j from LAST to 1. In a loop that is not
// unrolled, llvmpipe reads and writes an array one lane at a time (docs/notes/solvers.md).
//
// In scratch memory, aims are stored where the step will write its results. Once a particle's aim
// is stored, position_before and velocity_before no longer return the particle's state at the
// step's start.

#ifndef FIRST_KEPT
#define FIRST_KEPT 0
#endif

#if IN_REGISTERS
#define LAST (VERTICES - 1)
const int ENTRIES = VERTICES - FIRST_KEPT;
vec4 kept[ENTRIES];
float kept_beside[ENTRIES];
vec3 kept_aim[ENTRIES];
vec4 kept_velocity[ENTRIES];

// `address` is the address of particle j.
void keep_open() {}
void keep(int j, vec4 a) { kept[j - FIRST_KEPT] = a; }
void keep_beside(int j, float b) { kept_beside[j - FIRST_KEPT] = b; }
void keep_aim(int address, int j, vec3 a) { kept_aim[j - FIRST_KEPT] = a; }
void keep_velocity(int address, int j, vec4 v) { kept_velocity[j - FIRST_KEPT] = v; }
vec4 recall(int j) { return kept[j - FIRST_KEPT]; }
float recall_beside(int j) { return kept_beside[j - FIRST_KEPT]; }
vec3 recall_aim(int address, int j) { return kept_aim[j - FIRST_KEPT]; }
vec4 recall_velocity(int address, int j) { return kept_velocity[j - FIRST_KEPT]; }
#else
#define LAST int(step_params.vertex_count - 1u)
#include "sim/scratch.glsl"
int keep_base;

void keep_open() { keep_base = scratch_base(2, int(step_params.vertex_count)); }
void keep(int j, vec4 a) { scratch[keep_base + 2 * j * STRAND_TILE] = a; }
void keep_beside(int j, float b) { scratch[keep_base + (2 * j + 1) * STRAND_TILE].x = b; }
void keep_aim(int address, int j, vec3 a) { positions[address] = vec4(a, 1.0); }
void keep_velocity(int address, int j, vec4 v) { velocities[address] = v; }
vec4 recall(int j) { return scratch_at(keep_base + 2 * j * STRAND_TILE); }
float recall_beside(int j) { return scratch_at(keep_base + (2 * j + 1) * STRAND_TILE).x; }
vec3 recall_aim(int address, int j) { return position_before(address).xyz; }
vec4 recall_velocity(int address, int j) { return velocity_before(address); }
#endif
