// SPDX-License-Identifier: MIT
// A studio for tests of the renderer: every claim is tested with each rasteriser.
#pragma once

#include "support/studio.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

enum { SIDE = 256 }; // px, of the picture

extern const RendererOptions TRANSPARENT, BLACK;
extern Raster raster; // the current rasteriser
extern Studio studio; // without hair at the beginning of each test

// CLAIM: a test that clears the studio at its end. stage_run: runs all tests with quads and blocks,
// with compute, too, or with a single rasteriser, and returns the number of failures.
#define CLAIM(name) cmocka_unit_test_teardown(name, clear_studio)
#define stage_run(tests)                                                                           \
    stage_run_count(tests, sizeof(tests) / sizeof(tests)[0], RASTER_QUADS, RASTER_BLOCKS)
#define stage_run_all(tests)                                                                       \
    stage_run_count(tests, sizeof(tests) / sizeof(tests)[0], RASTER_QUADS, RASTER_COMPUTE)
#define stage_run_one(tests, only)                                                                 \
    stage_run_count(tests, sizeof(tests) / sizeof(tests)[0], only, only)
int stage_run_count(const struct CMUnitTest *tests, size_t count, Raster first, Raster last);
int clear_studio(void **state);

// Opens the studio again, with a new context.
void stage_open(const RendererOptions *options);

// Makes a new renderer with these options and the current rasteriser; hair stays.
void use(const RendererOptions *options);

// A white strand of 5 vertices from `from` to `to`; `radius` in px. Returns its item's number.
uint32_t add_line(const float from[3], const float to[3], float radius, float opacity);

// Curved strands all over the picture, lit. `order` gives the place of each strand; NULL: in the
// order of creation.
void add_tangle(uint32_t count, float radius, float opacity, const uint32_t *order);

// Like add_tangle, with strands so bent and short that no rasteriser leaves out a point: points are
// 6 px apart and 1 px to either side of a straight line.
void add_zigzags(uint32_t count, float radius, float opacity);

// `count` strands through the middle, all at the same place.
Strands crowd(uint32_t count);

// The state of the backend of quads and compute, and of blocks. Fails the test if another backend
// draws.
struct Passes *stage_passes(void);
struct Lanes *stage_lanes(void);

// The number of times that mesh and floor were drawn, by any backend and by blocks.
uint64_t stage_base_version(void);
uint64_t stage_lanes_base_version(void);

// The light of hair on skin (kernel/onto.h) in the cells of the last image; NULL if there is none.
const float (*stage_lanes_onto(void))[6][4];
size_t stage_lanes_cells(void);

// The light among hair that 16 points of an item's hair showed in the last picture of blocks.
void stage_lanes_show(uint32_t item, const float x[3][STRAND_TILE],
                      const float tangent[3][STRAND_TILE], float seen[3][STRAND_TILE]);

// Lets blocks also draw hair that mesh and floor hide.
void stage_lanes_draw_hidden(bool on);

// The ambient light: none, a blue sky, or an environment that differs in all directions.
typedef enum StageSky { STAGE_DARK, STAGE_SKY, STAGE_ENVIRONMENT } StageSky;
Ambient stage_ambient(StageSky sky);

// Draws with these lights and this ambient light, with studio_view.
void stage_draw_lit(const Light *lights, uint32_t count, StageSky sky);

// draw_copy draws and returns a copy of the bytes; the caller frees it. assert_draws_the_same draws
// and compares the bytes.
uint8_t *draw_copy(size_t *size);
void assert_draws_the_same(const uint8_t *expected, size_t size);

// The sum of opacity over the pixels of the last picture. Draws nothing.
double alpha_sum(void);

// The sRGB level, 0..255, of linear light 0..1 (IEC 61966-2-1).
double srgb(double linear);

// float_at: value i of an image of floats. level_at: value i of any image in levels of 255; light
// is converted to sRGB.
float float_at(const Image *image, size_t i);
double level_at(const Image *image, size_t i);

// A mesh in the plane z = 0, reaching `half` px to each side.
Mesh make_square(float half);
