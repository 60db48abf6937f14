// SPDX-License-Identifier: MIT
// One studio for all tests of a program about the renderer; every claim is made of each rasteriser.
#pragma once

#include "support/studio.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

enum { SIDE = 256 }; // px, of the picture

extern const RendererOptions TRANSPARENT, BLACK;
extern Raster raster; // that draws now
extern Studio studio; // each test leaves it without hair

// A test that clears the studio behind it; runs all with quads and with blocks, with compute too,
// or with one alone, and gives how many failed.
#define CLAIM(name) cmocka_unit_test_teardown(name, clear_studio)
#define stage_run(tests)                                                                           \
    stage_run_count(tests, sizeof(tests) / sizeof(tests)[0], RASTER_QUADS, RASTER_BLOCKS)
#define stage_run_all(tests)                                                                       \
    stage_run_count(tests, sizeof(tests) / sizeof(tests)[0], RASTER_QUADS, RASTER_COMPUTE)
#define stage_run_one(tests, only)                                                                 \
    stage_run_count(tests, sizeof(tests) / sizeof(tests)[0], only, only)
int stage_run_count(const struct CMUnitTest *tests, size_t count, Raster first, Raster last);
int clear_studio(void **state);

// Opens the studio anew, in a new context.
void stage_open(const RendererOptions *options);

// A new renderer with these options and the rasteriser in turn; hair stays.
void use(const RendererOptions *options);

// A white strand of 5 vertices from `from` to `to` (px), `radius` in px. Its item's number.
uint32_t add_line(const float from[3], const float to[3], float radius, float opacity);

// Curved strands all over the picture, lit. `order` gives the place of each, NULL: as they are
// made.
void add_tangle(uint32_t count, float radius, float opacity, const uint32_t *order);

// The same of strands so bent and so short that no rasteriser leaves out a point of them: 1 px to
// either side of a straight line from point to point, 6 px apart.
void add_zigzags(uint32_t count, float radius, float opacity);

// So many strands through the middle, all in the same place.
Strands crowd(uint32_t count);

// What the backend of quads and compute has, or of blocks. Fails the test if another one draws.
struct Passes *stage_passes(void);
struct Lanes *stage_lanes(void);

// The times that mesh and floor were drawn, by any and by blocks.
uint64_t stage_base_version(void);
uint64_t stage_lanes_base_version(void);

// What 16 points of an item's hair showed in the last picture by blocks of the light among hair.
void stage_lanes_show(uint32_t item, const float x[3][STRAND_TILE],
                      const float tangent[3][STRAND_TILE], float seen[3][STRAND_TILE]);

// Blocks are to draw what mesh and floor hide, too.
void stage_lanes_draw_hidden(bool on);

// What lies around: nothing, a blue sky, or an environment that differs in all directions.
typedef enum StageSky { STAGE_DARK, STAGE_SKY, STAGE_ENVIRONMENT } StageSky;
Ambient stage_ambient(StageSky sky);

// Draws by these lights in such light, as studio_view shows it.
void stage_draw_lit(const Light *lights, uint32_t count, StageSky sky);

// Draws; a copy of the bytes, which the caller frees. Draws, and the bytes must be those.
uint8_t *draw_copy(size_t *size);
void assert_draws_the_same(const uint8_t *expected, size_t size);

// Draws nothing: the sum of opacity over the pixels of the last picture.
double alpha_sum(void);

// 0..255 for linear light of 0..1 (IEC 61966-2-1).
double srgb(double linear);

// Value i of an image of floats; value i of any image in levels of 255, light as sRGB.
float float_at(const Image *image, size_t i);
double level_at(const Image *image, size_t i);

// A mesh in the plane z = 0, `half` px to each side.
Mesh make_square(float half);
