// SPDX-License-Identifier: MIT
// The light grid (light_grid.h) in compute shaders, so that hair stays on the GPU. C places the
// cells and makes the tables of fibres. Two small results come back: the box of the hair, behind a
// fence, and the number of cells with hair, for which C waits. The light is the same as that of
// light_grid.h except for rounding. Needs the DrawParams block.
#pragma once

#include "draw/light_field.h"
#include "gpu/late_read.h"
#include "passes/light_pass.h"
#include "passes/look_programs.h"

// Identifies the tables that a buffer holds: see GridKind.
typedef struct KindTableMade {
    uint32_t made[LIGHT_GRID_KINDS];
    int kinds, lights;
} KindTableMade;

typedef struct KindTable {
    GpuBuffer buffer;
    KindTableMade made;
} KindTable;

// A struct that is zeroed except for `limits` has no light yet.
typedef struct LightPasses {
    LightPrograms programs; // initialised with limits
    LightField field;
    LateRead box_read, counts_read;
    GpuBuffer box, slots, cells, state, sums, planes, depth, source, order, total, light;
    GpuBuffer tables, walls;
    GpuBuffer sent;  // what hair has sent in all orders but the last, for skin
    GpuBuffer onto;  // the light of hair by ordinate and cell, for skin
    GpuBuffer faces; // [cells][ONTO_FACES] vec4: this light on surfaces (kernel/onto.h)
    bool lights_skin;
    KindTable kinds[FIELD_TABLES];
    int filled, active; // number of cells with hair; plus their neighbours
    int64_t most_sums;  // bytes: the sums of more cells are made in several turns; 0: SUMS_MOST
} LightPasses;

// Queues the search for the hair's box before the shadow maps are drawn, so that nothing waits for
// it later. Uses only the lights of `scene`.
Result light_passes_begin(LightPasses *passes, const GridScene *scene, ShadowCasters casters,
                          Error *error);

// Computes the light with the bound shadow maps. `scene` needs no `shadow`. RESULT_FAILED if memory
// is short.
Result light_passes_solve(LightPasses *passes, const GridScene *scene, ShadowCasters casters,
                          Error *error);

// Computes the light that each point of the hair sends to the eye, into `seen` of each caster whose
// look is marschner.
Result light_passes_gather(LightPasses *passes, const GridScene *scene, ShadowCasters casters,
                           const ParticleLight *seen, Error *error);

void light_passes_destroy(LightPasses *passes);
