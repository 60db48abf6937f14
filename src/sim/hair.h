// SPDX-License-Identifier: MIT
// Hair on the GPU: the only thing that solvers and the renderer share. Solvers write positions, the
// renderer reads them.
#pragma once

#include "gpu/gpu_buffer.h"
#include "strands/strands.h"

#include "glsl/common/shared.h"

// Strands of equal vertex count, no more than one buffer holds, in tiles of STRAND_TILE
// (glsl/common/shared.h): particle 0 of a tile's strands side by side, then particle 1 and so on,
// so that a group of lanes reads memory in sequence. (With a row of all strands for each particle,
// CPUs lose up to a factor of two.) Copies of the last strand fill the last tile; they are stepped
// but never drawn.
typedef struct HairBatch {
    uint32_t vertex_count; // of each strand, >= 2
    uint32_t strand_count;
    // [strand_count], owned: which of the file's strands each is, or follows; may be NULL.
    uint32_t *strand;
    // vec4 a particle: xyz in metres in the world, w = 1. Drawn.
    GpuBuffer position;
    // vec4 a particle, the style in the head's frame. j = 0: root and the strand's length (m);
    // j > 0: unit direction of the segment from j - 1 to j and its rest length (m).
    GpuBuffer rest;
    // uint a strand (and copy): its number in its section, seed of all that varies by strand.
    GpuBuffer strand_id;
    // uvec4 a particle, see look_paint; no buffer if the section has one look.
    GpuBuffer paint;
} HairBatch;

// The most vec4 a particle that a solver keeps in one buffer (SolverRecipe.scratch): no batch has
// more particles than such a buffer can hold.
enum { HAIR_MOST_SCRATCH = 3 };

// Strands with the last tile's copies: what buffers have room for.
static inline uint32_t hair_slots(const HairBatch *batch)
{
    return (batch->strand_count + STRAND_TILE - 1) / STRAND_TILE * STRAND_TILE;
}

// Index of particle `vertex` of strand `strand`, an element of `position` and `rest`.
static inline size_t hair_address(const HairBatch *batch, uint32_t strand, uint32_t vertex)
{
    return ((size_t)(strand / STRAND_TILE) * batch->vertex_count + vertex) * STRAND_TILE +
           strand % STRAND_TILE;
}

typedef struct Hair {
    HairBatch *batches;
    uint32_t batch_count;
    uint32_t strand_count;
    uint64_t particle_count, segment_count;
    float low[3], high[3]; // bounds of the style in the head's frame, metres
    float longest;         // length of the longest strand, metres
    float evenness;        // the least share that a segment has of its strand's average one
    bool alike;            // strands do not differ by chance: their file says their colours
    bool is_painted;       // its batches have paint ...
    float paint_mean[3];   // ... of this mean colour, linear RGB
} Hair;

// Uploads strands (every one with at least 2 vertices and no segment of length 0, as strands_read
// leaves them) with numbers from `first_id` on. Positions start as the style with the head at the
// origin. RESULT_FAILED if memory is short or one strand exceeds the driver's limits. Destroying a
// zeroed struct is legal.
Result hair_create(Hair *hair, const Strands *strands, uint32_t first_id, const GpuLimits *limits,
                   Error *error);
void hair_destroy(Hair *hair);

// The drawn positions of all strands, one behind the other from root to tip, in the order of the
// batches: positions[hair->particle_count]. Reading waits for the GPU; writing fills the last
// tile's copies, too. RESULT_FAILED when memory is short.
Result hair_read_positions(const Hair *hair, float (*positions)[3], Error *error);
Result hair_write_positions(const Hair *hair, const float (*positions)[3], Error *error);
