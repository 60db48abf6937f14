// SPDX-License-Identifier: MIT
// The layers of tractrix-render's EXR files equal what --aov draws, by both rasterisers.
#include "base/bytes.h"
#include "image/pfm.h"
#include "support/temporary.h"

#include <openexr.h>

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { WIDTH = 48, HEIGHT = 36, PIXELS = WIDTH * HEIGHT };

static void render(void **state, const char *arguments, const char *name)
{
    char line[1500];
    const char *programs = getenv("TRACTRIX_BIN");
    snprintf(line, sizeof line,
             "%s/tractrix-render assets/fur.tfx --look plain --followers 0 --frames 2 --first 1 %s "
             "--size %dx%d -q -o '%s'",
             programs ? programs : "out/release", arguments, WIDTH, HEIGHT,
             temporary_path(state, name));
    assert_int_equal(system(line), 0);
}

// A channel of a scanline file, as 32-bit floats or integers.
static void read_channel(const char *path, const char *name, exr_pixel_type_t type, void *numbers)
{
    exr_context_initializer_t start = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_context_t context;
    int32_t lines;
    bool found = false;
    assert_int_equal(exr_start_read(&context, path, &start), EXR_ERR_SUCCESS);
    assert_int_equal(exr_get_scanlines_per_chunk(context, 0, &lines), EXR_ERR_SUCCESS);
    for (int y = 0; y < HEIGHT; y += lines) {
        exr_chunk_info_t chunk;
        exr_decode_pipeline_t pipeline = EXR_DECODE_PIPELINE_INITIALIZER;
        assert_int_equal(exr_read_scanline_chunk_info(context, 0, y, &chunk), EXR_ERR_SUCCESS);
        assert_int_equal(exr_decoding_initialize(context, 0, &chunk, &pipeline), EXR_ERR_SUCCESS);
        for (int c = 0; c < pipeline.channel_count; ++c) {
            exr_coding_channel_info_t *channel = &pipeline.channels[c];
            if (strcmp(channel->channel_name, name) != 0) continue;
            found = true;
            channel->user_data_type = (uint16_t)type;
            channel->user_bytes_per_element = channel->user_pixel_stride = 4;
            channel->user_line_stride = 4 * WIDTH;
            channel->decode_to_ptr = (uint8_t *)numbers + (size_t)(4 * WIDTH * y);
        }
        exr_decoding_choose_default_routines(context, 0, &pipeline);
        assert_int_equal(exr_decoding_run(context, 0, &pipeline), EXR_ERR_SUCCESS);
        exr_decoding_destroy(context, &pipeline);
    }
    exr_finish(&context);
    assert_true(found);
}

static Image read_aov(void **state, const char *raster, const char *word)
{
    char arguments[100];
    Image image;
    Bytes file;
    snprintf(arguments, sizeof arguments, "--raster %s --aov %s", raster, word);
    render(state, arguments, "aov.pfm");
    assert_int_equal(bytes_read_file(&file, temporary_path(state, "aov.pfm"), NULL), RESULT_OK);
    assert_int_equal(pfm_decode(&image, &file, "aov.pfm", NULL), RESULT_OK);
    bytes_destroy(&file);
    return image;
}

// A half float has 11 bits: numbers up to 1 err by 2^-12 at most.
static const float HALF_STEP = 1.0f / 4096;

static void assert_layers(void **state, const char *raster)
{
    char arguments[100], exr[300];
    static float numbers[3][PIXELS];
    static uint32_t ids[PIXELS];
    static bool hair[PIXELS];
    int seen = 0, lost = 0;
    // the result of temporary_path is overwritten later
    snprintf(exr, sizeof exr, "%s", temporary_path(state, "x.exr"));
    snprintf(arguments, sizeof arguments, "--raster %s", raster);
    render(state, arguments, "x.exr");
    Image depth = read_aov(state, raster, "depth"), coverage = read_aov(state, raster, "coverage"),
          tangent = read_aov(state, raster, "tangent"), strand = read_aov(state, raster, "strand");
    const float *d = (const float *)(void *)depth.pixels,
                *c = (const float *)(void *)coverage.pixels,
                *t = (const float *)(void *)tangent.pixels,
                *s = (const float *)(void *)strand.pixels;
    read_channel(exr, "Z", EXR_PIXEL_FLOAT, numbers[0]);
    for (int i = 0; i < PIXELS; ++i) {
        hair[i] = d[3 * i] > 0 && t[3 * i] + t[3 * i + 1] + t[3 * i + 2] > 0 &&
                  s[3 * i] + s[3 * i + 1] + s[3 * i + 2] > 0;
        assert_true(numbers[0][i] == (hair[i] ? d[3 * i] : 0));
        seen += hair[i];
        lost += !hair[i] && d[3 * i] > 0;
    }
    assert_true(seen > PIXELS / 20 && seen < PIXELS && lost < seen / 100);
    read_channel(exr, "coverage", EXR_PIXEL_FLOAT, numbers[0]);
    for (int i = 0; i < PIXELS; ++i) assert_true(fabsf(numbers[0][i] - c[3 * i]) <= HALF_STEP);
    read_channel(exr, "id", EXR_PIXEL_UINT, ids);
    for (int i = 0; i < PIXELS; ++i) {
        for (int k = 0; k < 3; ++k)
            assert_int_equal(ids[i] >> (8 * k) & 255, hair[i] ? lroundf(255 * s[3 * i + k]) : 0);
    }
    read_channel(exr, "tangent.X", EXR_PIXEL_FLOAT, numbers[0]);
    read_channel(exr, "tangent.Y", EXR_PIXEL_FLOAT, numbers[1]);
    read_channel(exr, "tangent.Z", EXR_PIXEL_FLOAT, numbers[2]);
    for (int i = 0; i < PIXELS; ++i) {
        float length = 0, drawn = 0;
        for (int k = 0; k < 3; ++k) length += numbers[k][i] * numbers[k][i];
        for (int k = 0; k < 3; ++k) drawn += (2 * t[3 * i + k] - 1) * (2 * t[3 * i + k] - 1);
        // Each of three numbers is rounded: the square errs by 2 sqrt(3) steps at most.
        assert_true(hair[i] ? fabsf(length - 1) <= 2 * sqrtf(3) * HALF_STEP : length == 0);
        for (int k = 0; k < 3 && hair[i]; ++k)
            assert_true(fabsf(numbers[k][i] - (2 * t[3 * i + k] - 1) / sqrtf(drawn)) <= HALF_STEP);
    }
    image_destroy(&depth), image_destroy(&coverage);
    image_destroy(&tangent), image_destroy(&strand);
}

static void blocks_draw_all_layers(void **state)
{
    assert_layers(state, "blocks");
}

static void quads_draw_all_layers(void **state)
{
    assert_layers(state, "quads");
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, temporary_create, temporary_destroy)

int main(void)
{
    const struct CMUnitTest tests[] = {TEST(blocks_draw_all_layers), TEST(quads_draw_all_layers)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
