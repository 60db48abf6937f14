// SPDX-License-Identifier: MIT
// What a solver of particles keeps of each particle between two sweeps along the strand: a vec4 and
// a number beside it, and in some also where it wants to go (aim) and how fast. In registers where
// the strand is short enough for that (loops over a constant count unroll), else in scratch memory
// (needs particles.glsl, recipe.scratch = 2).
//
// Outside of registers, aims lie in the places that the step will write at its end: once a
// particle's is kept there, position_before and velocity_before no longer give that particle as it
// was at the step's start.

#if IN_REGISTERS
#define LAST (VERTICES - 1)
vec4 kept[VERTICES];
float kept_beside[VERTICES];
vec3 kept_aim[VERTICES];
vec4 kept_velocity[VERTICES];

// `address` is particle j's.
void keep_open(int strand) {}
void keep(int j, vec4 a) { kept[j] = a; }
void keep_beside(int j, float b) { kept_beside[j] = b; }
void keep_aim(int address, int j, vec3 a) { kept_aim[j] = a; }
void keep_velocity(int address, int j, vec4 v) { kept_velocity[j] = v; }
vec4 recall(int j) { return kept[j]; }
float recall_beside(int j) { return kept_beside[j]; }
vec3 recall_aim(int address, int j) { return kept_aim[j]; }
vec4 recall_velocity(int address, int j) { return kept_velocity[j]; }
#else
#define LAST int(step_params.vertex_count - 1u)
layout(std430, binding = BIND_SCRATCH) buffer Scratch { vec4 scratch[]; };
int keep_base;

void keep_open(int strand)
{
    keep_base = particle_address(strand, 0, 2 * int(step_params.vertex_count));
}
void keep(int j, vec4 a) { scratch[keep_base + 2 * j * STRAND_TILE] = a; }
void keep_beside(int j, float b) { scratch[keep_base + (2 * j + 1) * STRAND_TILE].x = b; }
void keep_aim(int address, int j, vec3 a) { positions[address] = vec4(a, 1.0); }
void keep_velocity(int address, int j, vec4 v) { velocities[address] = v; }
vec4 recall(int j) { return scratch[keep_base + 2 * j * STRAND_TILE]; }
float recall_beside(int j) { return scratch[keep_base + (2 * j + 1) * STRAND_TILE].x; }
vec3 recall_aim(int address, int j) { return positions[address].xyz; }
vec4 recall_velocity(int address, int j) { return velocities[address]; }
#endif
