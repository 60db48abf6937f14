// SPDX-License-Identifier: MIT
// The rasteriser of GPUs: ribbons as triangles, whose fragments go to an A-buffer, in bands of rows
// where that cannot hold the whole picture's.
#pragma once

#include "draw/picture.h"
#include "draw/render_abuffer.h"
#include "draw/render_hair.h"
#include "gpu/gpu.h"
#include "gpu/gpu_timer.h"

// A zeroed struct has nothing, and no limits.
typedef struct RenderQuads {
    RenderHair hair;
    RenderABuffer abuffer;
    const GpuLimits *limits;
    int width, height; // px of the picture
    int samples;       // across a pixel
    int band_rows;     // that the next picture starts with
    RenderCull cull;
    bool skips; // strands are looked through before they are projected
} RenderQuads;

// RESULT_FAILED if memory is short. `gpu` outlives the quads.
Result render_quads_create(RenderQuads *quads, const Gpu *gpu, const RendererOptions *options,
                           Error *error);
void render_quads_destroy(RenderQuads *quads);

// Makes what drawing over a mesh needs; nothing if it is there.
Result render_quads_add_base(RenderQuads *quads, Error *error);

// Draws the picture's hair over the target's base, or over the background if `over_mesh` is false,
// and copies it into `image`; waits for it. `base`: what is opaque. What it does is added to
// `counts`. See renderer_draw.
Result render_quads_draw(RenderQuads *quads, Picture *picture, RenderTarget *target,
                         const CullBase *base, GpuTimer *timer, Image *image,
                         RendererCounts *counts, Error *error);
