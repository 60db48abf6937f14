// SPDX-License-Identifier: MIT
// The room passes draws hair by shaders: shadow maps (shadows.h), light among hair
// (hair_scatter.h), mesh and floor (base_layer.h), then the hair. Hair is drawn either as triangles
// into an A-buffer (quads.h), or as ribbons that are projected (ribbons.h) and composited
// (compute.h) by compute shaders. Works on every driver. Only counts, boxes and the image are read
// back.
#pragma once

#include "draw/backend.h"
#include "gpu/gpu.h"
#include "passes/base_layer.h"
#include "passes/compute.h"
#include "passes/hair_scatter.h"
#include "passes/quads.h"

typedef struct Passes {
    BackendOptions set;
    const RendererOptions *options; // for a window
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
