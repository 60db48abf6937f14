// SPDX-License-Identifier: MIT
// Writes the parts of an Ogawa file, the form of Alembic's files that ogawa.h reads: data, groups
// of parts, and properties with their samples. A part stands behind those that it names; only the
// file's header names what comes, and is written once more at the end.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

enum { OGAWA_HEADER_BYTES = 16, OGAWA_MOST_PARTS = 24 };

typedef struct OgawaWriter {
    FILE *stream; // whose errors the caller looks at
    uint64_t at;  // bytes written
    bool failed;  // memory was short: what was written is no file
} OgawaWriter;

// --- Bytes, little-endian, as they gather. A zeroed block is empty.

typedef struct OgawaBlock {
    uint8_t *data; // owned; free it, or hand it to ogawa_put_data or ogawa_put_sample
    size_t size, room;
    bool failed;
} OgawaBlock;

void ogawa_add_bytes(OgawaBlock *block, const void *bytes, size_t size);
void ogawa_add_number(OgawaBlock *block, uint64_t number, int bytes); // the lowest 1 to 8
void ogawa_add_float(OgawaBlock *block, float number);
void ogawa_add_double(OgawaBlock *block, double number);
void ogawa_add_text(OgawaBlock *block, const char *text); // without its end

// --- Parts. Each returns its place, by which others name it; blocks are empty afterwards.

// The file's first bytes. `closed`: the file is whole; `root`: its topmost group.
void ogawa_put_header(OgawaWriter *writer, bool closed, uint64_t root);
uint64_t ogawa_put_data(OgawaWriter *writer, OgawaBlock *block);
// Data with its key in front. `pod`: bytes of one of its numbers.
uint64_t ogawa_put_sample(OgawaWriter *writer, OgawaBlock *block, uint32_t pod);
uint64_t ogawa_put_group(OgawaWriter *writer, const uint64_t *part, size_t count);

// The key by which readers know equal data: MurmurHash3 (Appleby), 128 bits for x64.
void ogawa_find_key(const uint8_t *data, size_t size, uint32_t seed, uint64_t key[2]);

// --- Properties.

typedef enum OgawaPod {
    OGAWA_BOOL = 0,
    OGAWA_U8 = 1,
    OGAWA_I16 = 4,
    OGAWA_I32 = 6,
    OGAWA_FLOAT = 10,
    OGAWA_DOUBLE = 11,
    OGAWA_STRING = 12
} OgawaPod;

// A compound as it grows: its properties' groups, at most OGAWA_MOST_PARTS - 1, and their headers.
// A zeroed one is empty.
typedef struct OgawaCompound {
    uint64_t part[OGAWA_MOST_PARTS];
    size_t count;
    OgawaBlock headers;
} OgawaCompound;

// A property with samples at these places of data; several lie in the file's second sampling.
// `extent`: numbers of an item. `array`: any number of items, else one.
void ogawa_add_samples(OgawaWriter *writer, OgawaCompound *to, const char *name, const char *meta,
                       bool array, OgawaPod pod, uint32_t extent, const uint64_t *sample,
                       size_t count);
// With one sample.
void ogawa_add_one(OgawaWriter *writer, OgawaCompound *to, const char *name, const char *meta,
                   bool array, OgawaPod pod, uint32_t extent, OgawaBlock *block);
// A compound within a compound, unless it is empty.
void ogawa_add_compound(OgawaWriter *writer, OgawaCompound *to, const char *name, const char *meta,
                        OgawaCompound *inner);
// 0: it is empty.
uint64_t ogawa_put_compound(OgawaWriter *writer, OgawaCompound *compound);
