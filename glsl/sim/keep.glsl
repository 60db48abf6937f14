// SPDX-License-Identifier: MIT
// Storage for each particle between two sweeps along the strand: a vec4 and a number, and in some
// solvers also the target position (aim) and velocity. It is in registers if the strand is short
// enough (loops over a constant count are unrolled), otherwise in scratch memory (needs
// particles.glsl, recipe.scratch = 2).
//
// In scratch memory, aims are stored where the step will write its results. Once a particle's aim
// is stored, position_before and velocity_before no longer return the particle's state at the
// step's start.

#if IN_REGISTERS
#define LAST (VERTICES - 1)
vec4 kept[VERTICES];
float kept_beside[VERTICES];
vec3 kept_aim[VERTICES];
vec4 kept_velocity[VERTICES];

// `address` is the address of particle j.
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
