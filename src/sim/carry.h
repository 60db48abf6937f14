// SPDX-License-Identifier: MIT
// Moves the hair as one rigid body, whatever its solver: when the head jumps, and when it moves
// from the first instant on.
#pragma once

#include "gpu/shader.h"
#include "sim/solver.h"

// x' = R x + translation, v' = R v + velocity + spin x x'.
typedef struct CarryMotion {
    versor rotation;  // unit quaternion x y z w of R
    vec3 translation; // m
    vec3 velocity;    // m/s, of the origin
    vec3 spin;        // rad/s
} CarryMotion;

// A zeroed one may be destroyed.
typedef struct Carry {
    GLuint program;
    GpuBuffer uniforms;
} Carry;

// Errors of shader_build_compute.
Result carry_create(Carry *carry, Error *error);
void carry_destroy(Carry *carry);

// Changes the state of `solver`, which holds `hair` and has posed. Only queues GPU work.
void carry_apply(Carry *carry, const Solver *solver, const Hair *hair, const CarryMotion *motion);

// The rigid motion that takes hair at rest on the head at `from` to hair at rest on it at `to`.
CarryMotion carry_between(const HeadPose *from, const HeadPose *to);
