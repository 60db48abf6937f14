// SPDX-License-Identifier: MIT
#include "image/jpeg.h"

#include <stdlib.h>
#include <string.h>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wdouble-promotion"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#include <stb_image_write.h>
#pragma GCC diagnostic pop

// A growing buffer that always has room for a zero byte at its end. After a failure, further bytes
// are dropped.
typedef struct Sink {
    Bytes bytes;
    size_t room;
    bool failed;
} Sink;

static void take_bytes(void *context, void *data, int size)
{
    Sink *sink = context;
    Bytes *bytes = &sink->bytes;
    size_t needed = bytes->size + (size_t)size + 1;
    if (sink->failed) return;
    if (needed > sink->room) {
        size_t room = 2 * needed + 4096;
        uint8_t *grown = realloc(bytes->data, room);
        sink->failed = !grown;
        if (!grown) return;
        bytes->data = grown;
        sink->room = room;
    }
    memcpy(bytes->data + bytes->size, data, (size_t)size);
    bytes->size += (size_t)size;
    bytes->data[bytes->size] = 0;
}

Result jpeg_encode(const Image *image, int quality, Bytes *jpeg, Error *error)
{
    enum { MOST_PX = 65535 };
    Sink sink = {0};
    *jpeg = (Bytes){0};
    if (image->kind != IMAGE_8 || image->channels != 3)
        return error_set(error, RESULT_FAILED,
                         "an image of 16 bits, of floats or with transparency: expected 8 bits "
                         "without transparency, since JPEG stores nothing else");
    if (image->width > MOST_PX || image->height > MOST_PX)
        return error_set(
            error, RESULT_FAILED,
            "an image of %d x %d pixels: expected at most 65535 x 65535, the limit of JPEG",
            image->width, image->height);
    int done = stbi_write_jpg_to_func(take_bytes, &sink, image->width, image->height, 3,
                                      image->pixels, quality);
    if (done && !sink.failed) {
        *jpeg = sink.bytes;
        return RESULT_OK;
    }
    bytes_destroy(&sink.bytes);
    return error_set(error, RESULT_FAILED, "no memory to encode an image of %d x %d", image->width,
                     image->height);
}

bool jpeg_is(const Bytes *file)
{
    return file->size > 2 && memcmp(file->data, "\xff\xd8\xff", 3) == 0;
}
