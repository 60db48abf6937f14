// SPDX-License-Identifier: MIT
// Writes the parts of an Ogawa file, the form of Alembic files that ogawa.h reads: data, groups of
// parts, and properties with samples. A part is written after the parts that it refers to. Only the
// file's header refers to later parts, so it is written once more at the end.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

enum { OGAWA_HEADER_BYTES = 16, OGAWA_MOST_PARTS = 24 };

typedef struct OgawaWriter {
    FILE *stream; // the caller checks its errors
    uint64_t at;  // bytes written
    bool failed;  // memory was short, so the file is invalid
} OgawaWriter;

// --- Growing blocks of little-endian bytes. A zeroed block is empty.

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

// --- Parts. Each function returns the part's place, by which others refer to it, and empties the
// block.

// The first bytes of the file. `closed`: the file is complete; `root`: its top group.
void ogawa_put_header(OgawaWriter *writer, bool closed, uint64_t root);
uint64_t ogawa_put_data(OgawaWriter *writer, OgawaBlock *block);
// Data with its key in front. `pod`: bytes per number.
uint64_t ogawa_put_sample(OgawaWriter *writer, OgawaBlock *block, uint32_t pod);
uint64_t ogawa_put_group(OgawaWriter *writer, const uint64_t *part, size_t count);

// The key by which readers recognise equal data: MurmurHash3 (Appleby), 128 bits for x64.
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

// A compound being built: the groups of its properties, at most OGAWA_MOST_PARTS - 1, and their
// headers. A zeroed struct is empty.
typedef struct OgawaCompound {
    uint64_t part[OGAWA_MOST_PARTS];
    size_t count;
    OgawaBlock headers;
} OgawaCompound;

// Adds a property whose samples are at these places of data; several samples use the file's second
// time sampling. `extent`: numbers per item. `array`: any number of items, otherwise one.
void ogawa_add_samples(OgawaWriter *writer, OgawaCompound *to, const char *name, const char *meta,
                       bool array, OgawaPod pod, uint32_t extent, const uint64_t *sample,
                       size_t count);
// The same with one sample.
void ogawa_add_one(OgawaWriter *writer, OgawaCompound *to, const char *name, const char *meta,
                   bool array, OgawaPod pod, uint32_t extent, OgawaBlock *block);
// Adds a compound to a compound, unless it is empty.
void ogawa_add_compound(OgawaWriter *writer, OgawaCompound *to, const char *name, const char *meta,
                        OgawaCompound *inner);
// Returns 0 if it is empty.
uint64_t ogawa_put_compound(OgawaWriter *writer, OgawaCompound *compound);
