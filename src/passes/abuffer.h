// SPDX-License-Identifier: MIT
// The A-buffer: the pool of all fragments of a band of the image, and its resolution to colours.
#pragma once

#include "gpu/shader.h"
#include "passes/cull.h"
#include "passes/render_target.h"

#include <stdbool.h>

typedef struct ABuffer {
    GLuint resolve[2];   // programs: over the background alone, over a mesh
    GLuint vertex_array; // without attributes
    GpuBuffer nodes;     // uvec4, see abuffer.glsl
    GpuBuffer heads;     // uint a sample of the band
    GpuBuffer counters;  // uint, see COUNTER_WORDS
    GpuBuffer shortage;  // uint: not 0 once a pixel had too many fragments to visit
    GpuBuffer extent;    // int[4]: screen box of what has to be resolved: x, y lowest, highest, px
    LateRead counts;     // what a band has stored, on its way back
    const GpuLimits *limits;
    int64_t most_nodes; // that the pool can grow to
    int shards;         // that the pool is split into: SHARD_COUNT or 1
    int layers, width;  // of the samples
    int samples;        // across a pixel of the image, which has their mean
    int tone;           // display.glsl's macro
    bool depth;         // pixels show their nearest fragment's depth
    int most_turns;     // fragments of a pixel that can be visited
} ABuffer;

// What drawing a band has stored.
typedef struct ABufferUse {
    uint64_t fragments;
    uint32_t fullest;          // fragments of the fullest shard
    uint32_t segments, culled; // see RendererCounts
} ABufferUse;

// CPU drivers end loops silently after 65,535 turns.
enum { ABUFFER_MOST_TURNS = 65000 };

// `width`: of the image, px, whose pixels are the means of `samples` x `samples`. `layers`
// fragments of a sample are blended in order, >= 0, with `depth` >= 1. `tone`: a Tone, or
// TONE_LIGHT for premultiplied light as it is. `depth`: pixels show their nearest fragment's
// distance before the eye instead. `software`: by a CPU driver. `pool_bytes`: the pool's largest
// size, 0 for the driver's limit.
Result abuffer_create(ABuffer *abuffer, const GpuLimits *limits, int width, int samples, int layers,
                      int tone, bool depth, bool software, int64_t pool_bytes, Error *error);
void abuffer_destroy(ABuffer *abuffer);

// Makes what resolving over a mesh needs; nothing if it is there.
Result abuffer_add_base(ABuffer *abuffer, Error *error);

// Rows that one band can have at most; >= 1 for every image that can be drawn.
int abuffer_most_rows(const ABuffer *abuffer, int height);

// Fragments that a shard can hold.
int abuffer_shard_nodes(const ABuffer *abuffer);

// Empties the lists for a band of `rows` rows, sets the extent to box[4], and binds all to the
// storage points of draw.h.
Result abuffer_begin(ABuffer *abuffer, int rows, const int box[4], Error *error);

// Sends what has been drawn since, and what `cull` has found, on its way back. RESULT_FAILED if
// memory is short.
Result abuffer_send_use(ABuffer *abuffer, const Cull *cull, Error *error);

// Waits for what was sent. All is stored if abuffer_holds says so. RESULT_FAILED if it does not
// come.
Result abuffer_take_use(ABuffer *abuffer, ABufferUse *use, Cull *cull, Error *error);
bool abuffer_holds(const ABuffer *abuffer, const ABufferUse *use);

// Makes the pool large enough for `use` and some more, if need be by having one shard from now on,
// which wastes nothing. *grown is false, and the pool as large as it can be, where that is too
// small.
Result abuffer_grow(ABuffer *abuffer, const ABufferUse *use, bool *grown, Error *error);

// Writes the pixels within the extent and the scissor to the target's image, over its base if
// `over_mesh` (after abuffer_add_base). Needs the DrawParams block.
void abuffer_resolve(const ABuffer *abuffer, const RenderTarget *target, bool over_mesh);
