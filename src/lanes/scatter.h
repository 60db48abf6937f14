// SPDX-License-Identifier: MIT
// The light among hair (light_grid.h) for this backend. It is kept while hair, lights and mesh do
// not change.
#pragma once

#include "draw/fibre_kinds.h"
#include "draw/scatter.h"
#include "lanes/light_grid.h"
#include "lanes/shadow.h"

// A zeroed struct is empty.
typedef struct LaneScatter {
    LightGrid grid;
    LightBlocks blocks;
    FibreKinds kinds;
    GridHair *hair; // [room], owned: with kinds, also if no light is computed
    uint32_t count, room;
    uint64_t shadow_version; // of the maps used for the light
    DrawParams drawn;
    bool any;
} LaneScatter;

// Computes the light, unless that of the last frame is still valid, and prepares it for this eye.
// `casters`: of the frame's hair. *shown: whether there is any light among hair. RESULT_FAILED if
// memory is short.
Result lane_scatter_draw(LaneScatter *scatter, const ScatterOptions *options,
                         const BackendFrame *frame, const MappedCaster *casters,
                         const LaneShadow *shadow, bool *shown, Error *error);
void lane_scatter_destroy(LaneScatter *scatter);
