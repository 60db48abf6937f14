// SPDX-License-Identifier: MIT
// The light grid (light_grid.h) in compute shaders, for GPUs: hair stays where it is, C finds where
// the cells lie and the tables of fibres. Two small things come back: the box of hair, behind a
// fence, and how many cells have some, for which C waits. The same light as C's but for rounding.
// Needs the DrawParams block.
#pragma once

#include "draw/light_field.h"
#include "gpu/late_read.h"
#include "passes/light_pass.h"
#include "passes/look_programs.h"

// Of the tables that a buffer has: see GridKind.
typedef struct KindTableMade {
    uint32_t made[LIGHT_GRID_KINDS];
    int kinds, lights;
} KindTableMade;

typedef struct KindTable {
    GpuBuffer buffer;
    KindTableMade made;
} KindTable;

// A struct that has but limits has found nothing.
typedef struct LightPasses {
    LightPrograms programs; // their limits are given
    LightField field;
    LateRead box_read, counts_read;
    GpuBuffer box, slots, cells, state, sums, planes, depth, source, order, total, light;
    GpuBuffer tables, walls;
    KindTable kinds[FIELD_TABLES];
    int filled, active; // cells with hair; with those beside them
    int64_t most_sums;  // bytes: of more cells sums are made in turns; 0: SUMS_MOST
} LightPasses;

// Queues the search for the box of hair, so that nothing has to wait for it later: before the maps
// of shadows. `scene` needs its lights only.
Result light_passes_begin(LightPasses *passes, const GridScene *scene, ShadowCasters casters,
                          Error *error);

// Finds the light, with the shadow maps that are bound; of `scene`, light at points is not needed.
// RESULT_FAILED if memory is short.
Result light_passes_solve(LightPasses *passes, const GridScene *scene, ShadowCasters casters,
                          Error *error);

// What of that light each point of the hair sends to the eye, into `seen` of each caster with
// marschner's look.
Result light_passes_gather(LightPasses *passes, const GridScene *scene, ShadowCasters casters,
                           const ParticleLight *seen, Error *error);

void light_passes_destroy(LightPasses *passes);
