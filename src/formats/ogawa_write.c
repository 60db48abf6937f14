// SPDX-License-Identifier: MIT
// The layout matches Alembic's own writer (lib/Alembic/Ogawa, AbcCoreOgawa).
#include "formats/ogawa_write.h"

#include <stdlib.h>
#include <string.h>

static const uint64_t DATA_BIT = UINT64_C(1) << 63;

// --- Bytes in little-endian order.

void ogawa_add_bytes(OgawaBlock *block, const void *bytes, size_t size)
{
    if (block->size + size > block->room) {
        size_t room = 2 * block->room + size + 64;
        uint8_t *more = realloc(block->data, room);
        block->failed = block->failed || !more;
        if (!more) return;
        block->data = more;
        block->room = room;
    }
    memcpy(block->data + block->size, bytes, size);
    block->size += size;
}

void ogawa_add_number(OgawaBlock *block, uint64_t number, int bytes)
{
    uint8_t little[8];
    for (int i = 0; i < bytes; ++i) little[i] = (uint8_t)(number >> 8 * i);
    ogawa_add_bytes(block, little, (size_t)bytes);
}

void ogawa_add_float(OgawaBlock *block, float number)
{
    uint32_t bits;
    memcpy(&bits, &number, 4);
    ogawa_add_number(block, bits, 4);
}

void ogawa_add_double(OgawaBlock *block, double number)
{
    uint64_t bits;
    memcpy(&bits, &number, 8);
    ogawa_add_number(block, bits, 8);
}

// --- Keys of data, by which readers recognise equal data: MurmurHash3 (Appleby), 128 bits for x64.

static uint64_t turn(uint64_t x, int by)
{
    return x << by | x >> (64 - by);
}

static uint64_t finish_mix(uint64_t x)
{
    x = (x ^ x >> 33) * UINT64_C(0xff51afd7ed558ccd);
    x = (x ^ x >> 33) * UINT64_C(0xc4ceb9fe1a85ec53);
    return x ^ x >> 33;
}

static uint64_t little_endian(const uint8_t *from, size_t bytes)
{
    uint64_t number = 0;
    for (size_t i = 0; i < bytes; ++i) number |= (uint64_t)from[i] << 8 * i;
    return number;
}

void ogawa_find_key(const uint8_t *data, size_t size, uint32_t seed, uint64_t key[2])
{
    const uint64_t c1 = UINT64_C(0x87c37b91114253d5), c2 = UINT64_C(0x4cf5ad432745937f);
    uint64_t a = seed, b = seed;
    size_t whole = size / 16 * 16, left = size - whole;
    for (size_t i = 0; i < whole; i += 16) {
        a ^= turn(little_endian(data + i, 8) * c1, 31) * c2;
        a = (turn(a, 27) + b) * 5 + 0x52dce729;
        b ^= turn(little_endian(data + i + 8, 8) * c2, 33) * c1;
        b = (turn(b, 31) + a) * 5 + 0x38495ab5;
    }
    if (left > 8) b ^= turn(little_endian(data + whole + 8, left - 8) * c2, 33) * c1;
    if (left > 0) a ^= turn(little_endian(data + whole, left < 8 ? left : 8) * c1, 31) * c2;
    a ^= size, b ^= size;
    a += b, b += a;
    a = finish_mix(a), b = finish_mix(b);
    a += b, b += a;
    key[0] = a, key[1] = b;
}

// --- Parts of the file. Each function returns the place of the part.

static void put(OgawaWriter *writer, const void *bytes, size_t size)
{
    fwrite(bytes, 1, size, writer->stream);
    writer->at += size;
}

static void put_number(OgawaWriter *writer, uint64_t number)
{
    uint8_t little[8];
    for (int i = 0; i < 8; ++i) little[i] = (uint8_t)(number >> 8 * i);
    put(writer, little, sizeof little);
}

uint64_t ogawa_put_data(OgawaWriter *writer, OgawaBlock *block)
{
    uint64_t place = writer->at | DATA_BIT;
    writer->failed = writer->failed || block->failed;
    if (block->size == 0)
        place = DATA_BIT;
    else {
        put_number(writer, block->size);
        put(writer, block->data, block->size);
    }
    free(block->data);
    *block = (OgawaBlock){0};
    return place;
}

// Like ogawa_put_data, but with the key in front. `pod`: bytes per number.
uint64_t ogawa_put_sample(OgawaWriter *writer, OgawaBlock *block, uint32_t pod)
{
    uint64_t key[2], place = writer->at | DATA_BIT;
    writer->failed = writer->failed || block->failed;
    if (block->size == 0) return ogawa_put_data(writer, block);
    ogawa_find_key(block->data, block->size, pod, key);
    put_number(writer, block->size + sizeof key);
    put_number(writer, key[0]);
    put_number(writer, key[1]);
    put(writer, block->data, block->size);
    free(block->data);
    *block = (OgawaBlock){0};
    return place;
}

uint64_t ogawa_put_group(OgawaWriter *writer, const uint64_t *part, size_t count)
{
    uint64_t place = writer->at;
    if (count == 0) return 0;
    put_number(writer, count);
    for (size_t i = 0; i < count; ++i) put_number(writer, part[i]);
    return place;
}

// --- Properties.

static const uint8_t POD_BYTES[] = {1, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8, 1};

enum {
    IS_SCALAR = 1,
    IS_ARRAY = 2,
    WIDE = 2 << 2,
    HAS_SAMPLING = 0x100,
    SAME_SIZE = 0x400,
    CONSTANT = 0x800,
    TEXT_FOLLOWS = 0xff << 20
};

void ogawa_add_text(OgawaBlock *block, const char *text)
{
    ogawa_add_bytes(block, text, strlen(text));
}

static void add_property(OgawaCompound *compound, const char *name, const char *meta,
                         uint64_t group)
{
    compound->part[compound->count++] = group;
    ogawa_add_number(&compound->headers, strlen(name), 4);
    ogawa_add_text(&compound->headers, name);
    ogawa_add_number(&compound->headers, strlen(meta), 4);
    ogawa_add_text(&compound->headers, meta);
}

// Adds a property whose samples are data at the given places. Scalars have no dimensions.
void ogawa_add_samples(OgawaWriter *writer, OgawaCompound *to, const char *name, const char *meta,
                       bool array, OgawaPod pod, uint32_t extent, const uint64_t *sample,
                       size_t count)
{
    size_t parts = array ? 2 * count : count;
    uint64_t *part = calloc(parts + 1, sizeof *part);
    writer->failed = writer->failed || !part;
    if (!part) return;
    for (size_t i = 0; i < count; ++i)
        if (array)
            part[2 * i] = sample[i], part[2 * i + 1] = DATA_BIT;
        else
            part[i] = sample[i];
    uint64_t group = ogawa_put_group(writer, part, parts);
    free(part);
    ogawa_add_number(&to->headers,
                     (array ? IS_ARRAY : IS_SCALAR) | WIDE | (uint32_t)pod << 4 | SAME_SIZE |
                         extent << 12 | TEXT_FOLLOWS | (count > 1 ? HAS_SAMPLING : CONSTANT),
                     4);
    ogawa_add_number(&to->headers, count, 4);
    if (count > 1) ogawa_add_number(&to->headers, 1, 4); // use the second time sampling
    add_property(to, name, meta, group);
}

void ogawa_add_one(OgawaWriter *writer, OgawaCompound *to, const char *name, const char *meta,
                   bool array, OgawaPod pod, uint32_t extent, OgawaBlock *block)
{
    uint64_t sample = ogawa_put_sample(writer, block, POD_BYTES[pod]);
    ogawa_add_samples(writer, to, name, meta, array, pod, extent, &sample, 1);
}

uint64_t ogawa_put_compound(OgawaWriter *writer, OgawaCompound *compound)
{
    if (compound->count == 0) return 0;
    compound->part[compound->count] = ogawa_put_data(writer, &compound->headers);
    return ogawa_put_group(writer, compound->part, compound->count + 1);
}

void ogawa_add_compound(OgawaWriter *writer, OgawaCompound *to, const char *name, const char *meta,
                        OgawaCompound *inner)
{
    if (inner->count == 0) return;
    uint64_t group = ogawa_put_compound(writer, inner);
    ogawa_add_number(&to->headers, WIDE | TEXT_FOLLOWS, 4);
    add_property(to, name, meta, group);
}

// --- The beginning of the file.

void ogawa_put_header(OgawaWriter *writer, bool closed, uint64_t root)
{
    const uint8_t header[8] = {'O', 'g', 'a', 'w', 'a', closed ? 0xff : 0, 0, 1};
    put(writer, header, sizeof header);
    put_number(writer, root);
}
