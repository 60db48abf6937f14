// SPDX-License-Identifier: MIT
// Projects strands to the screen: finds their points, chooses those to keep, and lists the ribbons
// between them.
#pragma once

#include "base/error.h"
#include "base/parallel.h"
#include "lanes/hidden.h"
#include "lanes/lane_hair.h"

// A kept point. The kept points of a strand lie side by side, from root to tip.
typedef struct ScreenPoint {
    float x, y;      // px
    float inverse_w; // 1/m, see RibbonPoint; negative: the strand's last point
    uint32_t place;  // half-width (px, a level) | the point's number on its strand << 16
} ScreenPoint;

// A ribbon from a kept point to the next, and the blocks of pixels that its box touches.
typedef struct RibbonItem {
    uint32_t depth; // 1/w at its middle, as a positive float's bits
    uint32_t slot;  // of its first point
    uint16_t left, top, right, bottom;
} RibbonItem;

// A zeroed struct is empty.
typedef struct Projection {
    ScreenPoint *points; // [hairs->points], owned: those of a strand start where all its points
                         // start
    size_t point_room;
    int parts;                        // ranges of strands, one per thread
    RibbonItem *items[PARALLEL_MOST]; // [item_count], owned: by ascending slots, also across parts
    size_t item_count[PARALLEL_MOST], item_room[PARALLEL_MOST];
    float *scratch[PARALLEL_MOST]; // owned
    size_t scratch_room;
    uint64_t culled[PARALLEL_MOST], hidden[PARALLEL_MOST]; // strands without a ribbon: outside the
                                                           // image; otherwise behind opaque
                                                           // surfaces
    bool short_of_memory[PARALLEL_MOST];
} Projection;

// Projects all strands into the image of `draw`. `hidden`: depths of opaque surfaces; NULL: none. A
// point is left out where the ribbon is straight and no longer than `far` px, or, beyond 1 px, than
// a sixteenth of the strand; colours are computed at the kept points only. `parts`: threads, 1 to
// PARALLEL_MOST, the same in each call. RESULT_FAILED if memory is short.
Result projection_find(Projection *projection, const LaneHairs *hairs, const DrawParams *draw,
                       const Hidden *hidden, float far, int parts, Error *error);
void projection_destroy(Projection *projection);
