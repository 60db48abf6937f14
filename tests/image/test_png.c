// SPDX-License-Identifier: MIT
// PNG files: every size and kind can be written and read back, and every field of the format is as
// specified.
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

// Gradients, noise and both ends of the range in every channel.
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

// Checks for one line of printable text.
static void assert_line(const char *text)
{
    if (!*text || strstr(text, "(null)")) fail_msg("no reason: '%s'", text);
    for (const char *at = text; *at; ++at)
        if (*at < ' ' || *at > '~') fail_msg("'%s' has byte %d", text, *at);
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

// The filtered rows are equal, so almost all of the file is matches with the first row. In such
// small files a compressor whose choice of matches depended on its address would notice it often.
static void a_file_does_not_depend_on_where_memory_lies(void **state)
{
    enum { W = 4, CHANNELS = 3, MOST_ROWS = 8, TRIES = 300, STEP_BYTES = 1 << 16 };
    static void *blocks[TRIES];
    (void)state;
    for (int rows = 1; rows <= MOST_ROWS; ++rows) {
        Image image = make_image(W, rows, CHANNELS);
        Bytes first, png;
        for (int y = 0; y < rows; ++y)
            for (int i = 0; i < W * CHANNELS; ++i)
                image.pixels[y * W * CHANNELS + i] = (uint8_t)((y + 1) * (11 + 20 * i));
        assert_int_equal(png_encode(&image, NULL, &first, NULL), RESULT_OK);
        for (int i = 0; i < TRIES; ++i) {
            blocks[i] = malloc(STEP_BYTES); // moves what is allocated behind it
            assert_int_equal(png_encode(&image, NULL, &png, NULL), RESULT_OK);
            assert_int_equal(png.size, first.size);
            assert_memory_equal(png.data, first.data, first.size);
            bytes_destroy(&png);
        }
        for (int i = 0; i < TRIES; ++i) free(blocks[i]);
        bytes_destroy(&first);
        image_destroy(&image);
    }
}

static uint32_t read_big_endian(const uint8_t *at)
{
    return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
}

// The checksum of the PNG specification, appendix D, bit by bit: slow, but independent of the code
// under test.
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
    assert_int_equal(png_encode(&image, NULL, &png, NULL), RESULT_OK);
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

// A decoder for this one kind of file that shares no code with the encoder or png_read.
static void every_row_is_the_difference_from_the_row_above(void **state)
{
    (void)state;
    enum { W = 33, H = 17, ROW = 3 * W };
    Image image = make_image(W, H, 3);
    Bytes png;
    uint8_t rows[H][1 + ROW], above[ROW] = {0};
    size_t size;
    assert_int_equal(png_encode(&image, NULL, &png, NULL), RESULT_OK);
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
    assert_int_equal(png_encode(&image, NULL, &first, NULL), RESULT_OK);
    assert_int_equal(png_encode(&image, NULL, &second, NULL), RESULT_OK);
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
    assert_int_equal(png_encode(&image, NULL, &png, &error), RESULT_FAILED);
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
    assert_int_equal(png_encode(&image, NULL, &png, &error), RESULT_OK);
    // Reading needs every byte except those of the last chunk.
    for (size_t size = 0; size < png.size - 12; size++) {
        Bytes cut = {.data = png.data, .size = size};
        assert_int_equal(bytes_write_file(&cut, path, &error), RESULT_OK);
        assert_int_equal(png_read(&back, path, &error), RESULT_BAD_INPUT);
    }
    bytes_destroy(&png);
    image_destroy(&image);
}

// Checksums protect every byte, also of chunks that the reader ignores.
static void any_flipped_bit_is_found(void **state)
{
    (void)state;
    Image image = make_image(13, 9, 3), back;
    ImageTexts texts = {0};
    Bytes png;
    assert_int_equal(image_texts_set(&texts, "Software", "x", NULL), RESULT_OK);
    assert_int_equal(png_encode(&image, &texts, &png, NULL), RESULT_OK);
    for (size_t at = 0; at < png.size; ++at) {
        Error error = {{0}};
        png.data[at] ^= 0x10;
        assert_int_equal(png_decode_deep(&back, &png, "x.png", &error), RESULT_BAD_INPUT);
        assert_line(error.text);
        png.data[at] ^= 0x10;
    }
    assert_int_equal(png_decode_deep(&back, &png, "x.png", NULL), RESULT_OK);
    assert_same_image(&image, &back);
    image_texts_destroy(&texts);
    bytes_destroy(&png);
    image_destroy(&back);
    image_destroy(&image);
}

// --- Text chunks.

static const char *const KEYS[] = {"Software", "Frame", "A b", "Fingerprint"};
static const char *const VALUES[] = {"tractrix 0", "", "na\u00efve \u2192 \U0001f600\nline",
                                     "0123456789abcdef"};
enum { KEY_COUNT = 4 };

static void texts_survive_and_leave_the_pixels(void **state)
{
    (void)state;
    Image image = make_image(5, 4, 4), back;
    ImageTexts texts = {0}, found;
    Bytes png, bare, again;
    for (int i = 0; i < KEY_COUNT; ++i)
        assert_int_equal(image_texts_set(&texts, KEYS[i], VALUES[i], NULL), RESULT_OK);
    assert_int_equal(png_encode(&image, &texts, &png, NULL), RESULT_OK);
    assert_int_equal(png_encode(&image, &texts, &again, NULL), RESULT_OK);
    assert_int_equal(png_encode(&image, NULL, &bare, NULL), RESULT_OK);
    assert_int_equal(png.size, again.size);
    assert_memory_equal(png.data, again.data, png.size);
    assert_true(bare.size < png.size);
    assert_int_equal(png_decode_deep(&back, &png, "x.png", NULL), RESULT_OK);
    assert_same_image(&image, &back);
    assert_int_equal(png_decode_texts(&found, &png, "x.png", NULL), RESULT_OK);
    assert_int_equal(found.count, KEY_COUNT);
    for (int i = 0; i < KEY_COUNT; ++i)
        assert_string_equal(image_texts_find(&found, KEYS[i]), VALUES[i]);
    assert_null(image_texts_find(&found, "frame"));
    image_texts_destroy(&found);
    assert_int_equal(png_decode_texts(&found, &bare, "x.png", NULL), RESULT_OK);
    assert_int_equal(found.count, 0);
    bytes_destroy(&png), bytes_destroy(&again), bytes_destroy(&bare);
    image_texts_destroy(&texts);
    image_destroy(&back);
    image_destroy(&image);
}

static void texts_are_clean(void **state)
{
    (void)state;
    static const char *const keys[] = {"", " a", "a ", "a  b", "caf\u00e9", "tab\t"};
    char key[IMAGE_TEXT_KEY_BYTES + 1];
    ImageTexts texts = {0};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; ++i)
        assert_int_equal(image_texts_set(&texts, keys[i], "x", NULL), RESULT_FAILED);
    memset(key, 'k', sizeof key);
    key[IMAGE_TEXT_KEY_BYTES] = 0;
    assert_int_equal(image_texts_set(&texts, key, "x", NULL), RESULT_FAILED);
    key[IMAGE_TEXT_KEY_BYTES - 1] = 0;
    assert_int_equal(image_texts_set(&texts, key, "x", NULL), RESULT_OK);
    assert_int_equal(image_texts_set(&texts, key, "a\tb\x1b[1m\xff\xc0\x80\xed\xa0\x80\xc3", NULL),
                     RESULT_OK);
    assert_int_equal(texts.count, 1);
    assert_string_equal(image_texts_find(&texts, key), "a b [1m???"
                                                       "???"
                                                       "?");
    image_texts_destroy(&texts);
}

// --- Files of other programs: the test makes the chunks and compresses the rows in zlib's format.

typedef struct File {
    uint8_t data[4096];
    size_t size;
} File;

static void add_u32(File *file, uint32_t value)
{
    for (int k = 0; k < 4; ++k) file->data[file->size++] = (uint8_t)(value >> (24 - 8 * k));
}

static void add_chunk(File *file, const char *name, const void *bytes, size_t size)
{
    add_u32(file, (uint32_t)size);
    memcpy(file->data + file->size, name, 4);
    if (size) memcpy(file->data + file->size + 4, bytes, size);
    file->size += size + 4;
    add_u32(file, checksum(file->data + file->size - size - 4, size + 4));
}

static void add_header(File *file, uint32_t width, uint32_t height, int depth, int type, int laced)
{
    File header = {.size = 0};
    memcpy(file->data, "\x89PNG\r\n\x1a\n", 8);
    file->size = 8;
    add_u32(&header, width);
    add_u32(&header, height);
    const uint8_t rest[] = {(uint8_t)depth, (uint8_t)type, 0, 0, (uint8_t)laced};
    memcpy(header.data + 8, rest, sizeof rest);
    add_chunk(file, "IHDR", header.data, 13);
}

static void add_end(File *file, const void *rows, size_t size)
{
    uint8_t packed[2048];
    struct libdeflate_compressor *compressor = libdeflate_alloc_compressor(6);
    size_t got = libdeflate_zlib_compress(compressor, rows, size, packed, sizeof packed);
    libdeflate_free_compressor(compressor);
    assert_true(got > 0);
    add_chunk(file, "IDAT", packed, got);
    add_chunk(file, "IEND", NULL, 0);
}

static Result decode(Image *image, const File *file, Error *error)
{
    Bytes bytes = {.data = malloc(file->size + 1), .size = file->size};
    memcpy(bytes.data, file->data, file->size);
    bytes.data[file->size] = 0;
    Result result = png_decode_deep(image, &bytes, "x.png", error);
    bytes_destroy(&bytes);
    return result;
}

// Two adjacent pixels of each kind, and the expected RGB or RGBA in the resulting depth.
static void every_kind_of_pixel_is_read(void **state)
{
    (void)state;
    static const struct {
        int depth, type; // 0 grey, 2 RGB, 3 palette, 4 grey and alpha, 6 RGBA
        uint8_t row[17]; // including the filter byte
        size_t size;
        const char *colours;
        int colour_bytes;
        ImageKind kind;
        int channels;
        uint16_t pixels[8];
    } kinds[] = {
        {1, 0, {0, 0x40}, 2, NULL, 0, IMAGE_8, 3, {0, 0, 0, 255, 255, 255}},
        {2, 0, {0, 0x60}, 2, NULL, 0, IMAGE_8, 3, {85, 85, 85, 170, 170, 170}},
        {4, 0, {0, 0x3f}, 2, NULL, 0, IMAGE_8, 3, {51, 51, 51, 255, 255, 255}},
        {8, 0, {0, 7, 200}, 3, NULL, 0, IMAGE_8, 3, {7, 7, 7, 200, 200, 200}},
        {16,
         0,
         {0, 1, 2, 3, 4},
         5,
         NULL,
         0,
         IMAGE_16,
         3,
         {0x102, 0x102, 0x102, 0x304, 0x304, 0x304}},
        {8, 0, {0, 7, 200}, 3, "\0\7", 2, IMAGE_8, 4, {7, 7, 7, 0, 200, 200, 200, 255}},
        {8, 2, {0, 1, 2, 3, 4, 5, 6}, 7, NULL, 0, IMAGE_8, 3, {1, 2, 3, 4, 5, 6}},
        {8, 3, {0, 1, 0}, 3, NULL, 0, IMAGE_8, 3, {40, 50, 60, 10, 20, 30}},
        {8, 3, {0, 1, 0}, 3, "\x80", 1, IMAGE_8, 4, {40, 50, 60, 255, 10, 20, 30, 128}},
        {1, 3, {0, 0x80}, 2, NULL, 0, IMAGE_8, 3, {40, 50, 60, 10, 20, 30}},
        {8, 4, {0, 9, 8, 7, 6}, 5, NULL, 0, IMAGE_8, 4, {9, 9, 9, 8, 7, 7, 7, 6}},
        {16,
         4,
         {0, 1, 2, 3, 4, 5, 6, 7, 8},
         9,
         NULL,
         0,
         IMAGE_16,
         4,
         {0x102, 0x102, 0x102, 0x304, 0x506, 0x506, 0x506, 0x708}},
        {8, 6, {0, 1, 2, 3, 4, 5, 6, 7, 8}, 9, NULL, 0, IMAGE_8, 4, {1, 2, 3, 4, 5, 6, 7, 8}},
    };
    static const uint8_t palette[] = {10, 20, 30, 40, 50, 60};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; ++i)
        for (int laced = 0; laced < 2; ++laced) {
            File file;
            Image image;
            Error error = {{0}};
            add_header(&file, 2, 1, kinds[i].depth, kinds[i].type, laced);
            add_chunk(&file, "gAMA", "\0\0\xb1\x8f", 4); // sRGB's 1/2.2: no other space
            if (kinds[i].type == 3) add_chunk(&file, "PLTE", palette, sizeof palette);
            if (kinds[i].colours)
                add_chunk(&file, "tRNS", kinds[i].colours, (size_t)kinds[i].colour_bytes);
            add_chunk(&file, "tEXt", "Comment\0\xe9", 9);
            if (laced && kinds[i].size < 3) continue; // pixels share a byte
            uint8_t rows[40] = {0}; // interlaced: the first pixel in pass 1, the second in pass 6
            size_t half = (kinds[i].size - 1) / 2, size = kinds[i].size;
            memcpy(rows, kinds[i].row, size);
            if (laced) {
                rows[half + 1] = 0;
                memcpy(rows + half + 2, kinds[i].row + 1 + half, half);
                size += 1;
            }
            add_end(&file, rows, size);
            if (decode(&image, &file, &error) != RESULT_OK) fail_msg("%zu: %s", i, error.text);
            assert_int_equal(image.kind, kinds[i].kind);
            assert_int_equal(image.channels, kinds[i].channels);
            for (int k = 0; k < 2 * image.channels; ++k)
                assert_int_equal(image.kind == IMAGE_16 ? ((uint16_t *)(void *)image.pixels)[k]
                                                        : image.pixels[k],
                                 kinds[i].pixels[k]);
            image_destroy(&image);
        }
}

// Compressed text can grow a thousandfold: large texts are left out, and so are all texts after
// 128.
static void texts_that_swell_are_left_out(void **state)
{
    (void)state;
    enum { LARGE = 200000 };
    static char letters[LARGE];
    uint8_t chunk[1000] = "Large\0"; // key, its end and the compression method
    static File file;
    ImageTexts texts;
    memset(letters, 'a', sizeof letters);
    add_header(&file, 1, 1, 8, 2, 0);
    add_chunk(&file, "tEXt", "Before\0small", 12);
    struct libdeflate_compressor *compressor = libdeflate_alloc_compressor(6);
    size_t packed =
        libdeflate_zlib_compress(compressor, letters, LARGE, chunk + 7, sizeof chunk - 7);
    libdeflate_free_compressor(compressor);
    assert_true(packed > 0);
    for (int i = 0; i < 5; ++i) add_chunk(&file, "zTXt", chunk, packed + 7);
    add_chunk(&file, "tEXt", "After\0small", 11);
    add_end(&file, "\0\1\2\3", 4);
    const Bytes bytes = {.data = file.data, .size = file.size};
    assert_int_equal(png_decode_texts(&texts, &bytes, "x.png", NULL), RESULT_OK);
    assert_int_equal(texts.count, 2);
    assert_string_equal(image_texts_find(&texts, "After"), "small");
    image_texts_destroy(&texts);
}

// A header may require far more memory than the file's size can justify: refused at once, whatever
// follows.
static void bombs_are_refused(void **state)
{
    (void)state;
    static const struct {
        uint32_t width, height;
        const char *says;
    } sizes[] = {{16000, 16000, "expected pixels of at most"},
                 {1 << 20, 1 << 20, "at most"},
                 {1u << 30, 1, "width"},
                 {0, 5, "width"},
                 {5, 0, "height"},
                 {0xffffffff, 1, "out of range"}};
    static const uint8_t zeros[200];
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; ++i) {
        File file;
        Image image;
        Error error = {{0}};
        add_header(&file, sizes[i].width, sizes[i].height, 8, 6, 0);
        add_end(&file, zeros, sizeof zeros);
        assert_int_equal(decode(&image, &file, &error), RESULT_BAD_INPUT);
        assert_line(error.text);
        if (!strstr(error.text, sizes[i].says)) fail_msg("%zu: %s", i, error.text);
        assert_null(image.pixels);
    }
}

static void too_few_and_wrong_rows_are_found(void **state)
{
    (void)state;
    uint8_t rows[4 * 13] = {0};
    for (int i = 0; i < 3; ++i) {
        File file;
        Image image;
        Error error = {{0}};
        add_header(&file, 4, 4, 8, i == 2 ? 5 : 2, 0); // an undefined kind of pixel
        rows[26] = i == 1 ? 9 : 0;                     // an undefined filter
        add_end(&file, rows, i == 0 ? sizeof rows - 1 : sizeof rows);
        assert_int_equal(decode(&image, &file, &error), RESULT_BAD_INPUT);
        assert_line(error.text);
    }
}

// Images of up to 256 colours are stored with a palette, others with full colours.
static void palettes_keep_every_colour(void **state)
{
    (void)state;
    for (int colors = 1; colors <= 257; colors += 64) {
        Image image, back;
        Bytes small;
        assert_int_equal(image_create(&image, 33, 40, 3, NULL), RESULT_OK);
        for (int i = 0; i < 33 * 40; ++i) {
            image.pixels[3 * i] = (uint8_t)(i % colors);
            image.pixels[3 * i + 1] = (uint8_t)(i % colors / 256);
            image.pixels[3 * i + 2] = 7;
        }
        assert_int_equal(png_encode_palette(&image, &small, NULL), RESULT_OK);
        enum { COLOR_TYPE = 25, PALETTE = 3 }; // position in the file; value for palettes
        assert_int_equal(small.data[COLOR_TYPE], colors <= 256 ? PALETTE : 2);
        assert_int_equal(png_decode_deep(&back, &small, "small", NULL), RESULT_OK);
        assert_same_image(&image, &back);
        image_destroy(&back);
        image_destroy(&image);
        bytes_destroy(&small);
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, temporary_create, temporary_destroy)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(every_size_and_kind_survives_a_round_trip),
        TEST(a_file_does_not_depend_on_where_memory_lies),
        TEST(the_file_is_made_of_valid_chunks),
        TEST(every_row_is_the_difference_from_the_row_above),
        TEST(the_same_image_gives_the_same_bytes),
        TEST(an_image_too_large_is_refused),
        TEST(a_full_disk_leaves_no_file),
        TEST(files_that_are_no_png_are_bad_input),
        TEST(a_cut_file_is_bad_input),
        TEST(any_flipped_bit_is_found),
        TEST(texts_survive_and_leave_the_pixels),
        TEST(texts_are_clean),
        TEST(palettes_keep_every_colour),
        TEST(every_kind_of_pixel_is_read),
        TEST(texts_that_swell_are_left_out),
        TEST(bombs_are_refused),
        TEST(too_few_and_wrong_rows_are_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
