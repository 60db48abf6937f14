// SPDX-License-Identifier: MIT
// The light among hair for this backend, computed by shaders (light_passes.h). It is kept while
// hair, lights and mesh do not change.
#pragma once

#include "draw/backend.h"
#include "draw/fibre_kinds.h"
#include "passes/light_passes.h"
#include "passes/look_programs.h"
#include "passes/shadows.h"

// A zeroed struct can be given to hair_scatter_create.
typedef struct HairScatter {
    ScatterOptions options;
    const GpuLimits *limits;
    LightPasses passes;
    LightBlocks blocks;
    FibreKinds kinds;
    GridHair *hair;      // [room], owned
    ParticleLight *seen; // [room], owned
    uint32_t count, room;
    uint64_t shadow_version; // of the maps used for the light
    DrawParams drawn;
    float to_eye[3]; // eye for which `seen` was computed
    bool any;
} HairScatter;

void hair_scatter_create(HairScatter *scatter, const GpuLimits *limits,
                         const ScatterOptions *options);
void hair_scatter_destroy(HairScatter *scatter);

// Queues a search that the light needs later, before new shadow maps of the scene are drawn.
Result hair_scatter_begin(HairScatter *scatter, const BackendFrame *frame, ShadowCasters casters,
                          Error *error);

// Computes the light, if it has changed and if a look of the drawing uses it, and gives it to the
// looks. `shadows` are deep, drawn for the scene and bound. RESULT_FAILED if memory is short.
Result hair_scatter_draw(HairScatter *scatter, const BackendFrame *frame, ShadowCasters casters,
                         const Shadows *shadows, Error *error);

// The light, if it includes that of hair on the mesh of this frame; NULL otherwise. Call
// hair_scatter_draw for the frame first.
const LightPasses *hair_scatter_on_skin(const HairScatter *scatter, const BackendFrame *frame);
