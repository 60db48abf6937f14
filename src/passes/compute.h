// SPDX-License-Identifier: MIT
// The compute rasteriser: what the block rasteriser does on the CPU, on the GPU, with the same
// arithmetic. ribbons.h projects strands; here their ribbons are binned into tiles of pixels,
// sorted and composited, without a look at any count before the image is queued.
#pragma once

#include "gpu/gpu.h"
#include "gpu/gpu_timer.h"
#include "gpu/late_read.h"
#include "passes/compute_bins.h"
#include "passes/render_target.h"
#include "passes/ribbons.h"

// A zeroed struct has nothing.
typedef struct Compute {
    ComputeBins bins;
    // Programs: over the background alone, over mesh or floor. Tiles with ribbons; without.
    GLuint composite[2], behind[2];
    int samples, tone; // see drawing_display
    bool shows_depth, nearest;
    ImageKind kind;
    int longest;    // pairs of a tile that the driver's loops can visit
    int most_rows;  // of tiles in a band, for the same reason
    int band_rows;  // that the next image is drawn in
    LateRead late;  // counts of the image
    bool unsettled; // nobody has looked at them
} Compute;

// What an image came to.
typedef struct ComputeCounts {
    uint64_t pairs; // tiles of ribbons
    uint32_t redraws, bands;
} ComputeCounts;

// RESULT_FAILED if memory is short. `gpu` outlives the rasteriser.
Result compute_create(Compute *compute, const Gpu *gpu, const RendererOptions *options,
                      Error *error);
void compute_destroy(Compute *compute);

// Makes what drawing over mesh or floor needs; nothing if it is there.
Result compute_add_base(Compute *compute, Error *error);

// Composites what `ribbons` has projected into the target's image, over its base if the ribbons
// have one, in bands of tiles, each of which is waited for. Lists that turn out to have been short
// of room grow, and the band is drawn again; at their largest there are more bands. Adds to
// `counts`. RESULT_FAILED where a row of tiles has more ribbons than lists can, or a tile has more
// than a CPU driver's loops can visit.
Result compute_draw(Compute *compute, const Ribbons *ribbons, const RenderTarget *target,
                    GpuTimer *timer, ComputeCounts *counts, Error *error);

// Whether the next image goes in one band. Then compute_begin queues it without a look at any
// count, and compute_settle takes the counts when they are there, those of the ribbons too: with
// *good false the image must be drawn by compute_draw. Errors as compute_draw.
bool compute_trusts(const Compute *compute);
Result compute_begin(Compute *compute, const Ribbons *ribbons, const RenderTarget *target,
                     GpuTimer *timer, Error *error);
Result compute_settle(Compute *compute, Ribbons *ribbons, ComputeCounts *counts, bool *good,
                      Error *error);
