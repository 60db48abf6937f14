// SPDX-License-Identifier: MIT
// The rasteriser of GPUs: ribbons as triangles, whose fragments go to an A-buffer, in bands of rows
// where that cannot hold the whole image's.
#pragma once

#include "draw/abuffer.h"
#include "draw/cull.h"
#include "draw/drawing.h"
#include "gpu/gpu.h"
#include "gpu/gpu_timer.h"

// What projects hair and sends its ribbons to the A-buffer.
typedef struct QuadRibbons {
    LookPrograms project;
    GLuint draw;                // program
    GLuint vertex_array;        // without attributes
    GpuBuffer edges, shades;    // uvec4 a particle, see hair.vert
    GpuBuffer indices, command; // triangles, and how many of them: glDrawElementsIndirect
    GpuBuffer material;
} QuadRibbons;

// A zeroed struct has nothing, and no limits.
typedef struct Quads {
    QuadRibbons hair;
    ABuffer abuffer;
    const GpuLimits *limits;
    int width, height; // px of the image
    int samples;       // across a pixel
    int band_rows;     // that the next image starts with
    Cull cull;
    bool skips; // strands are looked through before they are projected
} Quads;

// RESULT_FAILED if memory is short. `gpu` outlives the quads.
Result quads_create(Quads *quads, const Gpu *gpu, const RendererOptions *options, Error *error);
void quads_destroy(Quads *quads);

// Makes what drawing over a mesh needs; nothing if it is there.
Result quads_add_base(Quads *quads, Error *error);

// Draws the image's hair over the target's base, or over the background if `over_mesh` is false,
// and copies it into `image`; waits for it. `base`: what is opaque. What it does is added to
// `counts`. See renderer_draw.
Result quads_draw(Quads *quads, Drawing *drawing, RenderTarget *target, const CullBase *base,
                  GpuTimer *timer, Image *image, RendererCounts *counts, Error *error);
