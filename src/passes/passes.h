// SPDX-License-Identifier: MIT
// The room passes draws hair by shaders, from shadow maps (shadows.h) and the light among hair
// (hair_scatter.h) to mesh and floor (base_layer.h) and the hair itself: by triangles into an
// A-buffer (quads.h), or by ribbons that are projected (ribbons.h) and composited (compute.h) in
// compute. On every driver; nothing is read back but counts and the image.
#pragma once

#include "draw/backend.h"
#include "gpu/gpu.h"
#include "passes/base_layer.h"
#include "passes/compute.h"
#include "passes/hair_scatter.h"
#include "passes/quads.h"

typedef struct Passes {
    BackendOptions set;
    const RendererOptions *options; // of a window
    const Gpu *gpu;
    RenderTarget target;
    Quads quads;
    Ribbons ribbons;
    Compute compute;
    BaseLayer base;
    Shadows shadow;
    HairScatter scatter;
    ShadowCaster *casters; // [caster_room], owned
    uint32_t caster_room;
    RendererCounts counts;
} Passes;
