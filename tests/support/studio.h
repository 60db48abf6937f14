// SPDX-License-Identifier: MIT
// Draws hair in tests: strands are given in pixels of the image.
#pragma once

#include "draw/renderer.h"

enum { STUDIO_MAX_ITEMS = 4 };

// The scene that a test draws; strands of each item have one material. In the plane z = 0 the world
// agrees with the picture: x to the right and y up from the picture's centre, one unit for a pixel;
// the eye is at z = 1000. Without lights a strand has its own colour everywhere.
typedef struct Studio {
    Gpu gpu;
    GpuTimer timer;
    Renderer renderer;
    Hair hair[STUDIO_MAX_ITEMS];
    SectionParams material[STUDIO_MAX_ITEMS];
    RenderItem items[STUDIO_MAX_ITEMS];
    uint32_t count;
    Light light; // used if its intensity is not 0
    Image image;
} Studio;

// Fails the test on any error, also if there is no OpenGL.
void studio_open(Studio *studio, const RendererOptions *options);
void studio_close(Studio *studio);

// Makes a new renderer in the same context; hair stays.
void studio_set_options(Studio *studio, const RendererOptions *options);

// Adds hair with one radius (px) and opacity, plain white. Other properties can be set in
// studio->material[number]. Returns the number.
uint32_t studio_add(Studio *studio, const Strands *strands, float radius, float opacity);

// The material of new hair: white, without lights, with one radius from root to tip.
void studio_make_plain(SectionParams *material, float opacity);

// Removes all hair.
void studio_clear(Studio *studio);

// Draws to studio->image with studio_view or with another view.
void studio_draw(Studio *studio);
void studio_draw_view(Studio *studio, const View *view);

// The view for which the statement at Studio is true.
void studio_view(View *view, int width, int height);

// Pixel (column, row) of the image, row 0 on top.
const uint8_t *studio_pixel(const Studio *studio, int x, int y);

// The rounding errors of half floats and of levels, in units of a CPU driver's: 1, and 2 on a GPU,
// which may round towards zero (an NVIDIA H200 does).
int studio_rounding(const Studio *studio);

// A copy of the last picture's bytes. The caller frees it.
uint8_t *studio_copy(const Studio *studio, size_t *size);

// Strands of equal vertex counts from positions in one array. The caller destroys them.
Strands studio_strands(uint32_t strand_count, uint32_t vertex_count, const float (*position)[3]);

// `count` strands with `vertices` each that wind through a square of `side` px around the picture's
// centre: `step` px from vertex to vertex, with their direction rotated by about `bend` at each.
// `order` gives the place of each strand; NULL: in the order of creation. The caller destroys them.
Strands studio_tangle(uint64_t seed, double side, uint32_t count, uint32_t vertices, double step,
                      double bend, const uint32_t *order);
