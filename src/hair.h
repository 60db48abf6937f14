// SPDX-License-Identifier: MIT
// Hair on the GPU: the only thing that solvers and the renderer share. Solvers write positions, the
// renderer reads them.
#pragma once

#include "gpu_buffer.h"
#include "strands.h"

// Strands of equal vertex count, no more than one buffer holds. Particle j (0 = root) of strand s
// stands at index j * strand_count + s, so that neighbouring lanes touch neighbouring memory.
typedef struct HairBatch {
    uint32_t vertex_count; // of each strand, >= 2
    uint32_t strand_count;
    GpuBuffer position; // vec4 a particle: xyz in metres in the world, w = 1. Drawn.
    GpuBuffer rest;     // vec4 a particle, the style in the head's frame. j = 0: root (m) and the
                    // strand's length (m); j > 0: unit direction of the segment from j - 1 to j and
                    // its rest length (m)
    GpuBuffer strand_id; // uint a strand: its number among all strands of the run, seed of all that
                         // varies by strand
} HairBatch;

typedef struct Hair {
    HairBatch *batches;
    uint32_t batch_count;
    uint32_t strand_count;
    uint64_t particle_count, segment_count;
    float low[3], high[3]; // bounds of the style in the head's frame, metres
    float longest;         // length of the longest strand, metres
} Hair;

// Uploads strands (every one with at least 2 vertices and no segment of length 0, as strands_read
// leaves them) with numbers from `first_id` on. Positions start as the style with the head at the
// origin. RESULT_FAILED if memory is short or one strand exceeds the driver's limits. Destroying a
// zeroed struct is legal.
Result hair_create(Hair *hair, const Strands *strands, uint32_t first_id, const GpuLimits *limits,
                   Error *error);
void hair_destroy(Hair *hair);
