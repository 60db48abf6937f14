// SPDX-License-Identifier: MIT
#include "image/exr_file.h"
#include "image/exr_stream.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { READ_MAX_PIXELS = 1 << 28, READ_MAX_SIDE = 1 << 20 };
// Limits of memory: a factor on the file's size, plus a constant.
enum { READ_MAX_FACTOR = 64, READ_SURE_BYTES = 64 << 20 };

bool exr_file_is(const Bytes *file)
{
    return file->size >= 4 && memcmp(file->data, "\x76\x2f\x31\x01", 4) == 0;
}

static int64_t give_bytes(exr_const_context_t context, void *data, void *bytes, uint64_t size,
                          uint64_t offset, exr_stream_error_func_ptr_t fail)
{
    const Bytes *file = ((const ExrStream *)data)->read;
    (void)context;
    (void)fail;
    if (offset >= file->size) return 0;
    if (size > file->size - offset) size = file->size - offset;
    memcpy(bytes, file->data + offset, size);
    return (int64_t)size;
}

static int64_t tell_size(exr_const_context_t context, void *data)
{
    (void)context;
    return (int64_t)((const ExrStream *)data)->read->size;
}

enum { PLANES = 5 };

// The state of reading a file.
typedef struct Picture {
    ExrStream stream;
    const char *path;
    Image image;                  // of the display window
    exr_attr_box2i_t data, shown; // windows; the last row and column are included
    const char *names[4];         // of the channels that become R, G, B and A; NULL if absent
    exr_decode_pipeline_t pipeline;
    float *block; // [PLANES][block_room] values of one chunk; the last plane takes unused channels
    size_t block_room;
} Picture;

static Result fail_library(const Picture *picture, exr_result_t code, Error *error)
{
    return error_set(error, code == EXR_ERR_OUT_OF_MEMORY ? RESULT_FAILED : RESULT_BAD_INPUT,
                     "%s: not a readable EXR file: %s", picture->path,
                     exr_stream_reason(&picture->stream, code));
}

// Returns from the caller with an error if the call of the library failed.
#define TRY_EXR(picture, call)                                                                     \
    do {                                                                                           \
        exr_result_t code_ = (call);                                                               \
        if (code_ != EXR_ERR_SUCCESS) return fail_library((picture), code_, error);                \
    } while (0)

static Result open_file(Picture *picture, const Bytes *file, const char *path, Error *error)
{
    exr_context_initializer_t start = EXR_DEFAULT_CONTEXT_INITIALIZER;
    *picture =
        (Picture){.path = path, .stream.read = file, .pipeline = EXR_DECODE_PIPELINE_INITIALIZER};
    if (!exr_file_is(file)) return error_set(error, RESULT_BAD_INPUT, "%s: not an EXR file", path);
    start.error_handler_fn = exr_stream_keep_reason;
    start.user_data = &picture->stream;
    start.read_fn = give_bytes;
    start.size_fn = tell_size;
    start.max_image_width = start.max_image_height = READ_MAX_SIDE;
    start.max_tile_width = start.max_tile_height = READ_MAX_SIDE;
    start.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    TRY_EXR(picture, exr_start_read(&picture->stream.context, path, &start));
    return RESULT_OK;
}

static void close_file(Picture *picture)
{
    if (picture->stream.context) {
        exr_decoding_destroy(picture->stream.context, &picture->pipeline);
        exr_finish(&picture->stream.context);
    }
    free(picture->block);
    image_destroy(&picture->image);
}

static const exr_attr_chlist_entry_t *find_channel(const exr_attr_chlist_t *list, const char *layer,
                                                   int layer_length, const char *name)
{
    for (int i = 0; i < list->num_channels; ++i) {
        const char *found = list->entries[i].name.str;
        if (strncmp(found, layer, (size_t)layer_length) == 0 &&
            strcmp(found + layer_length, name) == 0)
            return &list->entries[i];
    }
    return NULL;
}

// Selects R, G, B and, if it exists, A of a layer. `layer` is "" or a name with its dot. False if
// one of R, G and B is missing.
static bool take_layer(Picture *picture, const exr_attr_chlist_t *list, const char *layer,
                       int length)
{
    static const char *const letters[] = {"R", "G", "B", "A"};
    const exr_attr_chlist_entry_t *found[4];
    for (int k = 0; k < 4; ++k) {
        found[k] = find_channel(list, layer, length, letters[k]);
        if (!found[k] && k < 3) return false;
    }
    for (int k = 0; k < 4; ++k) picture->names[k] = found[k] ? found[k]->name.str : NULL;
    return true;
}

static bool take_any_layer(Picture *picture, const exr_attr_chlist_t *list)
{
    if (take_layer(picture, list, "", 0)) return true;
    for (int i = 0; i < list->num_channels; ++i) {
        const char *name = list->entries[i].name.str, *dot = strrchr(name, '.');
        if (dot && take_layer(picture, list, name, (int)(dot - name) + 1)) return true;
    }
    return false;
}

static bool take_grey(Picture *picture, const exr_attr_chlist_t *list)
{
    const exr_attr_chlist_entry_t *grey = find_channel(list, "", 0, "Y"),
                                  *alpha = find_channel(list, "", 0, "A");
    if (find_channel(list, "", 0, "RY") || find_channel(list, "", 0, "BY")) return false;
    if (!grey && list->num_channels == 1) grey = &list->entries[0], alpha = NULL;
    if (!grey) return false;
    for (int k = 0; k < 3; ++k) picture->names[k] = grey->name.str;
    picture->names[3] = alpha ? alpha->name.str : NULL;
    return true;
}

static bool is_taken(const Picture *picture, const char *name)
{
    for (int k = 0; k < 4; ++k)
        if (picture->names[k] && strcmp(picture->names[k], name) == 0) return true;
    return false;
}

static Result choose_channels(Picture *picture, Error *error)
{
    const exr_attr_chlist_t *list;
    TRY_EXR(picture, exr_get_channels(picture->stream.context, EXR_PART, &list));
    if (!take_any_layer(picture, list) && !take_grey(picture, list))
        return error_set(error, RESULT_BAD_INPUT,
                         "%s: no colour channels: expected R, G and B, or Y alone", picture->path);
    for (int i = 0; i < list->num_channels; ++i)
        if ((list->entries[i].x_sampling != 1 || list->entries[i].y_sampling != 1) &&
            is_taken(picture, list->entries[i].name.str))
            return error_set(error, RESULT_BAD_INPUT,
                             "%s: has subsampled channels: expected a number for every pixel",
                             picture->path);
    return RESULT_OK;
}

static long long side(int first, int last)
{
    return (long long)last - first + 1;
}

// Memory that reading a chunk takes: the block here, and the packed, unpacked and intermediate
// copies in the library.
static Result find_chunk_size(const Picture *picture, uint64_t *size, Error *error)
{
    enum { COPIES = 3 };
    const exr_attr_chlist_t *list;
    uint64_t unpacked, of_pixel = 0;
    TRY_EXR(picture, exr_get_chunk_unpacked_size(picture->stream.context, EXR_PART, &unpacked));
    TRY_EXR(picture, exr_get_channels(picture->stream.context, EXR_PART, &list));
    for (int i = 0; i < list->num_channels; ++i)
        if (list->entries[i].x_sampling == 1 && list->entries[i].y_sampling == 1)
            of_pixel += list->entries[i].pixel_type == EXR_PIXEL_HALF ? 2 : 4;
    *size = COPIES * unpacked + unpacked / of_pixel * PLANES * sizeof(float);
    return RESULT_OK;
}

static Result make_image(Picture *picture, Error *error)
{
    uint64_t chunk = 0;
    exr_context_t context = picture->stream.context;
    TRY_EXR(picture, exr_get_data_window(context, EXR_PART, &picture->data));
    TRY_EXR(picture, exr_get_display_window(context, EXR_PART, &picture->shown));
    TRY(find_chunk_size(picture, &chunk, error));
    const exr_attr_box2i_t *shown = &picture->shown;
    long long width = side(shown->min.x, shown->max.x), height = side(shown->min.y, shown->max.y);
    if (width < 1 || height < 1 || width > READ_MAX_SIDE || height > READ_MAX_SIDE ||
        width * height > READ_MAX_PIXELS)
        return error_set(error, RESULT_BAD_INPUT,
                         "%s: %lld x %lld pixels: expected at most %d pixels", picture->path, width,
                         height, READ_MAX_PIXELS);
    int channels = picture->names[3] ? 4 : 3;
    uint64_t size = (uint64_t)(width * height) * (uint64_t)channels * sizeof(float),
             most = READ_MAX_FACTOR * (uint64_t)picture->stream.read->size + READ_SURE_BYTES;
    if (size > most || chunk > most - size)
        return error_set(error, RESULT_BAD_INPUT,
                         "%s: %lld x %lld pixels in a file of %zu bytes: expected pixels of at "
                         "most %d times the file's size plus %d MiB",
                         picture->path, width, height, picture->stream.read->size, READ_MAX_FACTOR,
                         READ_SURE_BYTES >> 20);
    TRY(image_create_kind(&picture->image, (int)width, (int)height, channels, IMAGE_FLOAT, error));
    memset(picture->image.pixels, 0, image_size(&picture->image));
    return RESULT_OK;
}

// Copies the values of a chunk to the image. x, y is the chunk's first pixel in the data window.
static Result store(Picture *picture, long long x, long long y, const exr_chunk_info_t *chunk,
                    Error *error)
{
    Image *image = &picture->image;
    size_t step = (size_t)image->channels;
    for (int k = 0; k < image->channels; ++k)
        for (int row = 0; row < chunk->height; ++row) {
            long long to_y = y + row - picture->shown.min.y;
            const float *from = picture->block + (size_t)k * picture->block_room +
                                (size_t)row * (size_t)chunk->width;
            if (to_y < 0 || to_y >= image->height) continue;
            float *to = (float *)(void *)image->pixels + (size_t)to_y * (size_t)image->width * step;
            for (int column = 0; column < chunk->width; ++column) {
                long long to_x = x + column - picture->shown.min.x;
                if (to_x < 0 || to_x >= image->width) continue;
                if (!isfinite(from[column]))
                    return error_set(error, RESULT_BAD_INPUT,
                                     "%s: has infinite numbers or NaN: expected finite numbers",
                                     picture->path);
                to[(size_t)to_x * step + (size_t)k] = from[column];
            }
        }
    return RESULT_OK;
}

static Result make_block(Picture *picture, const exr_chunk_info_t *chunk, Error *error)
{
    size_t count = (size_t)chunk->width * (size_t)chunk->height;
    if (picture->block_room >= count) return RESULT_OK;
    float *block = realloc(picture->block, PLANES * count * sizeof *block);
    if (!block) return error_set(error, RESULT_FAILED, "%s: no memory to read it", picture->path);
    picture->block = block;
    picture->block_room = count;
    return RESULT_OK;
}

static Result read_chunk(Picture *picture, bool first, const exr_chunk_info_t *chunk, long long x,
                         long long y, Error *error)
{
    exr_context_t context = picture->stream.context;
    exr_decode_pipeline_t *pipeline = &picture->pipeline;
    TRY(make_block(picture, chunk, error));
    memset(picture->block, 0, PLANES * picture->block_room * sizeof *picture->block);
    TRY_EXR(picture, first ? exr_decoding_initialize(context, EXR_PART, chunk, pipeline)
                           : exr_decoding_update(context, EXR_PART, chunk, pipeline));
    for (int c = 0; c < pipeline->channel_count; ++c) {
        exr_coding_channel_info_t *channel = &pipeline->channels[c];
        size_t plane = PLANES - 1;
        for (size_t k = 4; k-- > 0;)
            if (picture->names[k] && strcmp(picture->names[k], channel->channel_name) == 0)
                plane = k;
        // OpenEXR 3.1 fills all channels if there are four, even those without a destination.
        channel->decode_to_ptr = (uint8_t *)(picture->block + plane * picture->block_room);
        channel->user_bytes_per_element = channel->user_pixel_stride = sizeof(float);
        channel->user_data_type = EXR_PIXEL_FLOAT;
        channel->user_line_stride = chunk->width * (int)sizeof(float);
    }
    TRY_EXR(picture, exr_decoding_choose_default_routines(context, EXR_PART, pipeline));
    TRY_EXR(picture, exr_decoding_run(context, EXR_PART, pipeline));
    bool grey = picture->names[0] == picture->names[1];
    for (size_t k = 1; k < 3 && grey; ++k)
        memcpy(picture->block + k * picture->block_room, picture->block,
               (size_t)chunk->width * (size_t)chunk->height * sizeof *picture->block);
    return store(picture, x, y, chunk, error);
}

static Result read_lines(Picture *picture, Error *error)
{
    exr_chunk_info_t chunk;
    int32_t lines;
    TRY_EXR(picture, exr_get_scanlines_per_chunk(picture->stream.context, EXR_PART, &lines));
    for (long long y = picture->data.min.y; y <= picture->data.max.y; y += lines) {
        TRY_EXR(picture,
                exr_read_scanline_chunk_info(picture->stream.context, EXR_PART, (int)y, &chunk));
        TRY(read_chunk(picture, y == picture->data.min.y, &chunk, picture->data.min.x, y, error));
    }
    return RESULT_OK;
}

static Result read_tiles(Picture *picture, Error *error)
{
    exr_context_t context = picture->stream.context;
    exr_chunk_info_t chunk;
    int32_t wide, high;
    long long width = side(picture->data.min.x, picture->data.max.x),
              height = side(picture->data.min.y, picture->data.max.y);
    TRY_EXR(picture, exr_get_tile_sizes(context, EXR_PART, 0, 0, &wide, &high));
    for (long long row = 0; row * high < height; ++row)
        for (long long column = 0; column * wide < width; ++column) {
            TRY_EXR(picture, exr_read_tile_chunk_info(context, EXR_PART, (int)column, (int)row, 0,
                                                      0, &chunk));
            TRY(read_chunk(picture, row == 0 && column == 0, &chunk,
                           picture->data.min.x + column * wide, picture->data.min.y + row * high,
                           error));
        }
    return RESULT_OK;
}

static Result read_picture(Picture *picture, Error *error)
{
    exr_storage_t storage;
    exr_compression_t compression;
    TRY_EXR(picture, exr_get_storage(picture->stream.context, EXR_PART, &storage));
    TRY_EXR(picture, exr_get_compression(picture->stream.context, EXR_PART, &compression));
    if (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED)
        return error_set(error, RESULT_BAD_INPUT, "%s: deep pixels: expected flat ones",
                         picture->path);
    if (compression > EXR_COMPRESSION_B44A)
        return error_set(error, RESULT_BAD_INPUT,
                         "%s: compressed by DWA, which is not supported: expected another "
                         "compression, for example ZIP",
                         picture->path);
    TRY(choose_channels(picture, error));
    TRY(make_image(picture, error));
    return storage == EXR_STORAGE_TILED ? read_tiles(picture, error) : read_lines(picture, error);
}

Result exr_file_decode(Image *image, const Bytes *file, const char *path, Error *error)
{
    Picture picture;
    *image = (Image){0};
    Result result = open_file(&picture, file, path, error);
    THEN(result, read_picture(&picture, error));
    if (result == RESULT_OK) {
        *image = picture.image;
        picture.image = (Image){0};
    }
    close_file(&picture);
    return result;
}

Result exr_file_decode_texts(ImageTexts *texts, const Bytes *file, const char *path, Error *error)
{
    Picture picture;
    int32_t count = 0;
    *texts = (ImageTexts){0};
    Result result = open_file(&picture, file, path, error);
    if (result == RESULT_OK) exr_get_attribute_count(picture.stream.context, EXR_PART, &count);
    for (int32_t i = 0; i < count && result == RESULT_OK; ++i) {
        const exr_attribute_t *attribute;
        if (exr_get_attribute_by_index(picture.stream.context, EXR_PART, EXR_ATTR_LIST_FILE_ORDER,
                                       i, &attribute) != EXR_ERR_SUCCESS ||
            attribute->type != EXR_ATTR_STRING || !image_texts_is_key(attribute->name))
            continue;
        result = image_texts_set(texts, attribute->name, attribute->string->str, error);
    }
    if (result != RESULT_OK) image_texts_destroy(texts);
    close_file(&picture);
    return result;
}
