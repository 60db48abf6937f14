// SPDX-License-Identifier: MIT
// Read by C and by GLSL: what both sides must agree on. Blocks use only float, int, uint, vec4,
// uvec4 and mat4, which both lay out alike without padding by hand (tests/sim/test_hair.c,
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

// Strands lie in tiles of this many (hair.h): what neighbouring lanes touch is one piece of memory,
// and so is what a lane touches next.
#define STRAND_TILE 16

// Uniform blocks.
#define BIND_STEP     0
#define BIND_DRAW     1
#define BIND_MATERIAL 2
#define BIND_SOLVER   3 // a solver's own parameters

// Shader storage.
#define BIND_POSITION_OUT   0 // vec4 a particle: where a solver puts the strand that is drawn
#define BIND_STATE_OUT      1 // a solver's own state
#define BIND_TIPS           2 // split: two vec4 a strand
#define BIND_SCRATCH        3 // a solver's scratch memory
#define BIND_CONTACTS       4 // collisions: vec4 a particle
#define BIND_CONTACT_COUNTS 5 // uvec4 a strand
#define BIND_CLEARANCE_OUT  6 // float a particle

// Buffer textures.
#define BIND_POSITION        0 // vec4 a particle
#define BIND_REST            1 // vec4 a particle: the style, see hair.h
#define BIND_STRAND_ID       2 // uint a strand
#define BIND_STATE           3 // a solver's own state
#define BIND_COLLIDERS       4 // shapes that hair must not cross
#define BIND_FIELD           5 // distances to a mesh
#define BIND_CONTACTS_BEFORE 6
#define BIND_CLEARANCE       7 // float a particle: how far the groom is from colliders
#define BIND_ALONG           8 // two vec4 a vertex: what of a step differs along the strand
// Four vec4 a strand that is bound to a deforming mesh: the rotation (quaternion) and translation
// (xyz, m), within the head's frame, that take the strand at rest to where the mesh has it before
// the step; the same after it. In inbetween.comp two more, for the frame that is drawn.
#define BIND_FRAMES 9
