// SPDX-License-Identifier: MIT
// Definitions for both C and GLSL. Blocks use only float, int, uint, vec4, uvec4 and mat4, which
// both languages lay out in the same way without explicit padding (tests/sim/test_hair.c,
// draw/test_renderer.c and sim/test_collision.c compare offsets with the driver's).
#ifdef __STDC__
#pragma once
#include <cglm/cglm.h>
#include <stdint.h>
typedef uint32_t uint;
typedef uint uvec4[4] __attribute__((aligned(16)));
#define UNIFORM_BLOCK(type, instance, at) typedef struct type
#define END_BLOCK(type, instance)         __attribute__((aligned(16))) type
#else
#define UNIFORM_BLOCK(type, instance, at) layout(std140, binding = at) uniform type
#define END_BLOCK(type, instance)         instance
#endif

// Strands are stored in tiles of this many (hair.h), so that neighbouring lanes access contiguous
// memory, and so do successive accesses of a lane.
#define STRAND_TILE 16

// Uniform blocks.
#define BIND_STEP     0
#define BIND_DRAW     1
#define BIND_MATERIAL 2
#define BIND_SOLVER   3 // a solver's own parameters

// Shader storage.
#define BIND_POSITION_OUT   0 // vec4 per particle: the drawn strand that a solver writes
#define BIND_STATE_OUT      1 // state of the solver
#define BIND_TIPS           2 // split: two vec4 per strand
#define BIND_SCRATCH        3 // scratch memory of the solver
#define BIND_CONTACTS       4 // collisions: vec4 per particle
#define BIND_CONTACT_COUNTS 5 // uvec4 per strand
#define BIND_CLEARANCE_OUT  6 // float per particle
#define BIND_CONTACT_FORCES 7 // vec4 per particle

// Buffer textures.
#define BIND_POSITION        0 // vec4 per particle
#define BIND_REST            1 // vec4 per particle: the style, see hair.h
#define BIND_STRAND_ID       2 // uint per strand
#define BIND_STATE           3 // state of the solver
#define BIND_COLLIDERS       4 // shapes that hair must not cross
#define BIND_FIELD           5 // distances to a mesh
#define BIND_CONTACTS_BEFORE 6
#define BIND_CLEARANCE       7 // float per particle: distance of the groom from colliders
#define BIND_ALONG                                                                                 \
    8 // two vec4 per vertex: parameters of a step that differ along the
      // strand
// Four vec4 per strand that is bound to a deforming mesh: the rotation (quaternion) and translation
// (xyz, m), within the head's frame, from the strand at rest to its place on the mesh, first before
// the step, then after it. inbetween.comp has two more for the frame that is drawn.
#define BIND_FRAMES                9
#define BIND_NATURAL               10 // rod: the natural shape, vec4 per particle, see rod_joint.glsl
#define BIND_SCRATCH_BEFORE        12
#define BIND_CONTACT_FORCES_BEFORE 13
#define BIND_HELD                  11 // rod: force that the groom holds, vec4 per particle
