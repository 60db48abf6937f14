// SPDX-License-Identifier: MIT
#include "image/exr_file.h"
#include "image/exr_stream.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROWS = 16 }; // rows of a ZIP block

static int64_t take_bytes(exr_const_context_t context, void *data, const void *bytes, uint64_t size,
                          uint64_t offset, exr_stream_error_func_ptr_t fail)
{
    // exr_stream_keep_reason must not be called here: it would wait for a lock that the library
    // holds.
    (void)context, (void)fail;
    ExrStream *stream = data;
    size_t end = (size_t)(offset + size);
    if (end > stream->room) {
        size_t room = end + end / 2 + 4096;
        uint8_t *larger = realloc(stream->written.data, room + 1);
        stream->short_of_memory = !larger;
        if (!larger) return -1;
        stream->written.data = larger;
        stream->room = room;
    }
    if (offset > stream->written.size) // a gap, to be filled later
        memset(stream->written.data + stream->written.size, 0, offset - stream->written.size);
    memcpy(stream->written.data + offset, bytes, size);
    if (end > stream->written.size) stream->written.size = end;
    return (int64_t)size;
}

// A channel: the image and the component from which it is taken, and the type in the file.
typedef struct Channel {
    const char *name;
    int layer; // ExrLayer; -1: the image
    int number;
    exr_pixel_type_t type;
} Channel;

// The order of the names' bytes, as files require. HALF stands for the type that the caller chose.
static const Channel CHANNELS[] = {{"A", -1, 3, EXR_PIXEL_HALF},
                                   {"B", -1, 2, EXR_PIXEL_HALF},
                                   {"G", -1, 1, EXR_PIXEL_HALF},
                                   {"R", -1, 0, EXR_PIXEL_HALF},
                                   {"Z", EXR_DEPTH, 0, EXR_PIXEL_FLOAT},
                                   {"coverage", EXR_COVERAGE, 0, EXR_PIXEL_HALF},
                                   {"id", EXR_STRAND, 0, EXR_PIXEL_UINT},
                                   {"tangent.X", EXR_TANGENT, 0, EXR_PIXEL_HALF},
                                   {"tangent.Y", EXR_TANGENT, 1, EXR_PIXEL_HALF},
                                   {"tangent.Z", EXR_TANGENT, 2, EXR_PIXEL_HALF}};
enum { CHANNELS_MOST = sizeof CHANNELS / sizeof *CHANNELS };

typedef struct Writer {
    ExrStream stream;
    const ExrFile *file;
    exr_encode_pipeline_t pipeline;
    uint32_t *rows; // [CHANNELS_MOST][ROWS][width] floats, or strand numbers
} Writer;

static bool has_channel(const ExrFile *file, const Channel *channel)
{
    if (channel->layer >= 0) return file->layers != NULL;
    return channel->number < file->image->channels || file->alpha;
}

static exr_result_t add_channels(const Writer *writer)
{
    exr_result_t code = EXR_ERR_SUCCESS;
    for (int c = 0; c < CHANNELS_MOST && code == EXR_ERR_SUCCESS; ++c) {
        const Channel *channel = &CHANNELS[c];
        bool widened = channel->type == EXR_PIXEL_HALF && writer->file->floats;
        if (!has_channel(writer->file, channel)) continue;
        code = exr_add_channel(writer->stream.context, EXR_PART, channel->name,
                               widened ? EXR_PIXEL_FLOAT : channel->type, EXR_PERCEPTUALLY_LINEAR,
                               1, 1);
    }
    return code;
}

static exr_result_t add_matrix(exr_context_t context, const char *name, const float (*columns)[4])
{
    // The library stores matrices for row vectors by rows, which is the same order as ours.
    exr_attr_m44f_t matrix;
    if (!columns) return EXR_ERR_SUCCESS;
    memcpy(matrix.m, columns, sizeof matrix.m);
    return exr_attr_set_m44f(context, EXR_PART, name, &matrix);
}

static exr_result_t write_header(const Writer *writer)
{
    const ExrFile *file = writer->file;
    exr_context_t context = writer->stream.context;
    const exr_attr_chromaticities_t rec709 = {.red_x = 0.64f,
                                              .red_y = 0.33f,
                                              .green_x = 0.3f,
                                              .green_y = 0.6f,
                                              .blue_x = 0.15f,
                                              .blue_y = 0.06f,
                                              .white_x = 0.3127f,
                                              .white_y = 0.329f};
    int part;
    exr_result_t code = exr_add_part(context, "image", EXR_STORAGE_SCANLINE, &part);
    if (code == EXR_ERR_SUCCESS)
        code = exr_initialize_required_attr_simple(context, EXR_PART, file->image->width,
                                                   file->image->height, EXR_COMPRESSION_ZIP);
    if (code == EXR_ERR_SUCCESS) code = add_channels(writer);
    if (code == EXR_ERR_SUCCESS)
        code = exr_attr_set_chromaticities(context, EXR_PART, "chromaticities", &rec709);
    size_t count = file->texts ? file->texts->count : 0;
    for (size_t i = 0; i < count && code == EXR_ERR_SUCCESS; ++i)
        code = exr_attr_set_string(context, EXR_PART, file->texts->list[i].key,
                                   file->texts->list[i].value);
    if (code == EXR_ERR_SUCCESS) code = add_matrix(context, "worldToCamera", file->world_to_camera);
    if (code == EXR_ERR_SUCCESS) code = add_matrix(context, "worldToNDC", file->world_to_ndc);
    return code == EXR_ERR_SUCCESS ? exr_write_header(context) : code;
}

static uint32_t bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

// Whether every layer of a strand shows one at the pixel.
static bool has_strand(const float *const layers[EXR_LAYERS], size_t i)
{
    for (int l = EXR_DEPTH; l <= EXR_STRAND; ++l) {
        const float *at = layers[l] + 3 * i;
        if (at[0] == 0 && at[1] == 0 && at[2] == 0) return false;
    }
    return true;
}

ExrPixel exr_file_pixel(const float *const layers[EXR_LAYERS], size_t i)
{
    ExrPixel pixel = {.coverage = layers[EXR_COVERAGE][3 * i]};
    const float *tangent = layers[EXR_TANGENT] + 3 * i, *strand = layers[EXR_STRAND] + 3 * i;
    double t[3], square = 0;
    if (!has_strand(layers, i)) return pixel;
    pixel.depth = layers[EXR_DEPTH][3 * i];
    pixel.strand = (uint32_t)(strand[0] * 255 + 0.5f) | (uint32_t)(strand[1] * 255 + 0.5f) << 8 |
                   (uint32_t)(strand[2] * 255 + 0.5f) << 16;
    for (int k = 0; k < 3; ++k) {
        t[k] = 2 * (double)tangent[k] - 1;
        square += t[k] * t[k];
    }
    for (int k = 0; k < 3 && square > 0; ++k) pixel.tangent[k] = (float)(t[k] / sqrt(square));
    return pixel;
}

// The value to store in a channel of a layer.
static uint32_t convert(const Channel *channel, const ExrPixel *pixel)
{
    return channel->layer == EXR_STRAND     ? pixel->strand
           : channel->layer == EXR_COVERAGE ? bits_of(pixel->coverage)
           : channel->layer == EXR_DEPTH    ? bits_of(pixel->depth)
                                            : bits_of(pixel->tangent[channel->number]);
}

static void fill_rows(const Writer *writer, int y, int rows)
{
    const Image *image = writer->file->image;
    size_t width = (size_t)image->width, first = (size_t)y * width, count = (size_t)rows * width;
    const float *layers[EXR_LAYERS] = {0};
    for (int l = 0; l < EXR_LAYERS && writer->file->layers; ++l)
        layers[l] = (const float *)(const void *)writer->file->layers[l].pixels;
    for (size_t i = 0; i < count; ++i) {
        const float *color =
            (const float *)(const void *)image->pixels + (first + i) * (size_t)image->channels;
        ExrPixel pixel = {0};
        if (writer->file->layers) pixel = exr_file_pixel(layers, first + i);
        for (int c = 0; c < CHANNELS_MOST; ++c) {
            const Channel *channel = &CHANNELS[c];
            if (!has_channel(writer->file, channel)) continue;
            writer->rows[(size_t)c * ROWS * width + i] =
                channel->layer >= 0
                    ? convert(channel, &pixel)
                    : bits_of(channel->number < image->channels ? color[channel->number] : 1);
        }
    }
}

// The rows of the channel with this name.
static const uint8_t *rows_of(const Writer *writer, const char *name)
{
    size_t width = (size_t)writer->file->image->width;
    int c = 0;
    while (c + 1 < CHANNELS_MOST && strcmp(CHANNELS[c].name, name) != 0) ++c;
    return (const uint8_t *)(writer->rows + (size_t)c * ROWS * width);
}

static exr_result_t write_block(Writer *writer, int y)
{
    exr_context_t context = writer->stream.context;
    exr_encode_pipeline_t *pipeline = &writer->pipeline;
    exr_chunk_info_t info;
    exr_result_t code = exr_write_scanline_chunk_info(context, EXR_PART, y, &info);
    if (code != EXR_ERR_SUCCESS) return code;
    code = y == 0 ? exr_encoding_initialize(context, EXR_PART, &info, pipeline)
                  : exr_encoding_update(context, EXR_PART, &info, pipeline);
    if (code != EXR_ERR_SUCCESS) return code;
    fill_rows(writer, y, info.height);
    for (int c = 0; c < pipeline->channel_count; ++c) {
        exr_coding_channel_info_t *channel = &pipeline->channels[c];
        channel->user_bytes_per_element = sizeof *writer->rows;
        channel->user_data_type =
            channel->data_type == EXR_PIXEL_UINT ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
        channel->user_pixel_stride = sizeof *writer->rows;
        channel->user_line_stride = writer->file->image->width * (int)sizeof *writer->rows;
        channel->encode_from_ptr = rows_of(writer, channel->channel_name);
    }
    if (y == 0) code = exr_encoding_choose_default_routines(context, EXR_PART, pipeline);
    return code == EXR_ERR_SUCCESS ? exr_encoding_run(context, EXR_PART, pipeline) : code;
}

static exr_result_t write_all(Writer *writer)
{
    exr_context_initializer_t start = EXR_DEFAULT_CONTEXT_INITIALIZER;
    start.error_handler_fn = exr_stream_keep_reason;
    start.user_data = &writer->stream;
    start.write_fn = take_bytes;
    exr_context_t *context = &writer->stream.context;
    exr_result_t code = exr_start_write(context, "image.exr", EXR_WRITE_FILE_DIRECTLY, &start);
    if (code != EXR_ERR_SUCCESS) return code;
    exr_set_longname_support(*context, 1);
    code = write_header(writer);
    for (int y = 0; y < writer->file->image->height && code == EXR_ERR_SUCCESS; y += ROWS)
        code = write_block(writer, y);
    exr_encoding_destroy(*context, &writer->pipeline);
    exr_result_t closed = exr_finish(context);
    return code == EXR_ERR_SUCCESS ? closed : code;
}

Result exr_file_encode(const ExrFile *file, Bytes *exr, Error *error)
{
    Writer writer = {.file = file, .pipeline = EXR_ENCODE_PIPELINE_INITIALIZER};
    Bytes *written = &writer.stream.written;
    *exr = (Bytes){0};
    writer.rows =
        malloc((size_t)CHANNELS_MOST * ROWS * (size_t)file->image->width * sizeof *writer.rows);
    exr_result_t code = writer.rows ? write_all(&writer) : EXR_ERR_OUT_OF_MEMORY;
    free(writer.rows);
    if (code != EXR_ERR_SUCCESS) {
        bytes_destroy(written);
        return error_set(error, RESULT_FAILED, "cannot encode an image of %d x %d as EXR: %s",
                         file->image->width, file->image->height,
                         exr_stream_reason(&writer.stream, code));
    }
    written->data[written->size] = 0;
    *exr = *written;
    return RESULT_OK;
}
