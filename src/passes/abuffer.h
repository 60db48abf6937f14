// SPDX-License-Identifier: MIT
// The A-buffer: the pool of all fragments of a band of the image, and the pass that resolves them
// to colours.
#pragma once

#include "gpu/shader.h"
#include "passes/cull.h"
#include "passes/render_target.h"

#include <stdbool.h>

typedef struct ABuffer {
    GLuint resolve[2];   // programs: over the background alone, over a mesh
    GLuint vertex_array; // without attributes
    GpuBuffer nodes;     // uvec4, see abuffer.glsl
    GpuBuffer heads;     // a uint per sample of the band
    GpuBuffer counters;  // uint, see COUNTER_WORDS
    GpuBuffer shortage;  // uint: not 0 once a pixel had too many fragments to visit
    GpuBuffer extent;    // int[4]: screen box to be resolved: x, y lowest, highest, px
    LateRead counts;     // counts of a band on their way to the CPU
    const GpuLimits *limits;
    int64_t most_nodes; // largest size of the pool
    int shards;         // number of parts of the pool: SHARD_COUNT or 1
    int layers, width;  // of the samples
    int samples;        // per pixel side; pixels are means of samples
    int tone;           // display.glsl's macro
    bool depth;         // pixels show the depth of their nearest fragment
    bool nearest;       // fragments hide what is behind them
    int most_turns;     // number of a pixel's fragments that can be visited
} ABuffer;

// Counts of a band that was drawn.
typedef struct ABufferUse {
    uint64_t fragments;
    uint32_t fullest;          // fragments of the fullest shard
    uint32_t segments, culled; // see RendererCounts
} ABufferUse;

// CPU drivers end loops silently after 65,535 turns.
enum { ABUFFER_MOST_TURNS = 65000 };

// `width`: of the image, px. A pixel is the mean of `samples` x `samples` samples. `layers`:
// fragments of a sample that are blended in order, >= 0, with AOV_DEPTH >= 1. `tone`: a Tone, or
// TONE_LIGHT for premultiplied linear light. `aov`: what pixels show; for AOV_DEPTH, the distance
// of their nearest fragment. `software`: the driver draws on the CPU. `pool_bytes`: the pool's
// largest size; 0: the driver's limit.
Result abuffer_create(ABuffer *abuffer, const GpuLimits *limits, int width, int samples, int layers,
                      int tone, Aov aov, bool software, int64_t pool_bytes, Error *error);
void abuffer_destroy(ABuffer *abuffer);

// Creates what resolving over a mesh needs, if missing.
Result abuffer_add_base(ABuffer *abuffer, Error *error);

// The most rows of a band; >= 1 for every image that can be drawn.
int abuffer_most_rows(const ABuffer *abuffer, int height);

// The fragments that a shard can hold.
int abuffer_shard_nodes(const ABuffer *abuffer);

// Empties the lists for a band of `rows` rows, sets the extent to box[4], and binds everything to
// the storage points of draw.h.
Result abuffer_begin(ABuffer *abuffer, int rows, const int box[4], Error *error);

// Begins to read back the counts of the band and of `cull`. RESULT_FAILED if memory is short.
Result abuffer_send_use(ABuffer *abuffer, const Cull *cull, Error *error);

// Waits for these counts; abuffer_holds tells whether the A-buffer holds all fragments.
// RESULT_FAILED if the counts do not arrive.
Result abuffer_take_use(ABuffer *abuffer, ABufferUse *use, Cull *cull, Error *error);
bool abuffer_holds(const ABuffer *abuffer, const ABufferUse *use);

// Enlarges the pool to more than `use`; if necessary, it uses a single shard from now on, which
// wastes no memory. If that is still too small, *grown is false and the pool has its largest size.
Result abuffer_grow(ABuffer *abuffer, const ABufferUse *use, bool *grown, Error *error);

// Writes the pixels inside the extent and the scissor to the target's image, over its base if
// `over_mesh` (call abuffer_add_base first). Needs the DrawParams block.
void abuffer_resolve(const ABuffer *abuffer, const RenderTarget *target, bool over_mesh);
