// SPDX-License-Identifier: MIT
#include "base/float_planes.h"

#include <endian.h>
#include <errno.h>
#include <libdeflate.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// Measured on 10,000 x 32 particles: level 6 takes 4 times as long and saves 1 %.
enum { DEFLATE_LEVEL = 1, PLANES = 4, SIZE_BYTES = 8 };

// Bytes with more bits of entropy than this are not worth compressing.
static const double NOISE_BITS = 7.8;

size_t float_planes_bound(size_t count)
{
    return PLANES * (count + SIZE_BYTES);
}

// Maps a float to an integer so that the order is kept and neighbouring floats differ by 1.
static uint32_t order_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits >> 31 ? ~bits : bits | 0x80000000u;
}

// Writes byte `plane` of each value's folded distance from the value before. Folding maps the
// distances 0, -1, 1, -2, ... to 0, 1, 2, 3, ..., so small distances have zeros in their high
// bytes. Planes are made one by one to save memory, since frames can be large.
static void split(const float *values, size_t count, size_t stride, int plane, uint8_t *bytes)
{
    for (size_t i = 0; i < count; ++i) {
        uint32_t before = i < stride ? 0x80000000u : order_of(values[i - stride]);
        uint32_t distance = order_of(values[i]) - before;
        uint32_t folded = distance << 1 ^ (distance >> 31 ? UINT32_MAX : 0);
        bytes[i] = (uint8_t)(folded >> 8 * plane);
    }
}

// Adds one byte plane to the folded distances, which are stored in the array of values. Plane 0
// must come first, because it initialises them.
static void put_plane(float *values, size_t count, int plane, const uint8_t *bytes)
{
    for (size_t i = 0; i < count; ++i) {
        uint32_t folded = 0;
        if (plane) memcpy(&folded, &values[i], sizeof folded);
        folded |= (uint32_t)bytes[i] << 8 * plane;
        memcpy(&values[i], &folded, sizeof folded);
    }
}

static void join(float *values, size_t count, size_t stride)
{
    for (size_t i = 0; i < count; ++i) {
        uint32_t folded;
        memcpy(&folded, &values[i], sizeof folded);
        uint32_t before = i < stride ? 0x80000000u : order_of(values[i - stride]);
        uint32_t order = before + (folded >> 1 ^ (folded & 1 ? UINT32_MAX : 0));
        uint32_t bits = order >> 31 ? order & 0x7fffffffu : ~order;
        memcpy(&values[i], &bits, sizeof bits);
    }
}

static bool is_noise(const uint8_t *bytes, size_t count)
{
    size_t times[256] = {0};
    double bits = 0;
    for (size_t i = 0; i < count; ++i) ++times[bytes[i]];
    for (int i = 0; i < 256; ++i)
        if (times[i]) bits -= (double)times[i] * log2((double)times[i] / (double)count);
    return bits > NOISE_BITS * (double)count;
}

// Writes a plane: its packed size, then its bytes. A plane that does not compress is stored as it
// is; its packed size then equals its unpacked size.
static size_t pack_plane(struct libdeflate_compressor *compressor, const uint8_t *plane,
                         size_t count, uint8_t *packed)
{
    size_t size = 0;
    if (!is_noise(plane, count) && count > 1)
        size =
            libdeflate_deflate_compress(compressor, plane, count, packed + SIZE_BYTES, count - 1);
    if (size == 0) {
        size = count;
        memcpy(packed + SIZE_BYTES, plane, count);
    }
    uint64_t stored = htole64(size);
    memcpy(packed, &stored, SIZE_BYTES);
    return SIZE_BYTES + size;
}

size_t float_planes_pack(const float *values, size_t count, size_t stride, uint8_t *packed)
{
    struct libdeflate_compressor *compressor = libdeflate_alloc_compressor(DEFLATE_LEVEL);
    uint8_t *bytes = malloc(count + 1);
    size_t size = 0;
    for (int plane = 0; plane < PLANES && compressor && bytes; ++plane) {
        split(values, count, stride, plane, bytes);
        size += pack_plane(compressor, bytes, count, packed + size);
    }
    if (compressor) libdeflate_free_compressor(compressor);
    free(bytes);
    return size;
}

// Returns the number of bytes of `packed` that the plane takes; 0 if they are invalid.
static size_t unpack_plane(struct libdeflate_decompressor *decompressor, uint8_t *plane,
                           size_t count, const uint8_t *packed, size_t left)
{
    uint64_t stored;
    if (left < SIZE_BYTES) return 0;
    memcpy(&stored, packed, SIZE_BYTES);
    stored = le64toh(stored);
    if (stored > count || stored > left - SIZE_BYTES) return 0;
    size_t size = (size_t)stored;
    if (size == count)
        memcpy(plane, packed + SIZE_BYTES, count);
    else if (libdeflate_deflate_decompress(decompressor, packed + SIZE_BYTES, size, plane, count,
                                           NULL) != LIBDEFLATE_SUCCESS)
        return 0;
    return SIZE_BYTES + size;
}

bool float_planes_unpack(float *values, size_t count, size_t stride, const uint8_t *packed,
                         size_t size)
{
    struct libdeflate_decompressor *decompressor = libdeflate_alloc_decompressor();
    uint8_t *bytes = malloc(count + 1);
    bool good = decompressor && bytes;
    size_t at = 0;
    for (int plane = 0; plane < PLANES && good; ++plane) {
        size_t used = unpack_plane(decompressor, bytes, count, packed + at, size - at);
        good = used > 0;
        at += used;
        if (good) put_plane(values, count, plane, bytes);
    }
    good = good && at == size;
    if (good) join(values, count, stride);
    int reason = decompressor && bytes ? 0 : ENOMEM;
    if (decompressor) libdeflate_free_decompressor(decompressor);
    free(bytes);
    errno = reason;
    return good;
}
