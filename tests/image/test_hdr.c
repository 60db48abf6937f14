// SPDX-License-Identifier: MIT
// Radiance images, and the colours that PNG files say they have.
#include "image/hdr.h"
#include "image/png.h"
#include "image/png_color.h"

#include <endian.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static Result decode(Image *image, const char *head, const void *pixels, size_t size, Error *error)
{
    uint8_t bytes[400] = {0};
    size_t length = strlen(head);
    memcpy(bytes, head, length);
    memcpy(bytes + length, pixels, size);
    const Bytes file = {bytes, length + size};
    assert_true(hdr_is(&file));
    return hdr_decode(image, &file, "x.hdr", error);
}

#define HEAD "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n"

// 128, 64, 0 with the exponent 129 is 1, 0.5, 0.
static void flat_and_encoded_rows_are_the_same_light(void **state)
{
    (void)state;
    static const uint8_t flat[] = {128, 64, 0, 129, 128, 64, 0, 129},
                         old[] = {128, 64, 0, 129, 1, 1, 1, 7},
                         encoded[] = {2, 2, 0, 8, 136, 128, 136, 64, 136, 0, 136, 129};
    static const struct {
        const char *head;
        const uint8_t *pixels;
        size_t size;
        int width;
        float red;
    } cases[] = {
        {HEAD "-Y 1 +X 2\n", flat, sizeof flat, 2, 1},
        {HEAD "-Y 1 +X 8\n", old, sizeof old, 8, 1},
        {HEAD "-Y 1 +X 8\n", encoded, sizeof encoded, 8, 1},
        {"#?RGBE\nEXPOSURE=2\n\n-Y 1 +X 2\n", flat, sizeof flat, 2, 0.5f},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        Image image;
        Error error = {""};
        if (decode(&image, cases[i].head, cases[i].pixels, cases[i].size, &error) != RESULT_OK)
            fail_msg("%s", error.text);
        const float *light = (const float *)(const void *)image.pixels;
        assert_int_equal(image.width, cases[i].width);
        for (int x = 0; x < image.width; ++x) {
            assert_true(light[3 * x] == cases[i].red && light[3 * x + 1] == cases[i].red / 2);
            assert_true(light[3 * x + 2] == 0);
        }
        image_destroy(&image);
        for (size_t size = 0; size < cases[i].size; ++size) // cut off
            assert_int_equal(decode(&image, cases[i].head, cases[i].pixels, size, NULL),
                             RESULT_BAD_INPUT);
    }
}

static void other_radiance_images_are_refused(void **state)
{
    (void)state;
    static const uint8_t flat[8] = {0};
    static const char *const heads[] = {"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 2\n",
                                        HEAD "+Y 1 +X 2\n", HEAD "-Y 0 +X 2\n",
                                        HEAD "-Y 99999 +X 99999\n", "#?RADIANCE\n"};
    for (size_t i = 0; i < sizeof heads / sizeof *heads; ++i) {
        Image image;
        assert_int_equal(decode(&image, heads[i], flat, sizeof flat, NULL), RESULT_BAD_INPUT);
    }
}

// A signature and one chunk: libpng has checked the rest of the file.
static Result convert(Image *image, const char *name, const uint8_t *content, uint32_t size)
{
    uint8_t bytes[64] = {0};
    const uint32_t length = htobe32(size);
    Error error;
    memcpy(bytes + 8, &length, 4);
    memcpy(bytes + 12, name, 4);
    memcpy(bytes + 16, content, size);
    return png_color_convert(image, &(Bytes){bytes, 20 + size}, "x.png", &error);
}

static void samples_become_srgb(void **state)
{
    (void)state;
    static const uint8_t linear[] = {0, 1, 0x86, 0xa0}, usual[] = {0, 0, 0xb1, 0x8f},
                         coded[] = {1, 8, 0, 1}, pq[] = {9, 16, 0, 1};
    uint8_t pixels[4] = {0, 55, 255, 55};
    Image image = {.width = 1, .height = 1, .channels = 4, .pixels = pixels};
    assert_int_equal(convert(&image, "gAMA", usual, 4), RESULT_OK);
    assert_int_equal(pixels[1], 55);
    assert_int_equal(convert(&image, "cICP", pq, 4), RESULT_BAD_INPUT);
    // 55 / 255 of light is 0.5020 in sRGB (IEC 61966-2-1): 128. Alpha stays.
    assert_int_equal(convert(&image, "gAMA", linear, 4), RESULT_OK);
    assert_true(pixels[0] == 0 && pixels[1] == 128 && pixels[2] == 255 && pixels[3] == 55);
    pixels[1] = 55;
    assert_int_equal(convert(&image, "cICP", coded, 4), RESULT_OK);
    assert_int_equal(pixels[1], 128);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flat_and_encoded_rows_are_the_same_light),
        cmocka_unit_test(other_radiance_images_are_refused),
        cmocka_unit_test(samples_become_srgb),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
