// SPDX-License-Identifier: MIT
// Sorts projected ribbons into tiles of pixels on the GPU: one list for each tile, near ribbons
// first.
#pragma once

#include "base/error.h"
#include "gpu/gpu_buffer.h"

#include <stdbool.h>
#include <stdint.h>

// The lists of an image of columns x rows tiles of TILE_SIDE px (draw.h).
typedef struct ComputeBins {
    const GpuLimits *limits;
    GLuint count, place, fill, sort; // programs
    int columns, rows;               // tiles
    GpuBuffer counts, ends, tiles;   // a uint per tile
    GpuBuffer use;                   // see draw.h
    GpuBuffer pairs, sorted;         // uvec2, [room]
    int64_t room, most_room;         // pairs
} ComputeBins;

// Counts of a band of tiles.
typedef struct ComputeUse {
    uint64_t pairs;   // exact if there was room for them, otherwise a lower bound
    uint32_t longest; // pairs of the longest list
} ComputeUse;

// For an image of width x height px. `pool_bytes`: the most memory for lists; 0: the driver's
// limit. RESULT_FAILED if memory is short. `limits` must outlive the bins.
Result compute_bins_create(ComputeBins *bins, const GpuLimits *limits, int width, int height,
                           int64_t pool_bytes, Error *error);
void compute_bins_destroy(ComputeBins *bins);

// Lists the ribbons of `slots` slots in the tiles of rows first .. end - 1, in any order, and binds
// everything that sorting and compositing need. `ribbons` and `keys` have textures, see
// block_project.comp. A list for which there is no room is left out. Only queues work.
void compute_bins_fill(ComputeBins *bins, const GpuBuffer *ribbons, const GpuBuffer *keys,
                       int64_t slots, int first, int end);

// Sorts the lists. Only queues work.
void compute_bins_sort(const ComputeBins *bins);

// Runs the current program with a work group for every tile with ribbons (TILES_OUT), and with
// fewer than TILE_ROW groups more.
void compute_bins_dispatch(const ComputeBins *bins);

// Reads TILE_USE_WORDS words of `use`.
ComputeUse compute_bins_use(const uint32_t *words);

// The counts of the last band. Waits for it.
Result compute_bins_measure(const ComputeBins *bins, ComputeUse *use, Error *error);

// Makes room for more than this many pairs. If that is impossible, *grown is false and nothing
// changes.
Result compute_bins_grow(ComputeBins *bins, uint64_t pairs, bool *grown, Error *error);
