// SPDX-License-Identifier: MIT
// Another reader sees almost the same image in a JPEG file; images that JPEG can't hold are
// refused.
#include "image/jpeg.h"

#include "image/float_image.h"
#include "support/temporary.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-compare"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-but-set-variable"
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#include <stb_image.h>
#pragma GCC diagnostic pop

// Gradients, which compress almost without loss.
static Image make_slopes(int width, int height)
{
    Image image;
    assert_int_equal(image_create(&image, width, height, 3, NULL), RESULT_OK);
    for (int i = 0; i < width * height; ++i) {
        image.pixels[3 * i] = (uint8_t)(i % width);
        image.pixels[3 * i + 1] = (uint8_t)(2 * (i / width));
        image.pixels[3 * i + 2] = 128;
    }
    return image;
}

static double rms_of(const Image *image, int quality, size_t *size)
{
    Bytes file;
    int width, height, channels;
    double sum = 0;
    assert_int_equal(jpeg_encode(image, quality, &file, NULL), RESULT_OK);
    assert_true(jpeg_is(&file));
    uint8_t *pixels =
        stbi_load_from_memory(file.data, (int)file.size, &width, &height, &channels, 3);
    assert_non_null(pixels);
    assert_int_equal(width, image->width);
    assert_int_equal(height, image->height);
    for (size_t i = 0; i < image_size(image); ++i)
        sum += (double)(pixels[i] - image->pixels[i]) * (pixels[i] - image->pixels[i]);
    *size = file.size;
    stbi_image_free(pixels);
    bytes_destroy(&file);
    return sqrt(sum / (double)image_size(image));
}

static void a_picture_survives(void **state)
{
    (void)state;
    static const int sizes[][2] = {{1, 1}, {17, 9}, {160, 120}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; ++i) {
        Image image = make_slopes(sizes[i][0], sizes[i][1]);
        size_t fine, small;
        // The conversion of colours alone loses about one level.
        assert_true(rms_of(&image, JPEG_FINE, &fine) < 2);
        assert_true(rms_of(&image, JPEG_SMALL, &small) < 4);
        if (i == 2) assert_true(small < fine && fine < image_size(&image) / 4);
        image_destroy(&image);
    }
}

// Noise hardly compresses, so the file grows many times while it is written.
static void a_large_file_is_whole(void **state)
{
    (void)state;
    Image image;
    size_t size;
    assert_int_equal(image_create(&image, 512, 512, 3, NULL), RESULT_OK);
    for (size_t i = 0; i < image_size(&image); i += 3)
        memset(image.pixels + i, (int)(i * 2654435761u >> 16 & 255), 3);
    assert_true(rms_of(&image, JPEG_FINE, &size) < 4);
    assert_true(size > 100000);
    image_destroy(&image);
}

static void what_it_cannot_hold_is_refused(void **state)
{
    (void)state;
    Image image;
    Bytes file;
    Error error;
    assert_int_equal(image_create(&image, 4, 4, 4, NULL), RESULT_OK);
    assert_int_equal(jpeg_encode(&image, 85, &file, &error), RESULT_FAILED);
    image_destroy(&image);
    assert_int_equal(image_create_kind(&image, 4, 4, 3, IMAGE_16, NULL), RESULT_OK);
    assert_int_equal(jpeg_encode(&image, 85, &file, &error), RESULT_FAILED);
    image_destroy(&image);
    assert_int_equal(image_create(&image, 65536, 1, 3, NULL), RESULT_OK);
    assert_int_equal(jpeg_encode(&image, 85, &file, &error), RESULT_FAILED);
    assert_null(file.data);
    image_destroy(&image);
}

static void it_is_not_measured(void **state)
{
    Image image = make_slopes(16, 16), back;
    Bytes file;
    Error error;
    const char *path = temporary_path(state, "x.png"); // the content decides, not the suffix
    assert_int_equal(jpeg_encode(&image, JPEG_FINE, &file, NULL), RESULT_OK);
    assert_int_equal(bytes_write_file(&file, path, NULL), RESULT_OK);
    assert_int_equal(float_image_read_image(&back, path, &error), RESULT_BAD_INPUT);
    assert_non_null(strstr(error.text, "whose compression changes pixels"));
    bytes_destroy(&file);
    image_destroy(&image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_picture_survives), cmocka_unit_test(a_large_file_is_whole),
        cmocka_unit_test(what_it_cannot_hold_is_refused),
        cmocka_unit_test_setup_teardown(it_is_not_measured, temporary_create, temporary_destroy)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
