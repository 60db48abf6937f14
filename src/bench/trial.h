// SPDX-License-Identifier: MIT
// Strands under a solver, stepped by hand: what benchmarks of accuracy run.
#pragma once

#include "sim/solver.h"
#include "strands/strands.h"

typedef struct Trial {
    Hair hair;
    Solver solver;
    GpuTimer timer;
    SectionParams params; // strings are borrowed
    SolverStep step;      // gravity (0, -9.81, 0), no wind, the head at the origin; may be changed
    double rate;          // steps a second
    long steps;           // made so far
    float (*points)[3];   // [hair.particle_count]: what trial_read has read
} Trial;

// The strands at rest, with numbers from `first_id` on; steps of 1/rate s. The strings of `params`
// outlive the trial, which may be destroyed when creation has failed or when it is zeroed.
Result trial_create(Trial *trial, const Gpu *gpu, const Strands *strands, uint32_t first_id,
                    const SectionParams *params, double rate, Error *error);
void trial_destroy(Trial *trial);

// A step, at whose end the head is where trial->step.head says.
void trial_step(Trial *trial);

// The drawn positions, by strands from root to tip (hair_read_positions).
Result trial_read(Trial *trial, Error *error);

// The solver's buffer of that kind for a batch of the hair, NULL: there is none.
const GpuBuffer *trial_buffer(const Trial *trial, uint32_t batch, SolverBufferKind kind);

// The simulated tip of a strand (position and velocity) where a solver has one beside the drawn
// strand; false if it has none. Waits for the GPU.
bool trial_read_tip(const Trial *trial, uint32_t batch, uint32_t strand, float tip[2][4]);

// `count` strands, each of `n` particles on its own of `points` [count][n] (m). Free with
// strands_destroy.
Result trial_make_strands(Strands *strands, const double (*points)[3], uint32_t count, int n,
                          Error *error);

// A helix of `n` particles, `length` metres along its segments, `turns` turns of 2 cm around an
// axis that leads aside and down from the root at the origin.
void trial_make_helix(double (*points)[3], int n, double length, double turns);

// A straight one, held horizontally along x.
void trial_make_beam(double (*points)[3], int n, double length);
