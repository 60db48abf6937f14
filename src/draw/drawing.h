// SPDX-License-Identifier: MIT
// What the passes of one image share: camera and lights, the hair and how it looks, and where the
// mesh is. Needs OpenGL for marschner's tables and to be given to shaders. Their pixels are the
// samples that the image's pixels are the means of.
#pragma once

#include "draw/drawn_mesh.h"
#include "draw/look.h"
#include "draw/renderer_options.h"

#include "glsl/draw/draw.h"

// A zeroed struct is empty.
typedef struct Drawing {
    DrawParams whole; // of the image
    DrawParams draw;  // with the values of the band that is being drawn
    const RenderItem *items;
    uint32_t item_count;
    Look *looks; // [look_room], owned: of the items
    uint32_t look_room;
    int mesh_box[4];               // samples: x, y lowest, highest; empty without a mesh
    int base_box[4];               // the same of mesh and floor
    struct ScatterTables *scatter; // owned
} Drawing;

// How light becomes colour: a Tone, or TONE_LIGHT where pixels are light as it is.
int drawing_display(const RendererOptions *options);

// What stands behind everything: light, premultiplied, and its opacity.
void drawing_background(const RendererOptions *options, float light[4]);

// Begins another image of `items`, which must stay until the next one. RESULT_FAILED if memory is
// short or marschner's table cannot be made.
Result drawing_begin(Drawing *drawing, const RendererOptions *options, const DrawnMesh *mesh,
                     const RenderFrame *frame, const RenderItem *items, uint32_t item_count,
                     Error *error);
void drawing_destroy(Drawing *drawing);

// Gives `draw` to the shaders.
void drawing_upload(Drawing *drawing);

// From now on the drawing is of a window onto the image, from `place` on and of `size` px, which
// may hang over: camera and boxes are its own. After drawing_begin.
void drawing_set_window(Drawing *drawing, const RendererOptions *options, const DrawnMesh *mesh,
                        const int place[2], const int size[2]);

// The middle of hair's style, carried by the head: m, world.
void drawing_find_middle(const Drawing *drawing, const Hair *hair, vec3 middle);

// Segments of all items, before any is left out.
uint64_t drawing_count_segments(const Drawing *drawing);

// Camera and lights for an image of this size; the rest is left 0.
void drawing_set_view(DrawParams *draw, const View *view, int width, int height);
void drawing_set_lights(DrawParams *draw, const Light *lights, uint32_t count);

// `radius`: fibre radius at the root, m. The batch's size is left 0.
MaterialParams drawing_material(const SectionParams *params, float radius);
