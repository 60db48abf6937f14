// SPDX-License-Identifier: MIT
// From linear light to output: tone curves, floats, PFM files, auxiliary images.
#include "image/pfm.h"
#include "image/png.h"
#include "image/tone.h"
#include "support/studio.h"
#include "support/temporary.h"

#include "glsl/common/shared_math.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#define NEEDED(call)                                                                               \
    do {                                                                                           \
        Error why_ = {{0}}, *error = &why_;                                                        \
        if ((call) != RESULT_OK) fail_msg("%s", why_.text);                                        \
    } while (0)

enum { SIDE = 64, MIDDLE = SIDE / 2 };

static Studio studio;
static Raster raster; // the rasteriser under test

static int open_studio(void **state)
{
    (void)state;
    studio_open(&studio, &(RendererOptions){.width = SIDE, .height = SIDE});
    return 0;
}

static int close_studio(void **state)
{
    (void)state;
    studio_close(&studio);
    return 0;
}

static void use(RendererOptions options)
{
    options.width = options.height = SIDE;
    options.raster = raster;
    studio_set_options(&studio, &options);
}

// A band along x through the middle of the image, white times `light`, at height z.
static void add_band(float light, float opacity, float z)
{
    const float position[2][3] = {{-50, 0, z}, {50, 0, z}};
    Strands strands = studio_strands(1, 2, position);
    uint32_t i = studio_add(&studio, &strands, 8, opacity);
    studio.material[i].ambient = light;
    strands_destroy(&strands);
}

static void draw(void)
{
    studio_draw(&studio);
    studio_clear(&studio);
}

static float float_at(int x, int y, int channel)
{
    float value;
    size_t i = ((size_t)y * SIDE + (size_t)x) * (size_t)studio.image.channels + (size_t)channel;
    memcpy(&value, studio.image.pixels + 4 * i, sizeof value);
    return value;
}

static double level(double linear)
{
    return 255 * image_srgb_from_linear(linear);
}

// Expected values by hand from the published formulas: c (1 + c/16) / (1 + c); (2.51 c^2 + 0.03 c)
// / (2.43 c^2 + 0.59 c + 0.14).
static void tones_are_those_of_their_papers(void **state)
{
    (void)state;
    static const double filmic[][2] = {{0.18, 0.086724 / 0.324932}, {1, 2.54 / 3.16}};
    assert_true(fabs(tone_map(TONE_REINHARD, 1) - 0.53125) < 1e-9);
    assert_true(fabs(tone_map(TONE_REINHARD, 4) - 1) < 1e-12);
    for (int i = 0; i < 2; ++i) {
        assert_true(fabs(tone_map(TONE_FILMIC, filmic[i][0]) - filmic[i][1]) < 1e-9);
        assert_true(fabs((double)tone_filmic((float)filmic[i][0]) - filmic[i][1]) < 1e-6);
    }
}

static void bright_light_is_rolled_off_and_the_background_stays(void **state)
{
    (void)state;
    for (Tone tone = TONE_NONE; tone <= TONE_FILMIC; ++tone) {
        use((RendererOptions){
            .tone = tone, .exposure = 1, .background = {100 / 255.0f, 100 / 255.0f, 1, 1}});
        add_band(0.75f, 1, 0);
        draw();
        double expected = level(fmin(tone_map(tone, 1.5), 1));
        assert_true(fabs(studio_pixel(&studio, MIDDLE, MIDDLE)[0] - expected) < 0.7);
        const uint8_t *beside = studio_pixel(&studio, MIDDLE, MIDDLE + 9);
        assert_int_equal(beside[0], 100);
        assert_int_equal(beside[2], 255);
    }
}

// Hair with an opacity of 1/2 shows half of a white background: its own tone-mapped colour, clipped
// at white, is mixed with white. Without a tone curve light is added to light before it is clipped.
// Coverage has steps of 1/4095 (quads: half floats), so the colour is off by less than 0.1 levels.
static void half_of_a_background_shows_through_half_transparent_hair(void **state)
{
    (void)state;
    static const float lights[] = {0.02f, 0.75f, 3}; // the last one is beyond white
    for (Tone tone = TONE_NONE; tone <= TONE_FILMIC; ++tone)
        for (int i = 0; i < 3; ++i) {
            use((RendererOptions){.tone = tone, .exposure = 1, .background = {1, 1, 1, 1}});
            add_band(lights[i], 0.5f, 0);
            draw();
            double own = tone_map(tone, 2 * (double)lights[i]),
                   expected = level(tone == TONE_NONE ? fmin(0.5 * own + 0.5, 1)
                                                      : 0.5 * fmin(own, 1) + 0.5),
                   shown = studio_pixel(&studio, MIDDLE, MIDDLE)[0];
            if (!(fabs(shown - expected) < 0.6))
                fail_msg("tone %d, light %g: %g, expected %.2f", (int)tone, (double)lights[i],
                         shown, expected);
        }
}

static void floats_are_premultiplied_light(void **state)
{
    (void)state;
    use((RendererOptions){.kind = IMAGE_FLOAT, .background = {0, 0, 0, 0}});
    add_band(3, 0.5f, 0);
    draw();
    assert_true(fabsf(float_at(MIDDLE, MIDDLE, 0) - 1.5f) < 1e-3f); // half floats: 11 bits
    assert_true(fabsf(float_at(MIDDLE, MIDDLE, 3) - 0.5f) < 1e-3f);
    assert_true(float_at(MIDDLE, 2, 0) == 0 && float_at(MIDDLE, 2, 3) == 0);
}

static void sixteen_bits_are_finer_than_eight(void **state)
{
    (void)state;
    use((RendererOptions){.kind = IMAGE_16, .background = {0, 0, 0, 1}});
    add_band(0.2f, 1, 0);
    draw();
    uint16_t sample;
    memcpy(&sample, studio.image.pixels + 6 * (MIDDLE * SIDE + MIDDLE), sizeof sample);
    assert_true(fabs(sample - 257 * level(0.2)) < 30); // the spacing of half floats there is 33
    Image read;
    Bytes png;
    const char *path = temporary_path(state, "deep.png");
    NEEDED(png_write(path, &studio.image, error));
    NEEDED(png_encode(&studio.image, NULL, &png, error));
    assert_int_equal(png.data[24], 16);
    bytes_destroy(&png);
    NEEDED(png_read(&read, path, error)); // read as 8 bits: the upper byte
    for (size_t i = 0; i < SIDE * SIDE * 3; ++i) {
        memcpy(&sample, studio.image.pixels + 2 * i, sizeof sample);
        assert_int_equal(read.pixels[i], sample >> 8);
    }
    image_destroy(&read);
}

static void pfm_has_rows_from_below(void **state)
{
    (void)state;
    Image image;
    Bytes pfm;
    NEEDED(image_create_kind(&image, 2, 2, 4, IMAGE_FLOAT, error));
    for (int i = 0; i < 16; ++i) {
        float value = (float)i;
        memcpy(image.pixels + 4 * i, &value, 4);
    }
    NEEDED(pfm_encode(&image, &pfm, error));
    const char header[] = "PF\n2 2\n-1.0\n";
    // little-endian, as on this machine
    const float expected[12] = {8, 9, 10, 12, 13, 14, 0, 1, 2, 4, 5, 6};
    assert_int_equal(pfm.size, sizeof header - 1 + sizeof expected);
    assert_memory_equal(pfm.data, header, sizeof header - 1);
    assert_memory_equal(pfm.data + sizeof header - 1, expected, sizeof expected);
    bytes_destroy(&pfm);
    image_destroy(&image);
}

// Warmer strands lose as much blue as they gain red; brighter strands gain in all channels.
static void warmth_keeps_the_sum_of_red_and_blue(void **state)
{
    (void)state;
    use((RendererOptions){.exposure = 1, .kind = IMAGE_FLOAT});
    const float position[2][3] = {{-50, 0, 0}, {50, 0, 0}};
    Strands strands = studio_strands(1, 2, position);
    uint32_t i = studio_add(&studio, &strands, 8, 1);
    studio.material[i].ambient = 0.5f;
    studio.material[i].warmth_variation = 0.5f;
    draw();
    float red = float_at(MIDDLE, MIDDLE, 0), green = float_at(MIDDLE, MIDDLE, 1),
          blue = float_at(MIDDLE, MIDDLE, 2);
    assert_true(fabsf(red - blue) > 0.02f * green);
    assert_true(fabsf(red + blue - 2 * green) < 2e-3f * green);
    strands_destroy(&strands);
}

// Draws two bands; the nearer is half transparent, which only coverage shows.
static void draw_aov(Aov aov, ImageKind kind, float near, float far)
{
    use((RendererOptions){.aov = aov, .kind = kind, .depth_range = {near, far}});
    add_band(5, 0.5f, 10);
    add_band(5, 0.5f, -10);
    draw();
}

static void aovs_are_what_they_are_said_to_be(void **state)
{
    (void)state;
    draw_aov(AOV_COVERAGE, IMAGE_8, 0, 0);
    assert_in_range(studio_pixel(&studio, MIDDLE, MIDDLE)[1], 191, 192); // 1 - (1 - 1/2)^2
    assert_int_equal(studio_pixel(&studio, MIDDLE, 2)[1], 0);
    draw_aov(AOV_TANGENT, IMAGE_8, 0, 0);
    const uint8_t *tangent = studio_pixel(&studio, MIDDLE, MIDDLE);
    assert_int_equal(tangent[0], 255);
    assert_in_range(tangent[1], 127, 128);
    draw_aov(AOV_DEPTH, IMAGE_FLOAT, 0, 0);
    assert_true(fabsf(float_at(MIDDLE, MIDDLE, 0) - 990) < 0.01f);
    assert_true(float_at(MIDDLE, 2, 0) == 0);
    draw_aov(AOV_DEPTH, IMAGE_8, 980, 1000);
    assert_in_range(studio_pixel(&studio, MIDDLE, MIDDLE)[0], 127, 128);
    draw_aov(AOV_STRAND, IMAGE_8, 0, 0);
    uint8_t both[3], one[3];
    memcpy(both, studio_pixel(&studio, MIDDLE, MIDDLE), 3);
    add_band(0, 0.1f, 10);
    draw();
    memcpy(one, studio_pixel(&studio, MIDDLE, MIDDLE), 3);
    assert_memory_equal(both, one, 3);
    assert_true(one[0] || one[1] || one[2]); // black would mean no strand
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tones_are_those_of_their_papers),
        cmocka_unit_test(bright_light_is_rolled_off_and_the_background_stays),
        cmocka_unit_test(half_of_a_background_shows_through_half_transparent_hair),
        cmocka_unit_test(floats_are_premultiplied_light),
        cmocka_unit_test(warmth_keeps_the_sum_of_red_and_blue),
        cmocka_unit_test_setup_teardown(sixteen_bits_are_finer_than_eight, temporary_create,
                                        temporary_destroy),
        cmocka_unit_test(pfm_has_rows_from_below),
        cmocka_unit_test(aovs_are_what_they_are_said_to_be),
    };
    int failed = 0;
    for (raster = RASTER_QUADS; raster <= RASTER_BLOCKS; ++raster)
        failed += cmocka_run_group_tests(tests, open_studio, close_studio);
    return failed;
}
