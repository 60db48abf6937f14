// SPDX-License-Identifier: MIT
// Draws hair in tests: strands are given in pixels of the image.
#pragma once

#include "draw/renderer.h"

enum { STUDIO_MAX_ITEMS = 4 };

// What a test draws: strands of one material each. World and picture agree in the plane z = 0: x to
// the right and y up from the picture's middle, one unit a pixel; the eye stands at z = 1000.
// Without lights a strand has its colour, everywhere.
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

// Fails the test on any error, a missing OpenGL included.
void studio_open(Studio *studio, const RendererOptions *options);
void studio_close(Studio *studio);

// A new renderer in the same context; hair stays.
void studio_set_options(Studio *studio, const RendererOptions *options);

// Adds hair of one radius (px) and opacity, plain white; more by studio->material[its number].
// Returns the number.
uint32_t studio_add(Studio *studio, const Strands *strands, float radius, float opacity);

// What studio_add gives new hair: white everywhere, without lights, of one radius from root to tip.
void studio_make_plain(SectionParams *material, float opacity);

// Takes all hair away.
void studio_clear(Studio *studio);

// Draws to studio->image, as studio_view shows it or another view.
void studio_draw(Studio *studio);
void studio_draw_view(Studio *studio, const View *view);

// The view of which the above is true.
void studio_view(View *view, int width, int height);

// Pixel (column, row) of the image, row 0 on top.
const uint8_t *studio_pixel(const Studio *studio, int x, int y);

// Bytes of the last picture. The caller frees them.
uint8_t *studio_copy(const Studio *studio, size_t *size);

// Strands of equal vertex counts from positions in one array. The caller destroys them.
Strands studio_strands(uint32_t strand_count, uint32_t vertex_count, const float (*position)[3]);

// `count` strands of `vertices` each that wind through a square of `side` px around the picture's
// middle: `step` px from vertex to vertex, their direction turned by about `bend` at each. `order`
// gives the place of each, NULL: as they are made. The caller destroys them.
Strands studio_tangle(uint64_t seed, double side, uint32_t count, uint32_t vertices, double step,
                      double bend, const uint32_t *order);
