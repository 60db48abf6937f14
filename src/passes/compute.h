// SPDX-License-Identifier: MIT
// The compute rasteriser: the same as the block rasteriser on the CPU, with the same arithmetic, on
// the GPU. ribbons.h projects strands. Here the ribbons are sorted into tiles of pixels and
// composited. The image is queued without waiting for any count.
#pragma once

#include "gpu/gpu.h"
#include "gpu/gpu_timer.h"
#include "gpu/late_read.h"
#include "passes/compute_bins.h"
#include "passes/render_target.h"
#include "passes/ribbons.h"

// A zeroed struct is empty.
typedef struct Compute {
    ComputeBins bins;
    // Programs: [0] over the background alone, [1] over mesh or floor. For tiles with ribbons; for
    // tiles without.
    GLuint composite[2], behind[2];
    int samples, tone; // see drawing_display
    bool shows_depth, nearest;
    ImageKind kind;
    int longest;    // number of a tile's pairs that the driver's loops can visit
    int band_rows;  // maximum rows of tiles in the next image's bands; limited for the same reason
    LateRead late;  // counts of the image
    bool unsettled; // the counts have not been checked
} Compute;

// Counts of an image.
typedef struct ComputeCounts {
    uint64_t pairs; // tiles of ribbons
    uint32_t redraws, bands;
} ComputeCounts;

// RESULT_FAILED if memory is short. `gpu` must outlive the rasteriser.
Result compute_create(Compute *compute, const Gpu *gpu, const RendererOptions *options,
                      Error *error);
void compute_destroy(Compute *compute);

// Creates what drawing over mesh or floor needs, if missing.
Result compute_add_base(Compute *compute, Error *error);

// Composites the projected `ribbons` into the target's image, over its base if the ribbons have
// one. Draws in bands of tiles and waits for each. If the lists are too short they grow and the
// band is drawn again; if they cannot grow, there are more bands. Adds to `counts`. RESULT_FAILED
// if a row of tiles has more ribbons than lists can hold, or a tile has more than a CPU driver's
// loops can visit.
Result compute_draw(Compute *compute, const Ribbons *ribbons, const RenderTarget *target,
                    GpuTimer *timer, ComputeCounts *counts, Error *error);

// compute_trusts: whether the next image is drawn in one band. Then compute_begin queues it without
// waiting for any count, and compute_settle takes the counts, also those of the ribbons, when they
// have arrived. If it sets *good to false, the image must be drawn again by compute_draw. Errors
// are those of compute_draw.
bool compute_trusts(const Compute *compute);
Result compute_begin(Compute *compute, const Ribbons *ribbons, const RenderTarget *target,
                     GpuTimer *timer, Error *error);
Result compute_settle(Compute *compute, Ribbons *ribbons, ComputeCounts *counts, bool *good,
                      Error *error);
