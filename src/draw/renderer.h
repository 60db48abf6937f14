// SPDX-License-Identifier: MIT
// The room draw turns hair into images. Its input is hair on the GPU (sim/hair.h), the view, lights
// and materials of a frame, and a mesh; its output is an Image. A backend (backend.h) makes shadow
// maps, light among hair, mesh and floor, and the hair. drawing.h has the data that the passes of
// an image share; docs/frame.md describes the passes.
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
    Image tile;              // owned; without pixels if there is only one tile
    const Gpu *gpu;
    GpuTimer *timer;
    const DrawBackend *backend;
    void *state; // of the backend, owned
    DrawnMesh mesh;
    DrawnHair *hair; // [hair_room], owned
    uint32_t hair_room;
    HairRead read;
    Drawing drawing;    // of the last image
    BackendFrame frame; // of the last image
    RendererCounts counts;
} Renderer;

// Chooses and creates the backend. `gpu` and `timer` must outlive the renderer, and the renderer
// must not be moved. The timer's spans are "draw_shadow", "draw_scatter", "draw_mesh",
// "draw_project"; of quads also "draw_hair", "draw_resolve" and "draw_read" (of the image); of
// blocks "draw_bin" and "draw_composite"; of compute "draw_bin", "draw_sort", "draw_composite" and
// "draw_read". RESULT_FAILED if memory is short.
Result renderer_create(Renderer *renderer, const Gpu *gpu, GpuTimer *timer,
                       const RendererOptions *options, Error *error);
void renderer_destroy(Renderer *renderer);

// Sets the mesh that hides hair, in the head's frame, and its colour (sRGB 0..1). The mesh is
// copied.
Result renderer_set_mesh(Renderer *renderer, const Mesh *mesh, const float color[3], Error *error);

// Moves the vertices of that mesh; call it after renderer_settle. `moved` has the same number of
// vertices, and normals, in the head's frame. The openness does not change.
void renderer_move_mesh(Renderer *renderer, const Mesh *moved);

// Sets the share of the sky that each vertex of the mesh sees (openness.h). Matt meshes do not need
// it.
Result renderer_set_openness(Renderer *renderer, const float (*open)[2], Error *error);

// Sets the factors of the mesh's colour at its vertices (scalp_tint.h). Errors as above.
Result renderer_set_tint(Renderer *renderer, const float (*tint)[3], Error *error);

// The channels of images: 3, or 4 if the background is not opaque.
int renderer_channels(const Renderer *renderer);

// Draws one image into `image`, which has the renderer's size and channels, and waits for it. Large
// images are drawn tile by tile (tiles.h). The order of items and of strands does not matter, and
// every run gives the same bytes. No fragment is lost: if an A-buffer or a list is too small it
// grows and the band is drawn again; at its largest size the image is drawn in more bands.
// RESULT_FAILED if memory is short or, with quads, if one row needs more than the largest A-buffer
// or a pixel has more fragments than a CPU driver's loops can visit.
Result renderer_draw(Renderer *renderer, const RenderFrame *frame, const RenderItem *items,
                     uint32_t item_count, Image *image, Error *error);

// renderer_draw in three steps, so that the next image can be begun while this one is on its way.
// renderer_begin queues an image; unless renderer_is_late, `image` is filled at once.
// renderer_settle must be called before hair or mesh changes: it waits until all has been drawn,
// and draws the image again if an A-buffer was too small. renderer_take is called after that,
// before or after the next renderer_begin: it waits for the image and copies it. `place` is the
// value of renderer_place before renderer_begin. Errors are those of renderer_draw.
Result renderer_begin(Renderer *renderer, const RenderFrame *frame, const RenderItem *items,
                      uint32_t item_count, Image *image, Error *error);
bool renderer_is_late(const Renderer *renderer);
int renderer_place(const Renderer *renderer);
Result renderer_settle(Renderer *renderer, Error *error);
Result renderer_take(Renderer *renderer, int place, Image *image, Error *error);
