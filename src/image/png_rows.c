// SPDX-License-Identifier: MIT
#include "image/png_rows.h"

#include <endian.h>
#include <isa-l/igzip_lib.h>
#include <libdeflate.h>
#include <png.h>
#include <stdlib.h>
#include <string.h>

// ISA-L's level 1 takes a third of the time of libdeflate's fastest level on frames of hair, for
// files that are 2 to 5 % larger (docs/notes/png.md).
enum { DEFLATE_LEVEL = 1, INDICES_DEFLATE_LEVEL = 9 };
enum { PIECE_BYTES = 1 << 15 }; // rows are filtered and compressed while they are in the cache
// ISA-L (up to 2.32) hashes the address of a stream in place of the bytes from its third on
// (.write_first_byte in its igzip_icf_body_h1_gr_bt.asm), so that one file in thousands had other
// matches. The first 4 to 16 bytes, flushed on their own, take a path without this error and make
// the file 6 to 8 bytes longer (docs/notes/png.md).
enum { START_BYTES = 8 };

// to = a - b, byte by byte. Written with explicit vectors, since compilers do not vectorise the
// plain loop.
static void subtract(uint8_t *to, const uint8_t *a, const uint8_t *b, size_t count)
{
    typedef uint8_t Piece __attribute__((vector_size(16)));
    size_t i = 0;
    for (; i + sizeof(Piece) <= count; i += sizeof(Piece)) {
        Piece x, y;
        memcpy(&x, a + i, sizeof x);
        memcpy(&y, b + i, sizeof y);
        x -= y;
        memcpy(to + i, &x, sizeof x);
    }
    for (; i < count; ++i) to[i] = (uint8_t)(a[i] - b[i]);
}

// Writes row y, which has `row` bytes: first the filter type, then the difference between each byte
// (in big-endian order) and the byte above it.
static void filter_row(const Image *image, int y, size_t row, uint8_t *to)
{
    bool swapped = image->kind == IMAGE_16 && htobe16(1) != 1;
    const uint8_t *here = image->pixels + (size_t)y * row, *above = y > 0 ? here - row : NULL;
    *to++ = PNG_FILTER_VALUE_UP;
    if (!above)
        for (size_t i = 0; i < row; ++i) to[i] = here[i ^ swapped];
    else if (swapped)
        for (size_t i = 0; i < row; ++i) to[i] = (uint8_t)(here[i ^ 1] - above[i ^ 1]);
    else
        subtract(to, here, above, row);
}

static size_t row_bytes(const Image *image)
{
    return image_size(image) / (size_t)image->height;
}

// --- Rows packed for speed.

typedef struct Packer {
    struct isal_zstream stream;
    uint8_t level[ISAL_DEF_LVL1_DEFAULT]; // memory of ISA-L's level 1
    Bytes packed;
    size_t room; // bytes of `packed.data`
    uint8_t rows[];
} Packer;

// Compresses bytes of the rows. False when memory is short or ISA-L refuses.
static bool add_bytes(Packer *packer, uint8_t *bytes, size_t count)
{
    struct isal_zstream *stream = &packer->stream;
    stream->next_in = bytes;
    stream->avail_in = (uint32_t)count;
    do {
        size_t room = packer->room ? 2 * packer->room : PIECE_BYTES;
        if (!stream->avail_out) {
            uint8_t *data = realloc(packer->packed.data, room);
            if (!data) return false;
            stream->next_out = data + packer->room;
            stream->avail_out = (uint32_t)(room - packer->room);
            packer->packed.data = data;
            packer->room = room;
        }
        if (isal_deflate(stream) != COMP_OK) return false;
        packer->packed.size = packer->room - stream->avail_out;
    } while (!stream->avail_out);
    return true;
}

// Compresses the next `count` of the `left` bytes, which are in `rows`.
static bool add_rows(Packer *packer, size_t count, size_t left)
{
    struct isal_zstream *stream = &packer->stream;
    size_t start = stream->total_in == 0 && left > START_BYTES ? START_BYTES : 0;
    if (start) {
        stream->flush = SYNC_FLUSH;
        if (!add_bytes(packer, packer->rows, start)) return false;
        stream->flush = NO_FLUSH;
    }
    stream->end_of_stream = count == left;
    return add_bytes(packer, packer->rows + start, count - start);
}

static bool pack(Packer *packer, const Image *image, size_t row, int rows)
{
    isal_deflate_init(&packer->stream);
    packer->stream.level = DEFLATE_LEVEL;
    packer->stream.level_buf = packer->level;
    packer->stream.level_buf_size = sizeof packer->level;
    packer->stream.gzip_flag = IGZIP_ZLIB;
    packer->stream.avail_out = 0;
    packer->packed = (Bytes){0};
    packer->room = 0;
    for (int y = 0, count; y < image->height; y += count) {
        count = image->height - y < rows ? image->height - y : rows;
        for (int i = 0; i < count; ++i)
            filter_row(image, y + i, row, packer->rows + (size_t)i * (row + 1));
        if (!add_rows(packer, (size_t)count * (row + 1), (size_t)(image->height - y) * (row + 1)))
            return false;
    }
    packer->packed.data[packer->packed.size] = 0;
    return true;
}

bool png_rows_pack(const Image *image, Bytes *packed)
{
    size_t row = row_bytes(image), rows = PIECE_BYTES / (row + 1) + 1;
    Packer *packer = malloc(sizeof *packer + rows * (row + 1));
    *packed = (Bytes){0};
    if (!packer) return false;
    bool good = pack(packer, image, row, (int)rows);
    if (good)
        *packed = packer->packed;
    else
        bytes_destroy(&packer->packed);
    free(packer);
    return good;
}

// --- Rows of indices, packed to be small.

bool png_rows_pack_indices(const Image *image, Bytes *packed)
{
    size_t row = row_bytes(image), size = (row + 1) * (size_t)image->height;
    struct libdeflate_compressor *compressor = libdeflate_alloc_compressor(INDICES_DEFLATE_LEVEL);
    size_t room = compressor ? libdeflate_zlib_compress_bound(compressor, size) : 0;
    uint8_t *rows = malloc(size);
    *packed = (Bytes){.data = malloc(room + 1)};
    if (compressor && rows && packed->data) {
        for (int y = 0; y < image->height; ++y) {
            rows[(size_t)y * (row + 1)] = PNG_FILTER_VALUE_NONE;
            memcpy(&rows[(size_t)y * (row + 1) + 1], image->pixels + (size_t)y * row, row);
        }
        packed->size = libdeflate_zlib_compress(compressor, rows, size, packed->data, room);
    }
    free(rows);
    libdeflate_free_compressor(compressor);
    if (!packed->size) {
        bytes_destroy(packed);
        return false;
    }
    packed->data[packed->size] = 0;
    return true;
}
