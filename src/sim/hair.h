// SPDX-License-Identifier: MIT
// Hair on the GPU. Solvers and the renderer share nothing else: solvers write positions, the
// renderer reads them.
#pragma once

#include "gpu/gpu_buffer.h"
#include "strands/strands.h"

#include "glsl/common/shared.h"

// A batch has strands of equal vertex count, at most as many as fit in one buffer. Strands lie in
// tiles of STRAND_TILE (glsl/common/shared.h): particle 0 of all strands of a tile side by side,
// then particle 1 and so on, so that a group of lanes reads memory sequentially. (Without tiles,
// with one row of all strands per particle, CPUs are up to two times slower.) Copies of the last
// strand fill the last tile; they are simulated but never drawn.
typedef struct HairBatch {
    uint32_t vertex_count; // of each strand, >= 2
    uint32_t strand_count;
    uint32_t held; // vertices of each strand, from the root, that its mobility holds (strands_held)
    // [strand_count], owned: the number in the file of the strand, or of a follower's guide. May be
    // NULL.
    uint32_t *strand;
    // vec4 a particle: xyz in metres in the world. These positions are drawn. w: what a solver
    // keeps of the position beyond the precision of xyz (glsl/sim/relative.glsl); 0: nothing.
    GpuBuffer position;
    // vec4 a particle, the style in the head's frame. j = 0: root and the strand's length (m);
    // j > 0: unit direction of the segment from j - 1 to j and its rest length (m).
    GpuBuffer rest;
    // uint a strand (and copy): its number in its section, the seed of everything that varies from
    // strand to strand.
    GpuBuffer strand_id;
    // uvec4 a particle, see look_paint; no buffer if the whole section has one look.
    GpuBuffer paint;
} HairBatch;

// The most vec4 a particle that a solver keeps in one buffer (SolverRecipe.scratch): no batch has
// more particles than such a buffer can hold.
enum { HAIR_MOST_SCRATCH = 7 };

// Number of strands including the copies in the last tile. Buffers have room for that many.
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
    float evenness;        // smallest ratio of a segment's length to its strand's average segment
    bool alike;            // no random variation of strands, because the file has their colours
    bool is_painted;       // batches have `paint`
    float paint_mean[3];   // mean colour of the paint, linear RGB
} Hair;

// Uploads strands (every one with at least 2 vertices and no segment of length 0, as strands_read
// leaves them) with numbers from `first_id` on. Positions start as the style with the head at the
// origin. RESULT_FAILED if memory is short or one strand exceeds the driver's limits. Destroying a
// zeroed struct is legal.
Result hair_create(Hair *hair, const Strands *strands, uint32_t first_id, const GpuLimits *limits,
                   Error *error);
void hair_destroy(Hair *hair);

// Read or write the drawn positions of all strands, positions[hair->particle_count]: strand after
// strand in the order of the batches, each from root to tip. Reading waits for the GPU; writing
// also fills the copies in the last tile. RESULT_FAILED when memory is short.
Result hair_read_positions(const Hair *hair, float (*positions)[3], Error *error);
Result hair_write_positions(const Hair *hair, const float (*positions)[3], Error *error);
