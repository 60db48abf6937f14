// SPDX-License-Identifier: MIT
// The room draw turns hair into images. It takes hair on the GPU (sim/hair.h), the view, lights and
// materials of a frame, and a mesh; it hands on an Image. First come shadow maps (shadows.h) and
// the light among hair (hair_scatter.h), then mesh and floor (base_layer.h), then the hair by one
// of three rasterisers: blocks.h composites on the CPU, compute.h on the GPU, quads.h sends
// triangles into an A-buffer. drawing.h has what the passes of an image share.
#pragma once

#include "draw/base_layer.h"
#include "draw/blocks.h"
#include "draw/drawing.h"
#include "draw/hair_scatter.h"
#include "draw/renderer_options.h"
#include "draw/tiles.h"
#include "passes/compute.h"
#include "passes/quads.h"

typedef struct Renderer {
    RendererOptions options;
    Tiles tiles;          // of the image; one: it is drawn at once
    RendererOptions part; // the options with the size of a tile
    Image tile;           // owned; no pixels: there is one only
    const Gpu *gpu;
    GpuTimer *timer;
    RenderTarget target;
    Raster raster; // auto is decided
    Quads quads;
    Blocks blocks;
    Compute compute;
    Image *begun;   // of compute: the image that was begun last, not owned
    bool direct[2]; // of compute, by place: it is in its image already
    BaseLayer base;
    Shadows shadow;
    HairScatter scatter;
    Mesh mesh;             // a copy of its positions and triangles, for the light among hair
    ShadowCaster *casters; // [caster_room], owned
    uint32_t caster_room;
    Drawing drawing; // the last one
    RendererCounts counts;
} Renderer;

// Makes targets and shaders. `gpu` and `timer` outlive the renderer; spans "draw_mesh",
// "draw_project", and of quads "draw_hair", "draw_resolve" and "draw_read" (of the image), of
// blocks "draw_read" (of mesh and floor), "draw_bin" and "draw_composite", of compute "draw_bin",
// "draw_sort", "draw_composite" and "draw_read" (of the image). RESULT_FAILED if
// memory is short.
Result renderer_create(Renderer *renderer, const Gpu *gpu, GpuTimer *timer,
                       const RendererOptions *options, Error *error);
void renderer_destroy(Renderer *renderer);

// The mesh that hides hair, in the head's frame, and its colour (sRGB 0..1). Copied to the GPU.
Result renderer_set_mesh(Renderer *renderer, const Mesh *mesh, const float color[3], Error *error);

// The mesh's share of the sky (openness.h), [vertices of the mesh]; matt meshes do without.
Result renderer_set_openness(Renderer *renderer, const float *open, Error *error);

// 3, or 4 where the background is not opaque: what image_create must be given.
int renderer_channels(const Renderer *renderer);

// Draws one image, tile by tile where it is large (tiles.h), into `image`, which has the renderer's
// size and channels, and waits for it. The order of items and of strands does not matter, and every
// run gives the same bytes. No fragment is lost: an A-buffer that is too small grows and the band
// is drawn again; at its largest the image is drawn in more bands. RESULT_FAILED if memory is short
// or, with quads, a single row needs more than there can be or a pixel has more fragments than a
// CPU driver's loops can visit.
Result renderer_draw(Renderer *renderer, const RenderFrame *frame, const RenderItem *items,
                     uint32_t item_count, Image *image, Error *error);

// The same in three steps, so that the next image is begun while this one is on its way.
// renderer_begin queues an image, which is in `image` at once unless renderer_is_late.
// renderer_settle comes before hair or mesh changes: it waits until all has been drawn, and draws
// it again if an A-buffer was too small. renderer_take comes after that, before or after the next
// renderer_begin: it waits for the image, and copies it. `place`: what renderer_place has said
// before renderer_begin. Errors as above.
Result renderer_begin(Renderer *renderer, const RenderFrame *frame, const RenderItem *items,
                      uint32_t item_count, Image *image, Error *error);
bool renderer_is_late(const Renderer *renderer);
int renderer_place(const Renderer *renderer);
Result renderer_settle(Renderer *renderer, Error *error);
Result renderer_take(Renderer *renderer, int place, Image *image, Error *error);
