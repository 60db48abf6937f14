// SPDX-License-Identifier: MIT
// The room draw turns hair into images. It takes hair on the GPU (sim/hair.h), the view, lights and
// materials of a frame, and a mesh; it hands on an Image. A backend (backend.h) does the work:
// shadow maps, light among hair, mesh and floor, then the hair. drawing.h has what the passes of an
// image share.
#pragma once

#include "draw/backend.h"
#include "draw/hair_read.h"
#include "draw/tiles.h"
#include "gpu/gpu.h"
#include "gpu/gpu_timer.h"

typedef struct Renderer {
    RendererOptions options; // `raster` is decided
    Tiles tiles;             // of the image; one: it is drawn at once
    RendererOptions part;    // the options with the size of a tile
    Image tile;              // owned; no pixels: there is one only
    const Gpu *gpu;
    GpuTimer *timer;
    const DrawBackend *backend;
    void *state; // of the backend, owned
    DrawnMesh mesh;
    DrawnHair *hair; // [hair_room], owned
    uint32_t hair_room;
    HairRead read;
    Drawing drawing;    // the last one
    BackendFrame frame; // the same
    RendererCounts counts;
} Renderer;

// Makes what the backend needs. `gpu` and `timer` outlive the renderer, which stays where it is;
// spans "draw_shadow", "draw_scatter", "draw_mesh", "draw_project", and of quads "draw_hair",
// "draw_resolve" and "draw_read" (of the image), of blocks "draw_bin" and "draw_composite", of
// compute "draw_bin", "draw_sort", "draw_composite" and "draw_read". RESULT_FAILED if memory is
// short.
Result renderer_create(Renderer *renderer, const Gpu *gpu, GpuTimer *timer,
                       const RendererOptions *options, Error *error);
void renderer_destroy(Renderer *renderer);

// The mesh that hides hair, in the head's frame, and its colour (sRGB 0..1). Copied to the GPU.
Result renderer_set_mesh(Renderer *renderer, const Mesh *mesh, const float color[3], Error *error);

// Moves the vertices of that mesh, after renderer_settle: `moved` has as many, with normals, in the
// head's frame. What the mesh sees of the sky stays.
void renderer_move_mesh(Renderer *renderer, const Mesh *moved);

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
