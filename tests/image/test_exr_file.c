// SPDX-License-Identifier: MIT
// EXR files: written files can be read back, also by OpenEXR's own tools if they are installed;
// files as other programs write them, which the test makes with the library; and damaged files.
#include "image/exr_file.h"
#include "image/float_image.h"
#include "support/temporary.h"

#include <openexr.h>

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

enum { WIDTH = 37, HEIGHT = 21, PIXELS = WIDTH * HEIGHT }; // not a multiple of a block's 16 rows

static Image make_image(int channels)
{
    Image image;
    assert_int_equal(image_create_kind(&image, WIDTH, HEIGHT, channels, IMAGE_FLOAT, NULL),
                     RESULT_OK);
    float *pixels = (float *)(void *)image.pixels;
    for (int i = 0; i < PIXELS * channels; ++i) pixels[i] = (float)(i % 97) / 32 - 0.5f;
    return image;
}

static const float *floats(const Image *image)
{
    return (const float *)(const void *)image->pixels;
}

// Layers as --aov draws them: a strand of its own in each pixel of the left half, and none in the
// right half.
static void make_layers(Image layers[EXR_LAYERS])
{
    for (int l = 0; l < EXR_LAYERS; ++l) {
        layers[l] = make_image(3);
        float *pixels = (float *)(void *)layers[l].pixels;
        for (int i = 0; i < PIXELS; ++i) {
            bool hair = i % WIDTH < WIDTH / 2;
            const float kinds[EXR_LAYERS][3] = {{0.25f, 0.25f, 0.25f},
                                                {1.0f / 3, 1.0f / 3, 1.0f / 3},
                                                {0.8f, 0.5f, 0.9f},
                                                {(float)(i % 256) / 255, 1.0f / 255, 1}};
            for (int k = 0; k < 3; ++k) pixels[3 * i + k] = hair ? kinds[l][k] : 0;
        }
    }
}

static void destroy_layers(Image layers[EXR_LAYERS])
{
    for (int l = 0; l < EXR_LAYERS; ++l) image_destroy(&layers[l]);
}

// A half float has 11 bits.
static float rounded_to_half(float value)
{
    int exponent;
    float mantissa = frexpf(value, &exponent);
    return ldexpf(rintf(ldexpf(mantissa, 11)), exponent - 11);
}

static void images_survive_a_round_trip(void **state)
{
    (void)state;
    for (int wide = 0; wide < 2; ++wide)
        for (int channels = 3; channels <= 4; ++channels) {
            Image image = make_image(channels), back;
            Bytes first, second;
            Error error = {{0}};
            const ExrFile file = {.image = &image, .floats = wide};
            assert_int_equal(exr_file_encode(&file, &first, &error), RESULT_OK);
            assert_int_equal(exr_file_encode(&file, &second, &error), RESULT_OK);
            assert_int_equal(first.size, second.size);
            assert_memory_equal(first.data, second.data, first.size);
            if (exr_file_decode(&back, &first, "x.exr", &error) != RESULT_OK)
                fail_msg("%s", error.text);
            assert_true(back.width == WIDTH && back.height == HEIGHT && back.channels == channels);
            for (int i = 0; i < PIXELS; ++i)
                for (int k = 0; k < channels; ++k) {
                    float value = floats(&image)[channels * i + k];
                    assert_true(floats(&back)[channels * i + k] ==
                                (wide ? value : rounded_to_half(value)));
                }
            bytes_destroy(&first), bytes_destroy(&second);
            image_destroy(&image), image_destroy(&back);
        }
}

// --- The OpenEXR library reads and writes files in memory.

typedef struct Disk {
    uint8_t *data;
    size_t size;
} Disk;

static int64_t read_disk(exr_const_context_t context, void *data, void *to, uint64_t size,
                         uint64_t offset, exr_stream_error_func_ptr_t fail)
{
    const Disk *disk = data;
    (void)context, (void)fail;
    if (offset >= disk->size) return 0;
    if (size > disk->size - offset) size = disk->size - offset;
    memcpy(to, disk->data + offset, size);
    return (int64_t)size;
}

static int64_t write_disk(exr_const_context_t context, void *data, const void *from, uint64_t size,
                          uint64_t offset, exr_stream_error_func_ptr_t fail)
{
    Disk *disk = data;
    (void)context, (void)fail;
    if (offset + size > disk->size) {
        disk->data = realloc(disk->data, offset + size + 1);
        memset(disk->data + disk->size, 0, offset + size + 1 - disk->size);
        disk->size = offset + size;
    }
    memcpy(disk->data + offset, from, size);
    return (int64_t)size;
}

#define EXR(call) assert_int_equal((call), EXR_ERR_SUCCESS)

// Reads one channel of a scanline file as 32-bit numbers of the given type.
static void read_channel(const Bytes *file, const char *name, exr_pixel_type_t type, void *numbers)
{
    Disk disk = {file->data, file->size};
    exr_context_initializer_t start = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_context_t context;
    int32_t lines;
    bool found = false;
    start.user_data = &disk;
    start.read_fn = read_disk;
    EXR(exr_start_read(&context, "x.exr", &start));
    EXR(exr_get_scanlines_per_chunk(context, 0, &lines));
    for (int y = 0; y < HEIGHT; y += lines) {
        exr_chunk_info_t chunk;
        exr_decode_pipeline_t pipeline = EXR_DECODE_PIPELINE_INITIALIZER;
        EXR(exr_read_scanline_chunk_info(context, 0, y, &chunk));
        EXR(exr_decoding_initialize(context, 0, &chunk, &pipeline));
        for (int c = 0; c < pipeline.channel_count; ++c) {
            exr_coding_channel_info_t *channel = &pipeline.channels[c];
            if (strcmp(channel->channel_name, name) != 0) continue;
            found = true;
            if (type != EXR_PIXEL_FLOAT) assert_int_equal(channel->data_type, type);
            channel->user_data_type = (uint16_t)type;
            channel->user_bytes_per_element = channel->user_pixel_stride = 4;
            channel->user_line_stride = 4 * WIDTH;
            channel->decode_to_ptr = (uint8_t *)numbers + (size_t)(4 * WIDTH * y);
        }
        EXR(exr_decoding_choose_default_routines(context, 0, &pipeline));
        EXR(exr_decoding_run(context, 0, &pipeline));
        EXR(exr_decoding_destroy(context, &pipeline));
    }
    EXR(exr_finish(&context));
    assert_true(found);
}

static void layers_are_channels_of_the_same_file(void **state)
{
    (void)state;
    Image image = make_image(4), layers[EXR_LAYERS];
    Bytes exr;
    static float numbers[PIXELS];
    static uint32_t ids[PIXELS];
    make_layers(layers);
    const ExrFile file = {.image = &image, .layers = layers};
    assert_int_equal(exr_file_encode(&file, &exr, NULL), RESULT_OK);
    read_channel(&exr, "Z", EXR_PIXEL_FLOAT, numbers);
    assert_true(numbers[0] == 1.0f / 3 && numbers[WIDTH - 1] == 0); // not a half float
    read_channel(&exr, "coverage", EXR_PIXEL_FLOAT, numbers);
    assert_true(numbers[0] == 0.25f && numbers[WIDTH - 1] == 0);
    // (0.6, 0, 0.8) within half a step of a half float
    const float tangent[] = {0.6f, 0, 0.8f};
    static const char *const names[] = {"tangent.X", "tangent.Y", "tangent.Z"};
    for (int k = 0; k < 3; ++k) {
        read_channel(&exr, names[k], EXR_PIXEL_FLOAT, numbers);
        assert_true(fabsf(numbers[0] - tangent[k]) <= 1.0f / 2048 && numbers[WIDTH - 1] == 0);
    }
    read_channel(&exr, "id", EXR_PIXEL_UINT, ids);
    for (int i = 0; i < PIXELS; ++i)
        assert_int_equal(ids[i], i % WIDTH < WIDTH / 2 ? (uint32_t)(i % 256) | 0xff0100u : 0u);
    bytes_destroy(&exr);
    destroy_layers(layers);
    image_destroy(&image);
}

// A pixel has a strand if its depth, tangent and strand colour are all set: tests all eight
// combinations of black layers. Coverage is kept as drawn.
static void a_pixel_has_all_of_a_strand_or_nothing(void **state)
{
    (void)state;
    Image image = make_image(4), layers[EXR_LAYERS];
    Bytes exr;
    static float numbers[5][PIXELS];
    static uint32_t ids[PIXELS];
    make_layers(layers);
    for (int i = 0; i < PIXELS; ++i)
        for (int l = 0; l < EXR_LAYERS; ++l) {
            float *at = (float *)(void *)layers[l].pixels + 3 * i;
            for (int k = 0; k < 3; ++k) at[k] = l == EXR_COVERAGE ? 0.25f : 0.5f;
            // One component other than black is enough, whichever it is.
            if (l == EXR_STRAND || l == EXR_TANGENT)
                for (int k = 0; k < 3; ++k) at[k] = k == i / 8 % 3 ? 1.0f : 0;
            bool black = l != EXR_COVERAGE && i >> (l - EXR_DEPTH) & 1;
            for (int k = 0; k < 3 && black; ++k) at[k] = 0;
        }
    const ExrFile file = {.image = &image, .layers = layers, .floats = true};
    assert_int_equal(exr_file_encode(&file, &exr, NULL), RESULT_OK);
    static const char *const names[] = {"Z", "tangent.X", "tangent.Y", "tangent.Z", "coverage"};
    for (int k = 0; k < 5; ++k) read_channel(&exr, names[k], EXR_PIXEL_FLOAT, numbers[k]);
    read_channel(&exr, "id", EXR_PIXEL_UINT, ids);
    for (int i = 0; i < PIXELS; ++i) {
        bool strand = i % 8 == 0;
        assert_true(numbers[0][i] == (strand ? 0.5f : 0) && numbers[4][i] == 0.25f);
        assert_int_equal(ids[i], strand ? 0xffu << (8 * (i / 8 % 3)) : 0u);
        float square = 0; // of a unit vector, or 0
        for (int k = 1; k < 4; ++k) square += numbers[k][i] * numbers[k][i];
        assert_true(strand ? fabsf(square - 1) < 1e-6f : square == 0);
    }
    bytes_destroy(&exr);
    destroy_layers(layers);
    image_destroy(&image);
}

static void attributes_are_kept(void **state)
{
    (void)state;
    Image image = make_image(3);
    ImageTexts texts = {0}, found;
    Bytes exr;
    float matrix[4][4];
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = (float)i;
    assert_int_equal(image_texts_set(&texts, "Software", "tractrix", NULL), RESULT_OK);
    assert_int_equal(image_texts_set(&texts, "A key of more than thirty-one letters", "12", NULL),
                     RESULT_OK);
    const ExrFile file = {
        .image = &image, .texts = &texts, .world_to_camera = (const float(*)[4])matrix};
    assert_int_equal(exr_file_encode(&file, &exr, NULL), RESULT_OK);
    assert_int_equal(exr_file_decode_texts(&found, &exr, "x.exr", NULL), RESULT_OK);
    assert_string_equal(image_texts_find(&found, "Software"), "tractrix");
    assert_string_equal(image_texts_find(&found, "A key of more than thirty-one letters"), "12");
    // little-endian on this machine
    assert_non_null(memmem(exr.data, exr.size, matrix, sizeof matrix));
    assert_non_null(memmem(exr.data, exr.size, "worldToCamera\0m44f", 19));
    assert_non_null(memmem(exr.data, exr.size, "chromaticities", 14));
    image_texts_destroy(&texts), image_texts_destroy(&found);
    bytes_destroy(&exr);
    image_destroy(&image);
}

// --- Files of other programs.

typedef struct Maker {
    const char *names[5]; // in the order of the file
    exr_pixel_type_t type;
    exr_compression_t compression;
    bool tiled;
    exr_attr_box2i_t data, shown;
} Maker;

// Channel c's value at x, y of the test data: exact in half floats, floats and integers.
static float number_at(int c, int x, int y)
{
    return (float)(8 * c + ((x + 48) / 4 + (y + 48) / 4) % 8);
}

static void put_chunk(exr_context_t context, const exr_chunk_info_t *chunk, const Maker *maker,
                      int left, int top)
{
    exr_encode_pipeline_t pipeline = EXR_ENCODE_PIPELINE_INITIALIZER;
    size_t count = (size_t)chunk->width * (size_t)chunk->height;
    uint32_t *numbers = malloc(5 * count * sizeof *numbers);
    EXR(exr_encoding_initialize(context, 0, chunk, &pipeline));
    for (int c = 0; c < pipeline.channel_count; ++c) {
        exr_coding_channel_info_t *channel = &pipeline.channels[c];
        uint32_t *to = numbers + (size_t)c * count;
        for (size_t i = 0; i < count; ++i) {
            float value = number_at(c, left + (int)i % chunk->width, top + (int)i / chunk->width);
            if (maker->type == EXR_PIXEL_UINT)
                to[i] = (uint32_t)value;
            else
                memcpy(&to[i], &value, sizeof value);
        }
        channel->user_data_type = maker->type == EXR_PIXEL_UINT ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
        channel->user_bytes_per_element = channel->user_pixel_stride = 4;
        channel->user_line_stride = 4 * chunk->width;
        channel->encode_from_ptr = (const uint8_t *)to;
    }
    EXR(exr_encoding_choose_default_routines(context, 0, &pipeline));
    EXR(exr_encoding_run(context, 0, &pipeline));
    EXR(exr_encoding_destroy(context, &pipeline));
    free(numbers);
}

static Bytes make_file(const Maker *maker)
{
    enum { TILE = 16 };
    Disk disk = {NULL, 0};
    exr_context_initializer_t start = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_context_t context;
    exr_chunk_info_t chunk;
    const exr_attr_v2f_t middle = {.x = 0};
    int part, lines = TILE;
    start.user_data = &disk;
    start.write_fn = write_disk;
    EXR(exr_start_write(&context, "x.exr", EXR_WRITE_FILE_DIRECTLY, &start));
    EXR(exr_add_part(context, "part", maker->tiled ? EXR_STORAGE_TILED : EXR_STORAGE_SCANLINE,
                     &part));
    EXR(exr_initialize_required_attr(context, 0, &maker->shown, &maker->data, 1, &middle, 1,
                                     EXR_LINEORDER_INCREASING_Y, maker->compression));
    if (maker->tiled)
        EXR(exr_set_tile_descriptor(context, 0, TILE, TILE, EXR_TILE_ONE_LEVEL,
                                    EXR_TILE_ROUND_DOWN));
    for (int c = 0; c < 5 && maker->names[c]; ++c)
        EXR(exr_add_channel(context, 0, maker->names[c], maker->type, EXR_PERCEPTUALLY_LOGARITHMIC,
                            1, 1));
    EXR(exr_write_header(context));
    const exr_attr_box2i_t *data = &maker->data;
    if (!maker->tiled) EXR(exr_get_scanlines_per_chunk(context, 0, &lines));
    for (int y = data->min.y; y <= data->max.y; y += lines)
        for (int x = data->min.x; x <= data->max.x; x += maker->tiled ? TILE : 1 << 20) {
            EXR(maker->tiled ? exr_write_tile_chunk_info(context, 0, (x - data->min.x) / TILE,
                                                         (y - data->min.y) / TILE, 0, 0, &chunk)
                             : exr_write_scanline_chunk_info(context, 0, y, &chunk));
            put_chunk(context, &chunk, maker, x, y);
        }
    EXR(exr_finish(&context));
    return (Bytes){disk.data, disk.size};
}

// `channels`: indices of the file's channels that are R, G, B and A; -1: none.
static void assert_reads(const Maker *maker, const int channels[4])
{
    Bytes file = make_file(maker);
    Image image;
    Error error = {{0}};
    if (exr_file_decode(&image, &file, "x.exr", &error) != RESULT_OK)
        fail_msg("compression %d, type %d, tiled %d: %s", maker->compression, maker->type,
                 maker->tiled, error.text);
    const exr_attr_box2i_t *shown = &maker->shown, *data = &maker->data;
    assert_int_equal(image.width, shown->max.x - shown->min.x + 1);
    assert_int_equal(image.height, shown->max.y - shown->min.y + 1);
    assert_int_equal(image.channels, channels[3] < 0 ? 3 : 4);
    for (int y = shown->min.y; y <= shown->max.y; ++y)
        for (int x = shown->min.x; x <= shown->max.x; ++x)
            for (int k = 0; k < image.channels; ++k) {
                bool inside =
                    x >= data->min.x && x <= data->max.x && y >= data->min.y && y <= data->max.y;
                int at = (y - shown->min.y) * image.width + x - shown->min.x;
                assert_true(floats(&image)[at * image.channels + k] ==
                            (inside ? number_at(channels[k], x, y) : 0));
            }
    image_destroy(&image);
    bytes_destroy(&file);
}

static const exr_attr_box2i_t WHOLE = {.min = {.x = 0, .y = 0},
                                       .max = {.x = WIDTH - 1, .y = HEIGHT - 1}};

static void all_kinds_of_files_are_read(void **state)
{
    (void)state;
    static const exr_compression_t ways[] = {
        EXR_COMPRESSION_NONE, EXR_COMPRESSION_RLE,   EXR_COMPRESSION_ZIPS, EXR_COMPRESSION_ZIP,
        EXR_COMPRESSION_PIZ,  EXR_COMPRESSION_PXR24, EXR_COMPRESSION_B44,  EXR_COMPRESSION_B44A};
    static const exr_pixel_type_t types[] = {EXR_PIXEL_HALF, EXR_PIXEL_FLOAT, EXR_PIXEL_UINT};
    for (size_t w = 0; w < sizeof ways / sizeof *ways; ++w)
        for (int t = 0; t < 3; ++t)
            for (int tiled = 0; tiled < 2; ++tiled) {
                bool b44 = ways[w] == EXR_COMPRESSION_B44 || ways[w] == EXR_COMPRESSION_B44A;
                // OpenEXR 3.1 can't read the partial tiles that it writes
                if (b44 && tiled) continue;
                assert_reads(&(Maker){.names = {"A", "B", "G", "R", "Z"},
                                      .type = types[t],
                                      .compression = ways[w],
                                      .tiled = tiled,
                                      .data = WHOLE,
                                      .shown = WHOLE},
                             (const int[]){3, 2, 1, 0});
            }
}

static void windows_and_layers_are_found(void **state)
{
    (void)state;
    const exr_attr_box2i_t inner = {.min = {.x = 5, .y = -3}, .max = {.x = 20, .y = 12}},
                           shown = {.min = {.x = 2, .y = -1}, .max = {.x = 40, .y = 30}};
    for (int tiled = 0; tiled < 2; ++tiled) {
        Maker maker = {.names = {"B", "G", "R"},
                       .type = EXR_PIXEL_FLOAT,
                       .compression = EXR_COMPRESSION_ZIP,
                       .tiled = tiled,
                       .data = inner,
                       .shown = shown};
        assert_reads(&maker, (const int[]){2, 1, 0, -1});
        maker = (Maker){.names = {"beauty.A", "beauty.B", "beauty.G", "beauty.R", "mask.M"},
                        .tiled = tiled,
                        .data = WHOLE,
                        .shown = WHOLE};
        assert_reads(&maker, (const int[]){3, 2, 1, 0});
        maker = (Maker){.names = {"B", "G", "R", "Z"},
                        .type = EXR_PIXEL_HALF,
                        .tiled = tiled,
                        .data = WHOLE,
                        .shown = WHOLE};
        assert_reads(&maker, (const int[]){2, 1, 0, -1});
        maker = (Maker){.names = {"A", "Y", "id"}, .tiled = tiled, .data = WHOLE, .shown = WHOLE};
        assert_reads(&maker, (const int[]){1, 1, 1, 0});
        maker = (Maker){.names = {"depth.Z"}, .tiled = tiled, .data = WHOLE, .shown = WHOLE};
        assert_reads(&maker, (const int[]){0, 0, 0, -1});
    }
}

static void assert_refused(const Bytes *file, const char *says)
{
    Image image;
    Error error = {{0}};
    assert_int_equal(exr_file_decode(&image, file, "x.exr", &error), RESULT_BAD_INPUT);
    assert_null(image.pixels);
    if (strncmp(error.text, "x.exr: ", 7) != 0 || (says && !strstr(error.text, says)))
        fail_msg("'%s' lacks '%s'", error.text, says);
    for (const char *at = error.text; *at; ++at)
        if (*at < ' ' || *at > '~') fail_msg("'%s' has byte %d", error.text, *at);
}

static void what_is_not_a_colour_is_refused(void **state)
{
    (void)state;
    Maker maker = {.names = {"X", "Z"}, .data = WHOLE, .shown = WHOLE};
    Bytes file = make_file(&maker);
    assert_refused(&file, "expected R, G and B");
    bytes_destroy(&file);
    maker = (Maker){.names = {"BY", "RY", "Y"}, .data = WHOLE, .shown = WHOLE};
    file = make_file(&maker);
    assert_refused(&file, "expected R, G and B");
    bytes_destroy(&file);
    Image image = make_image(3);
    ((float *)(void *)image.pixels)[100] = INFINITY;
    const ExrFile infinite = {.image = &image};
    assert_int_equal(exr_file_encode(&infinite, &file, NULL), RESULT_OK);
    assert_refused(&file, "has infinite numbers or NaN");
    bytes_destroy(&file);
    image_destroy(&image);
}

// The display window is far larger than the file's contents could be.
static void bombs_are_refused(void **state)
{
    (void)state;
    Maker maker = {.names = {"B", "G", "R"},
                   .data = {.max = {.x = 3, .y = 3}},
                   .shown = {.max = {.x = 15999, .y = 15999}}};
    Bytes file = make_file(&maker);
    assert_refused(&file, "expected pixels of at most");
    bytes_destroy(&file);
    maker.shown.max.x = maker.shown.max.y = 100000;
    file = make_file(&maker);
    assert_refused(&file, "at most");
    bytes_destroy(&file);
}

// Damaged files never end the program; each gives an error of one line.
static void damaged_files_are_refused(void **state)
{
    (void)state;
    Image image = make_image(4), back;
    Bytes file;
    const ExrFile whole = {.image = &image};
    assert_int_equal(exr_file_encode(&whole, &file, NULL), RESULT_OK);
    for (size_t size = 0; size < file.size; size += size < 600 ? 1 : 13) {
        Bytes cut = {.data = malloc(size + 1), .size = size};
        memcpy(cut.data, file.data, size);
        assert_refused(&cut, NULL);
        bytes_destroy(&cut);
    }
    for (size_t at = 0; at < file.size; at += at < 600 ? 1 : 7)
        for (int bit = 0; bit < 8; bit += 3) {
            Error error = {{0}};
            file.data[at] ^= (uint8_t)(1 << bit);
            Result result = exr_file_decode(&back, &file, "x.exr", &error);
            assert_true(result == RESULT_OK || result == RESULT_BAD_INPUT);
            if (result != RESULT_OK) assert_null(strchr(error.text, '\n'));
            image_destroy(&back);
            file.data[at] ^= (uint8_t)(1 << bit);
        }
    bytes_destroy(&file);
    image_destroy(&image);
}

// Over black, premultiplied light stays as it is; over white, what shines through is added.
static void alpha_is_laid_over_in_light(void **state)
{
    (void)state;
    float pixel[] = {0.25f, 0.25f, 0, 0.5f};
    const Image image = {
        .width = 1, .height = 1, .channels = 4, .pixels = (uint8_t *)pixel, .kind = IMAGE_FLOAT};
    const float levels[] = {0, 255}, light[2][3] = {{0.25f, 0.25f, 0}, {0.75f, 0.75f, 0.5f}};
    for (int i = 0; i < 2; ++i) {
        FloatImage seen;
        assert_int_equal(float_image_create(&seen, &image, levels[i], NULL), RESULT_OK);
        for (int k = 0; k < 3; ++k)
            assert_true(fabs((double)seen.rgb[k] -
                             255 * image_srgb_from_linear((double)light[i][k])) < 1e-3);
        float_image_destroy(&seen);
    }
}

// OpenEXR's own programs, which are written in C++ and share no code with its C core.
static void openexr_reads_our_files(void **state)
{
    if (system("command -v exrheader >/dev/null && command -v exrmaketiled >/dev/null") != 0) {
        puts("skipped: no exrheader and exrmaketiled here (Debian package openexr)");
        skip();
    }
    char command[2000];
    Image image = make_image(4), layers[EXR_LAYERS], back;
    Bytes exr;
    make_layers(layers);
    const ExrFile file = {.image = &image, .layers = layers};
    const char *path = temporary_path(state, "x.exr"), *tiled = temporary_path(state, "t.exr");
    assert_int_equal(exr_file_encode(&file, &exr, NULL), RESULT_OK);
    assert_int_equal(bytes_write_file(&exr, path, NULL), RESULT_OK);
    snprintf(command, sizeof command,
             "exrheader %s | grep -q 'id, 32-bit unsigned integer' && exrheader %s | grep -q 'Z, "
             "32-bit floating-point' && exrmaketiled -z piz %s %s",
             path, path, path, tiled);
    assert_int_equal(system(command), 0);
    assert_int_equal(float_image_read_image(&back, tiled, NULL), RESULT_OK);
    for (int i = 0; i < 4 * PIXELS; ++i)
        assert_true(floats(&back)[i] == rounded_to_half(floats(&image)[i]));
    bytes_destroy(&exr);
    destroy_layers(layers);
    image_destroy(&image), image_destroy(&back);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, temporary_create, temporary_destroy)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(images_survive_a_round_trip),
        TEST(layers_are_channels_of_the_same_file),
        TEST(a_pixel_has_all_of_a_strand_or_nothing),
        TEST(attributes_are_kept),
        TEST(all_kinds_of_files_are_read),
        TEST(windows_and_layers_are_found),
        TEST(what_is_not_a_colour_is_refused),
        TEST(bombs_are_refused),
        TEST(damaged_files_are_refused),
        TEST(alpha_is_laid_over_in_light),
        TEST(openexr_reads_our_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
