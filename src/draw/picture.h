// SPDX-License-Identifier: MIT
// What the passes of one picture share: camera and lights, the hair and how it looks, and where the
// mesh is. Their pixels are the samples that the picture's pixels are the means of.
#pragma once

#include "draw/render_look.h"
#include "draw/render_mesh.h"
#include "draw/render_options.h"
#include "draw/render_scatter.h"

#include "glsl/draw/draw.h"

// A zeroed struct is empty.
typedef struct Picture {
    DrawParams draw; // with the values of the band that is being drawn
    const RenderItem *items;
    uint32_t item_count;
    Look *looks; // [look_room], owned: of the items
    uint32_t look_room;
    int mesh_box[4]; // samples: x, y lowest, highest; empty without a mesh
    int base_box[4]; // the same of mesh and floor
    ScatterTables scatter;
    GpuBuffer uniforms;
} Picture;

// How light becomes colour: a Tone, or TONE_LIGHT where pixels are light as it is.
int picture_display(const RendererOptions *options);

// What stands behind everything: light, premultiplied, and its opacity.
void picture_background(const RendererOptions *options, float light[4]);

// Begins another picture of `items`, which must stay until the next one. RESULT_FAILED if memory is
// short or marschner's table cannot be made.
Result picture_begin(Picture *picture, const RendererOptions *options, const RenderMesh *mesh,
                     const RenderFrame *frame, const RenderItem *items, uint32_t item_count,
                     Error *error);
void picture_destroy(Picture *picture);

// Gives `draw` to the shaders.
void picture_upload(Picture *picture);

// The middle of hair's style, carried by the head: m, world.
void picture_find_middle(const Picture *picture, const Hair *hair, vec3 middle);

// Segments of all items, before any is left out; strands that others stand for (LodOptions).
uint64_t picture_count_segments(const Picture *picture);
uint64_t picture_count_thinned(const Picture *picture);
