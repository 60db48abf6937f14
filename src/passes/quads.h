// SPDX-License-Identifier: MIT
// The quads rasteriser: ribbons are drawn as triangles, whose fragments go to an A-buffer. If the
// A-buffer cannot hold the whole image, it is drawn in bands of rows.
#pragma once

#include "draw/drawing.h"
#include "gpu/gpu.h"
#include "gpu/gpu_timer.h"
#include "passes/abuffer.h"
#include "passes/cull.h"
#include "passes/look_programs.h"

// Projects hair and draws its ribbons into the A-buffer.
typedef struct QuadRibbons {
    LookPrograms project;
    GLuint draw;                // program
    GLuint vertex_array;        // without attributes
    GpuBuffer edges, shades;    // a uvec4 per particle, see hair.vert
    GpuBuffer indices, command; // triangles, and their number: glDrawElementsIndirect
} QuadRibbons;

// A zeroed struct is empty.
typedef struct Quads {
    QuadRibbons hair;
    ABuffer abuffer;
    const GpuLimits *limits;
    int width, height; // px of the image
    int samples;       // per pixel side
    int band_rows;     // rows of the next image's first band
    Cull cull;
    bool unsettled; // not yet known whether the A-buffer held all of the image
    bool skips;     // strands are tested for visibility before projection
} Quads;

// RESULT_FAILED if memory is short. `gpu` must outlive the quads.
Result quads_create(Quads *quads, const Gpu *gpu, const RendererOptions *options, Error *error);
void quads_destroy(Quads *quads);

// Creates what drawing over a mesh needs, if missing.
Result quads_add_base(Quads *quads, Error *error);

// Draws the image's hair over the target's base, or over the background if `base` has no target,
// and begins to read the image back. Waits only if the image has several bands. `base`: the opaque
// surfaces. Adds to `counts`; quads_settle adds the rest. See renderer_begin.
Result quads_draw(Quads *quads, Drawing *drawing, RenderTarget *target, const CullBase *base,
                  GpuTimer *timer, RendererCounts *counts, Error *error);

// Checks that the image has all of its hair, and draws it again if not, with the same bindings and
// hair.
Result quads_settle(Quads *quads, Drawing *drawing, RenderTarget *target, bool over_mesh,
                    GpuTimer *timer, RendererCounts *counts, Error *error);

// Takes the image at `place` of the target. Waits for it.
Result quads_take(RenderTarget *target, int place, Image *image, Error *error);
