// SPDX-License-Identifier: MIT
// Data that all passes of one image share: camera, lights, the hair and its looks, and the place of
// the mesh. Needs OpenGL to make Marschner's tables and to upload uniform blocks. A pixel of a pass
// is a sample; pixels of the image are means of samples.
#pragma once

#include "draw/backdrop.h"
#include "draw/drawn_mesh.h"
#include "draw/look.h"
#include "draw/renderer_options.h"
#include "draw/scatter_tables.h"

#include "glsl/draw/draw.h"

// Begins with {.tables.stock = gpu->tables}.
typedef struct Drawing {
    DrawParams whole; // of the whole image
    DrawParams draw;  // of the band that is being drawn
    const RenderItem *items;
    uint32_t item_count;
    Look *looks; // [look_room], owned: one for each item
    uint32_t look_room;
    int mesh_box[4]; // samples: x, y lowest, highest; empty without a mesh
    int base_box[4]; // box of mesh and floor together; with a backdrop, of the whole image
    Backdrop backdrop;
    ScatterTables tables;
} Drawing;

// The conversion from light to colour: a Tone, or TONE_LIGHT if pixels keep linear light.
int drawing_display(const RendererOptions *options);

// A plain opaque background is a colour of the display, not light, so that it shows through thin
// hair as much as it would behind a transparent picture. With a tone curve it is the backing: hair,
// mesh and floor are drawn over nothing, and each pixel's tone-mapped colour is laid over the
// backing (tone_over in shared_math.h). Without a tone curve the background is light behind
// everything; the two ways differ only where light is brighter than white. An environment is light,
// too, and hides the backing.

// The light behind everything: linear RGB, premultiplied, and its opacity.
void drawing_background(const RendererOptions *options, float light[4]);

// The backing: linear RGB, and 1; all 0: none.
void drawing_backing(const RendererOptions *options, float color[4]);

// Begins a new image of `items`, which must stay valid until the next image begins. RESULT_FAILED
// if memory is short or Marschner's table cannot be made.
Result drawing_begin(Drawing *drawing, const RendererOptions *options, const DrawnMesh *mesh,
                     const RenderFrame *frame, const RenderItem *items, uint32_t item_count,
                     Error *error);
void drawing_destroy(Drawing *drawing);

// Uploads `draw` for the shaders.
void drawing_upload(Drawing *drawing);

// Restricts the drawing to a window of the image: `size` px from `place` on, which may extend
// beyond the image. Camera and boxes become those of the window. Call it after drawing_begin.
void drawing_set_window(Drawing *drawing, const RendererOptions *options, const DrawnMesh *mesh,
                        const int place[2], const int size[2]);

// The middle of an item's rest style, moved as its head is: m, world.
void drawing_find_middle(const RenderItem *item, vec3 middle);

// The number of segments of all items, before any is left out.
uint64_t drawing_count_segments(const Drawing *drawing);

// Fills in camera or lights for an image of this size; other members stay 0.
void drawing_set_view(DrawParams *draw, const View *view, int width, int height);
void drawing_set_lights(DrawParams *draw, const Light *lights, uint32_t count);

// Whether a light has a radius.
bool drawing_has_wide_lights(const DrawParams *draw);

// `radius`: fibre radius at the root, m. Members that depend on the batch's size stay 0.
MaterialParams drawing_material(const SectionParams *params, float radius);
