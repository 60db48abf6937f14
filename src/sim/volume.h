// SPDX-License-Identifier: MIT
// Volume: hair that is denser than in its rest pose gets no denser, and its strands slow each
// other down.
//
// After each step the particles of a section are summed up in the cells of a grid that moves with
// the head: their number and their velocities. A cell is dense if it has more particles than its
// own groom had there, and also more than its present particles had around them at rest. So a
// groom at rest is not affected, whatever the size of the cells.
// - Hair that approaches a dense cell is stopped; it bounces back if the cell is much too dense.
// - Hair in a dense cell leaves it at a speed of a few cells a second (volume_push.comp).
// - Velocities within a dense cell are mixed (friction).
// All of this keeps momentum. Only the leaving can add kinetic energy, at a bounded speed.
// Particles outside the grid, particles that the head carries, and followers take no part. Each
// section has its own grid.
//
// After Petrovic, Henne and Anderson 2005, Volumetric methods for simulation and rendering of hair
// (density and velocity on a grid, friction), and McAdams et al. 2009, Detail preserving continuum
// simulation of straight hair (particles take changes of the grid's velocities). Impulses between
// cells replace their repulsion and pressure, so no system of equations is solved.
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
    float low[3];    // lowest corner of the grid, in the head's frame (m)
    float middle[3]; // its middle
    uint32_t cell_count;
    uint32_t grain; // see volume.glsl
    VolumeParams step;
    bool segments;
    StepPass splat, cells, push[2], apply;
    GpuBuffer sums, own, faces, changes, dense;
    GpuBuffer velocities[3]; // of the cells: before the impulses, and two buffers used in turn
    GpuBuffer *rest;         // [hair->batch_count]: uint a particle, its density at rest
} Volume;

// The result is empty if params->volume is 0 or the solver is static. The hair must be in its
// style with the head at the origin, as hair_create leaves it. RESULT_FAILED when memory is short;
// errors of shader_build_compute and of buffers.
Result volume_create(Volume *volume, const Gpu *gpu, GpuTimer *timer, const Hair *hair,
                     const Solver *solver, const SectionParams *params, Error *error);
void volume_destroy(Volume *volume);

// Call after a solver's step. Changes the velocities with which the next step begins. Queues GPU
// work.
void volume_step(Volume *volume, const SolverStep *step);
