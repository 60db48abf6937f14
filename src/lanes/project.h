// SPDX-License-Identifier: MIT
// Strands on the screen: where their points lie, which are kept, and the ribbons between those.
#pragma once

#include "base/error.h"
#include "base/parallel.h"
#include "lanes/hidden.h"
#include "lanes/lane_hair.h"

// A point that is kept; those of a strand stand side by side, from root to tip.
typedef struct ScreenPoint {
    float x, y;      // px
    float inverse_w; // 1/m, see RibbonPoint; with its sign set: the strand's last one
    uint32_t place;  // half-width (px, a level) | the point's number on its strand << 16
} ScreenPoint;

// A ribbon from a point to the next, and the blocks of pixels that its box touches.
typedef struct RibbonItem {
    uint32_t depth; // 1/w in its middle, a positive float's bits
    uint32_t slot;  // its first point
    uint16_t left, top, right, bottom;
} RibbonItem;

// A zeroed struct is empty.
typedef struct Projection {
    ScreenPoint *points; // [hairs->points], owned: those of a strand begin where all of its do
    size_t point_room;
    int parts;                        // ranges of strands, each a thread's
    RibbonItem *items[PARALLEL_MOST]; // [item_count], owned: by ascending slots, so parts, too
    size_t item_count[PARALLEL_MOST], item_room[PARALLEL_MOST];
    float *scratch[PARALLEL_MOST]; // owned
    size_t scratch_room;
    uint64_t culled[PARALLEL_MOST], hidden[PARALLEL_MOST]; // strands without a ribbon: outside the
                                                           // image; else behind what hides them
    bool short_of_memory[PARALLEL_MOST];
} Projection;

// Projects all strands into the image of `draw`. `hidden`: what is opaque in it; NULL: nothing.
// Points are left out where the ribbon is straight for no more than `far` px (at most; colours are
// found at those that are kept). `parts`: 1 to PARALLEL_MOST, the same in each call. RESULT_FAILED
// if memory is short.
Result projection_find(Projection *projection, const LaneHairs *hairs, const DrawParams *draw,
                       const Hidden *hidden, float far, int parts, Error *error);
void projection_destroy(Projection *projection);
