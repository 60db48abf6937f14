// SPDX-License-Identifier: MIT
// What the passes of a section's volume are given (sim/volume.h).
#include "common/shared.h"

// Shader storage.
#define BIND_VOLUME_SUMS_OUT    3 // int: VOLUME_SUMS a cell
#define BIND_VOLUME_CELLS_OUT   4 // vec4 a cell
#define BIND_VOLUME_FACES_OUT   5 // vec2 a cell
#define BIND_VOLUME_CHANGES_OUT 6 // vec4 a cell
#define BIND_VOLUME_DENSE_OUT   7 // uint: 1 if any cell is denser than at rest

// Buffer textures.
#define BIND_VOLUME_SUMS    4
#define BIND_VOLUME_CELLS   5  // xyz: mean velocity (m/s), w: particles; before any change
#define BIND_VOLUME_CELLS_2 6  // the same as changed so far
#define BIND_VOLUME_FACES   7  // restitution + 1 of a dense cell, share of friction
#define BIND_VOLUME_CHANGES 8  // xyz: change of velocity, with friction's part; w: friction's share
#define BIND_VOLUME_REST    9  // uint a particle: density about it at rest; of a grain, its first's
#define BIND_VOLUME_OWN     10 // uint a cell: the groom's own density

// Cells of a lane: most are empty, and a lane costs as much as a few of those.
#define VOLUME_CELLS_A_LANE 32

// Sums of a cell: particles, their densities at rest, their velocities.
#define VOLUME_SUMS 5
// Velocities are summed in steps of so much (m/s); what is faster than so much takes no part, nor
// does a cell of more particles: its sums could exceed an int.
#define VOLUME_STEPS   1024.0
#define VOLUME_FASTEST 32.0
#define VOLUME_MOST    65535
// The most that a particle's density at rest counts for.
#define VOLUME_MOST_REST 32767

UNIFORM_BLOCK(VolumeParams, volume_params, BIND_STEP)
{
    vec4 axis[3];       // a place's cell along an axis: dot(xyz, place in the world) + w
    vec4 head_velocity; // xyz, m/s, of the middle of the hair if it were stiff
    uvec4 size;         // xyz: cells; those at the edge stay empty
    float spacing;      // m, of the cells
    float strength;     // --volume
    float apart;        // m/s: as fast as this, cells leave one that is dense
    float friction;     // share of a particle's velocity in its cell that a step takes away
    uint strand_count;
    uint cell_count;
    uint vertex_count;
    uint carried; // vertices, from the root, that the head carries
}
END_BLOCK(VolumeParams, volume_params);
