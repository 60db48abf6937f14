// SPDX-License-Identifier: MIT
// Volume: hair that is denser than it was at rest gets no denser, and its strands slow each other
// down.
//
// After each step the particles of a section are summed up in the cells of a grid that moves with
// the head: how many, and their velocities. A cell is dense if it has more of them than its own
// groom had there, and more than those which are in it now had about them at rest. So a groom at
// rest feels nothing, with cells of any size. What approaches a dense cell is stopped, or
// bounces back the more the denser it is, and leaves it at a speed of a few cells a second
// (volume_push.comp); velocities within it are mixed. All of it keeps momentum; only the leaving
// can add kinetic energy, at a bounded speed. Particles outside the grid, those that the head
// carries and followers take no part. Each section has a grid of its own.
//
// After Petrovic, Henne and Anderson 2005, Volumetric methods for simulation and rendering of hair
// (density and velocity on a grid, friction), and McAdams et al. 2009, Detail preserving continuum
// simulation of straight hair (particles take changes of the grid's velocities). Impulses between
// cells stand in for their repulsion and pressure: no equations are solved.
#pragma once

#include "gpu/gpu_timer.h"
#include "sim/solver.h"
#include "sim/step.h"

#include "glsl/sim/volume_params.h"

// A zeroed struct is a pass that does nothing.
typedef struct Volume {
    const Hair *hair; // NULL: none
    const Solver *solver;
    GpuTimer *timer;
    float strength;
    float low[3]; // of the grid, in the head's frame (m)
    float middle[3];
    uint32_t cell_count;
    uint32_t grain; // see volume.glsl
    VolumeParams step;
    bool segments;
    StepPass splat, cells, push[2], apply;
    GpuBuffer sums, own, faces, changes, dense;
    GpuBuffer velocities[3]; // at first, and two that take turns
    GpuBuffer *rest;         // [hair->batch_count]: uint a particle, its density at rest
} Volume;

// Empty with params->volume 0 or a solver that steps nothing. The hair stands in its style, the
// head at the origin, as hair_create leaves it. RESULT_FAILED when memory is short; errors of
// shader_build_compute and of buffers.
Result volume_create(Volume *volume, const Gpu *gpu, GpuTimer *timer, const Hair *hair,
                     const Solver *solver, const SectionParams *params, Error *error);
void volume_destroy(Volume *volume);

// Call after a solver's step: changes the velocities that the next one begins with. Queues GPU
// work.
void volume_step(Volume *volume, const SolverStep *step);
