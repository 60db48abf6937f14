// SPDX-License-Identifier: MIT
// Which rasteriser is chosen, and how quads combine the fragments of a pixel.
#include "draw/drawing.h"
#include "support/stage.h"

#include "glsl/common/shared_math.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void open_studio(Raster asked, Oit oit, int layers)
{
    RendererOptions options = BLACK;
    options.raster = asked;
    options.oit = oit;
    options.oit_layers = layers;
    studio_set_options(&studio, &options);
}

static void the_driver_chooses_the_rasteriser(void **state)
{
    (void)state;
    open_studio(RASTER_AUTO, OIT_AUTO, 0);
    bool hardware = studio.gpu.kind == GPU_HARDWARE;
    assert_int_equal(studio.renderer.options.raster, hardware ? RASTER_COMPUTE : RASTER_BLOCKS);
    GpuKind kind = studio.gpu.kind;
    for (studio.gpu.kind = 0; studio.gpu.kind < GPU_KINDS; ++studio.gpu.kind) {
        open_studio(RASTER_AUTO, OIT_AUTO, 0);
        hardware = studio.gpu.kind == GPU_HARDWARE;
        assert_int_equal(studio.renderer.options.raster, hardware ? RASTER_COMPUTE : RASTER_BLOCKS);
    }
    studio.gpu.kind = kind;
    for (Raster asked = RASTER_QUADS; asked <= RASTER_COMPUTE; ++asked) {
        open_studio(asked, OIT_AUTO, 0);
        assert_int_equal(studio.renderer.options.raster, asked);
    }
    open_studio(RASTER_AUTO, OIT_NONE, 0); // the other rasterisers have one order only
    assert_int_equal(studio.renderer.options.raster, RASTER_QUADS);
    open_studio(RASTER_AUTO, OIT_ABUFFER, 0);
    assert_int_equal(studio.renderer.options.raster, RASTER_QUADS);
    open_studio(RASTER_AUTO, OIT_AUTO, 12);
    assert_int_equal(studio.renderer.options.raster, RASTER_QUADS);
}

enum { STACK = 12, COLORS = 3 };
static const double OPACITY = 0.2;
static const float COLOR[COLORS][3] = {{0.9f, 0.2f, 0.1f}, {0.1f, 0.6f, 0.2f}, {0.2f, 0.1f, 0.8f}};

// Wide bands one behind the other, a third of them in each colour.
static void add_stack(void)
{
    enum { EACH = STACK / COLORS };
    for (int c = 0; c < COLORS; ++c) {
        float position[EACH][2][3];
        for (int i = 0; i < EACH; ++i)
            for (int j = 0; j < 2; ++j)
                memcpy(position[i][j], (float[3]){j ? 60 : -60, 0, (float)-(c * EACH + i)},
                       sizeof(float[3]));
        Strands strands = studio_strands(EACH, 2, (const float(*)[3])position);
        uint32_t item = studio_add(&studio, &strands, 6, (float)OPACITY);
        memcpy(studio.material[item].color, COLOR[c], sizeof COLOR[c]);
        strands_destroy(&strands);
    }
}

// Expected value of channel k: the `ordered` nearest bands over one another, and under them all
// others as one band of their mean colour and total transparency.
static double expect(int ordered, int k)
{
    double sum = 0, rest = 0, through = 1, hidden = 1 - pow(1 - OPACITY, STACK - ordered);
    for (int i = 0; i < STACK; ++i) {
        double color = linear_from_srgb(COLOR[i * COLORS / STACK][k]);
        if (i >= ordered) {
            rest += color / (STACK - ordered);
            continue;
        }
        sum += through * OPACITY * color;
        through *= 1 - OPACITY;
    }
    return sum + through * hidden * rest;
}

// Fragments are half floats: one level is allowed, including rounding.
static void so_many_layers_are_in_order(void **state)
{
    (void)state;
    static const int counts[] = {0, 1, 2, 4, 6, 8, 12, 64};
    assert_true(fabs(srgb(expect(0, 0)) - srgb(expect(STACK, 0))) > 20); // order matters here
    add_stack();
    for (size_t c = 0; c < sizeof counts / sizeof *counts; ++c) {
        open_studio(RASTER_QUADS, counts[c] ? OIT_ABUFFER : OIT_NONE, counts[c]);
        studio_draw(&studio);
        const uint8_t *pixel = studio_pixel(&studio, SIDE / 2, SIDE / 2);
        for (int k = 0; k < 3; ++k) {
            double expected = srgb(expect(counts[c] < STACK ? counts[c] : STACK, k));
            if (fabs(pixel[k] - expected) > 1)
                fail_msg("%d in order, channel %d: %d instead of %g", counts[c], k, pixel[k],
                         expected);
        }
    }
}

// Wide white bands one behind the other, none of them in order.
static int draw_rest(int count, float opacity)
{
    float(*position)[2][3] = calloc((size_t)count, sizeof *position);
    assert_non_null(position);
    for (int i = 0; i < count; ++i)
        for (int j = 0; j < 2; ++j)
            memcpy(position[i][j], (float[3]){j ? 60 : -60, 0, -0.1f * (float)i}, sizeof(float[3]));
    Strands strands = studio_strands((uint32_t)count, 2, (const float(*)[3])position);
    uint32_t item = studio_add(&studio, &strands, 6, opacity);
    memcpy(studio.material[item].color, (float[3]){1, 1, 1}, sizeof(float[3]));
    strands_destroy(&strands);
    free(position);
    open_studio(RASTER_QUADS, OIT_NONE, 0);
    studio_draw(&studio);
    return *studio_pixel(&studio, SIDE / 2, SIDE / 2);
}

// Expected: 1 - 0.997^200 of the light. Each fragment's optical depth, 0.00433, is accurate to
// 1/8192: 3 %.
static void faint_fragments_add_up(void **state)
{
    (void)state;
    assert_true(fabs(draw_rest(200, 0.003f) - srgb(1 - pow(0.997, 200))) <= 3);
}

// Two ribbons at the same place that differ only in blue: the image does not depend on their order.
static void equal_depths_are_ordered_by_all_of_the_colour(void **state)
{
    (void)state;
    const float position[2][3] = {{-60, 0, 0}, {60, 0, 0}};
    uint8_t seen[2][3];
    for (int swapped = 0; swapped < 2; ++swapped) {
        for (int i = 0; i < 2; ++i) {
            Strands strands = studio_strands(1, 2, position);
            uint32_t item = studio_add(&studio, &strands, 6, 0.5f);
            memcpy(studio.material[item].color, (float[3]){1, 1, i == swapped ? 1 : 0},
                   sizeof(float[3]));
            strands_destroy(&strands);
        }
        open_studio(RASTER_QUADS, OIT_ABUFFER, 4);
        studio_draw(&studio);
        memcpy(seen[swapped], studio_pixel(&studio, SIDE / 2, SIDE / 2), 3);
        studio_clear(&studio);
    }
    assert_memory_equal(seen[0], seen[1], 3);
    assert_true(seen[0][2] > 100 && seen[0][2] < 250); // both colours contribute
}

static void together_they_can_hide_all(void **state)
{
    (void)state;
    assert_in_range(draw_rest(12, 0.9f), 254, 255);
}

// 30,000 opaque fragments of the brightest light in one pixel: their sums do not overflow.
static void sums_of_very_many_bright_fragments_are_whole(void **state)
{
    (void)state;
    enum { COUNT = 30000 };
    static const float bright[3] = {3, 0.5f, 0.1f}; // sRGB: 13 times white, a fifth, a hundredth
    RendererOptions options = BLACK;
    options.width = options.height = 1;
    options.raster = RASTER_QUADS;
    options.oit = OIT_NONE;
    studio_set_options(&studio, &options);
    Strands strands = crowd(COUNT);
    uint32_t item = studio_add(&studio, &strands, 0.6f, 0.99f);
    memcpy(studio.material[item].color, bright, sizeof bright);
    studio_draw(&studio);
    const uint8_t *pixel = studio_pixel(&studio, 0, 0);
    assert_true(studio.renderer.counts.fragments >= COUNT);
    assert_int_equal(pixel[0], 255);
    for (int k = 1; k < 3; ++k) assert_true(abs(pixel[k] - (int)lroundf(255 * bright[k])) <= 2);
    strands_destroy(&strands);
}

static int open_stage(void **state)
{
    (void)state;
    stage_open(&BLACK);
    return 0;
}

static int close_stage(void **state)
{
    (void)state;
    studio_close(&studio);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        CLAIM(the_driver_chooses_the_rasteriser),
        CLAIM(so_many_layers_are_in_order),
        CLAIM(sums_of_very_many_bright_fragments_are_whole),
        CLAIM(faint_fragments_add_up),
        CLAIM(together_they_can_hide_all),
        CLAIM(equal_depths_are_ordered_by_all_of_the_colour),
    };
    return cmocka_run_group_tests(tests, open_stage, close_stage);
}
