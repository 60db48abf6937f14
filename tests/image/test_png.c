// SPDX-License-Identifier: MIT
// PNG files: every size and kind there and back, and the format by its letter.
#include "base/bytes.h"
#include "image/image.h"
#include "image/png.h"
#include "support/temporary.h"

#include <libdeflate.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include <cmocka.h>

// A picture with gradients, noise and both ends of the range in every channel.
static Image make_image(int width, int height, int channels)
{
    Image image;
    assert_int_equal(image_create(&image, width, height, channels, NULL), RESULT_OK);
    uint32_t noise = 12345;
    for (int i = 0; i < width * height * channels; i++) {
        noise = noise * 1664525u + 1013904223u;
        int pixel = i / channels, x = pixel % width, y = pixel / width;
        bool smooth = (x / 8 + y / 8) % 2 == 0;
        image.pixels[i] =
            smooth ? (uint8_t)(3 * x + 5 * y + 40 * (i % channels)) : (uint8_t)(noise >> 24);
    }
    return image;
}

static void assert_same_image(const Image *a, const Image *b)
{
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    assert_int_equal(a->channels, b->channels);
    assert_memory_equal(a->pixels, b->pixels,
                        (size_t)a->width * (size_t)a->height * (size_t)a->channels);
}

static void every_size_and_kind_survives_a_round_trip(void **state)
{
    static const int sizes[][2] = {{1, 1}, {1, 7}, {9, 1}, {33, 17}, {64, 64}, {1280, 720}};
    const char *path = temporary_path(state, "image.png");
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        for (int channels = 3; channels <= 4; channels++) {
            Error error;
            Image image = make_image(sizes[i][0], sizes[i][1], channels), back;
            assert_int_equal(png_write(path, &image, &error), RESULT_OK);
            assert_int_equal(png_read(&back, path, &error), RESULT_OK);
            assert_same_image(&image, &back);
            image_destroy(&image);
            image_destroy(&back);
        }
    assert_int_equal(temporary_count_files(temporary_path(state, ".")), 1);
}

static uint32_t read_big_endian(const uint8_t *at)
{
    return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
}

// The checksum of the PNG specification, appendix D, bit by bit: slow, but not the code under test.
static uint32_t checksum(const uint8_t *data, size_t size)
{
    uint32_t crc = 0xffffffffu;
    for (size_t i = 0; i < size; i++) {
        crc ^= data[i];
        for (int bit = 0; bit < 8; bit++) crc = crc & 1 ? crc >> 1 ^ 0xedb88320u : crc >> 1;
    }
    return ~crc;
}

static void the_file_is_made_of_valid_chunks(void **state)
{
    (void)state;
    Image image = make_image(33, 17, 4);
    Bytes png;
    assert_int_equal(png_encode(&image, &png, NULL), RESULT_OK);
    assert_memory_equal(png.data, "\x89PNG\r\n\x1a\n", 8);
    static const char *const names[] = {"IHDR", "IDAT", "IEND"};
    size_t at = 8;
    for (int i = 0; i < 3; i++) {
        assert_true(at + 12 <= png.size);
        uint32_t length = read_big_endian(png.data + at);
        assert_true(length <= png.size - at - 12);
        assert_memory_equal(png.data + at + 4, names[i], 4);
        assert_int_equal(read_big_endian(png.data + at + 8 + length),
                         checksum(png.data + at + 4, length + 4));
        at += 12 + length;
    }
    assert_int_equal(at, png.size);
    assert_int_equal(read_big_endian(png.data + 16), 33);
    assert_int_equal(read_big_endian(png.data + 20), 17);
    bytes_destroy(&png);
    image_destroy(&image);
}

// A decoder for this one kind of file, which shares no code with the encoder or with png_read.
static void every_row_is_the_difference_from_the_row_above(void **state)
{
    (void)state;
    enum { W = 33, H = 17, ROW = 3 * W };
    Image image = make_image(W, H, 3);
    Bytes png;
    uint8_t rows[H][1 + ROW], above[ROW] = {0};
    size_t size;
    assert_int_equal(png_encode(&image, &png, NULL), RESULT_OK);
    struct libdeflate_decompressor *decompressor = libdeflate_alloc_decompressor();
    assert_int_equal(libdeflate_zlib_decompress(decompressor, png.data + 41,
                                                read_big_endian(png.data + 33), rows, sizeof rows,
                                                &size),
                     LIBDEFLATE_SUCCESS);
    assert_int_equal(size, sizeof rows);
    for (int y = 0; y < H; y++) {
        assert_int_equal(rows[y][0], 2);
        for (int i = 0; i < ROW; i++) {
            above[i] = (uint8_t)(above[i] + rows[y][1 + i]);
            assert_int_equal(above[i], image.pixels[y * ROW + i]);
        }
    }
    libdeflate_free_decompressor(decompressor);
    bytes_destroy(&png);
    image_destroy(&image);
}

static void the_same_image_gives_the_same_bytes(void **state)
{
    (void)state;
    Image image = make_image(321, 123, 3);
    Bytes first, second;
    assert_int_equal(png_encode(&image, &first, NULL), RESULT_OK);
    assert_int_equal(png_encode(&image, &second, NULL), RESULT_OK);
    assert_int_equal(first.size, second.size);
    assert_memory_equal(first.data, second.data, first.size);
    bytes_destroy(&first);
    bytes_destroy(&second);
    image_destroy(&image);
}

static void an_image_too_large_is_refused(void **state)
{
    (void)state;
    Error error;
    Bytes png;
    Image image = {.width = 40000, .height = 40000, .channels = 4};
    assert_int_equal(png_encode(&image, &png, &error), RESULT_FAILED);
    assert_non_null(strstr(error.text, "40000 x 40000"));
    assert_null(png.data);
}

static void a_full_disk_leaves_no_file(void **state)
{
    Error error;
    Image image = make_image(200, 200, 3);
    const char *path = temporary_path(state, "full.png");
    struct rlimit limit, small;
    getrlimit(RLIMIT_FSIZE, &limit);
    small = limit;
    small.rlim_cur = 8192;
    signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &small);
    Result result = png_write(path, &image, &error);
    setrlimit(RLIMIT_FSIZE, &limit);
    assert_int_equal(result, RESULT_FAILED);
    assert_non_null(strstr(error.text, path));
    assert_non_null(strstr(error.text, "File too large"));
    assert_int_equal(temporary_count_files(temporary_path(state, ".")), 0);
    image_destroy(&image);
}

static void files_that_are_no_png_are_bad_input(void **state)
{
    static const char *const names[] = {"empty.png", "text.png", "missing.png"};
    temporary_write(state, "empty.png", "", 0644);
    temporary_write(state, "text.png", "P6 1 1 255 no PNG at all", 0644);
    for (int i = 0; i < 3; i++) {
        Error error = {{0}};
        Image image;
        const char *path = temporary_path(state, names[i]);
        assert_int_equal(png_read(&image, path, &error), RESULT_BAD_INPUT);
        assert_non_null(strstr(error.text, path));
        assert_null(image.pixels);
    }
}

static void a_cut_file_is_bad_input(void **state)
{
    Error error;
    Image image = make_image(9, 5, 3), back;
    Bytes png;
    const char *path = temporary_path(state, "cut.png");
    assert_int_equal(png_encode(&image, &png, &error), RESULT_OK);
    // All but the closing chunk is needed.
    for (size_t size = 0; size < png.size - 12; size++) {
        Bytes cut = {.data = png.data, .size = size};
        assert_int_equal(bytes_write_file(&cut, path, &error), RESULT_OK);
        assert_int_equal(png_read(&back, path, &error), RESULT_BAD_INPUT);
    }
    bytes_destroy(&png);
    image_destroy(&image);
}

static void only_whole_files_of_the_right_form_are_whole(void **state)
{
    Image image = make_image(13, 9, 3);
    const char *path = temporary_path(state, "image.png");
    Bytes png;
    assert_false(png_is_whole(path, 13, 9, 3));
    assert_int_equal(png_encode(&image, &png, NULL), RESULT_OK);
    assert_int_equal(bytes_write_file(&png, path, NULL), RESULT_OK);
    assert_true(png_is_whole(path, 13, 9, 3));
    assert_false(png_is_whole(path, 9, 13, 3));
    assert_false(png_is_whole(path, 13, 9, 4));
    for (size_t size = 0; size < png.size; size++) {
        Bytes cut = {.data = png.data, .size = size};
        assert_int_equal(bytes_write_file(&cut, path, NULL), RESULT_OK);
        assert_false(png_is_whole(path, 13, 9, 3));
    }
    for (size_t at = 0; at < png.size; at++) {
        png.data[at] ^= 0x10;
        assert_int_equal(bytes_write_file(&png, path, NULL), RESULT_OK);
        assert_false(png_is_whole(path, 13, 9, 3));
        png.data[at] ^= 0x10;
    }
    bytes_destroy(&png);
    image_destroy(&image);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, temporary_create, temporary_destroy)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(every_size_and_kind_survives_a_round_trip),
        TEST(the_file_is_made_of_valid_chunks),
        TEST(every_row_is_the_difference_from_the_row_above),
        TEST(the_same_image_gives_the_same_bytes),
        TEST(an_image_too_large_is_refused),
        TEST(a_full_disk_leaves_no_file),
        TEST(files_that_are_no_png_are_bad_input),
        TEST(a_cut_file_is_bad_input),
        TEST(only_whole_files_of_the_right_form_are_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
