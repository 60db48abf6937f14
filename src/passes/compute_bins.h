// SPDX-License-Identifier: MIT
// Bins projected ribbons into tiles of pixels on the GPU: a list a tile, near ribbons first.
#pragma once

#include "base/error.h"
#include "gpu/gpu_buffer.h"

#include <stdbool.h>
#include <stdint.h>

// Lists of an image of columns x rows tiles of TILE_SIDE px (draw.h).
typedef struct ComputeBins {
    const GpuLimits *limits;
    GLuint count, place, fill, sort; // programs
    int columns, rows;               // tiles
    GpuBuffer counts, ends, tiles;   // uint a tile
    GpuBuffer use;                   // see draw.h
    GpuBuffer pairs, sorted;         // uvec2, [room]
    int64_t room, most_room;         // pairs
} ComputeBins;

// What a band of tiles came to.
typedef struct ComputeUse {
    uint64_t pairs;   // at least; exactly where there is room for them
    uint32_t longest; // pairs of a tile
} ComputeUse;

// Of width x height px. `pool_bytes`: no more memory for lists; 0: what the driver allows.
// RESULT_FAILED when memory is short. `limits` outlives the bins.
Result compute_bins_create(ComputeBins *bins, const GpuLimits *limits, int width, int height,
                           int64_t pool_bytes, Error *error);
void compute_bins_destroy(ComputeBins *bins);

// Lists the ribbons of `slots` slots in tiles of rows first .. end - 1, in no order, and binds all
// that sorting and compositing them need. `ribbons`, `keys`: with textures, see block_project.comp.
// A list without room is left out. Only queues work.
void compute_bins_fill(ComputeBins *bins, const GpuBuffer *ribbons, const GpuBuffer *keys,
                       int64_t slots, int first, int end);

// Sorts the lists. Only queues work.
void compute_bins_sort(const ComputeBins *bins);

// Runs the current program on every tile with ribbons, a work group each (TILES_OUT); less than
// TILE_ROW groups more.
void compute_bins_dispatch(const ComputeBins *bins);

// What TILE_USE_WORDS of `use` say.
ComputeUse compute_bins_use(const uint32_t *words);

// What the last band used. Waits for it.
Result compute_bins_measure(const ComputeBins *bins, ComputeUse *use, Error *error);

// Makes room for so many pairs and some more; *grown is false, and nothing done, where there can't
// be as much.
Result compute_bins_grow(ComputeBins *bins, uint64_t pairs, bool *grown, Error *error);
