// SPDX-License-Identifier: MIT
// Reads the file of a simulation's cache (docs/cache.md) without the scene that it is of: frames of
// all guides, and which strands of which files they are.
#pragma once

#include "base/chunk.h"

#include <stdbool.h>

#define CACHE_MAGIC   "TRXCACHE"
#define CACHE_TRAILER "TRXINDEX"

// Of positions in a frame; the head's pose stands before them.
enum { CACHE_HEAD_FLOATS = 7, CACHE_TRAILER_BYTES = 16, CACHE_STRIDE = 3 };

typedef struct CacheFile {
    ChunkFile file;
    Bytes scene;       // JSON text
    Bytes hair;        // as docs/cache.md has it
    uint64_t *offsets; // [frame_count]
    uint32_t frame_count, room;
    Error end; // why there are no more, if that is not the file's proper end
} CacheFile;

// Whether the file begins like a cache; false, too, if it can't be read.
bool cache_file_matches(const char *path);

// Opens a cache, finished or not. RESULT_BAD_INPUT with one line about what is wrong with the file,
// RESULT_FAILED when memory is short. A zeroed struct may be closed.
Result cache_file_open(CacheFile *cache, const char *path, Error *error);
void cache_file_close(CacheFile *cache);

// Whether the frames 0 .. last are there (they may yet turn out to be damaged); RESULT_BAD_INPUT
// with the number of whole frames and where and why they end.
Result cache_file_check(const CacheFile *cache, int last, Error *error);

// The head's rotation (unit quaternion x, y, z, w) and translation, and the positions of so many
// vertices in the order of `hair`. RESULT_BAD_INPUT with frame and place if it is missing or
// damaged.
Result cache_file_read(CacheFile *cache, int frame, float head[CACHE_HEAD_FLOATS],
                       float (*positions)[3], uint64_t vertex_count, Error *error);

// Appends to an array of offsets that grows; false when memory is short.
bool cache_add_offset(uint64_t **offsets, uint32_t *count, uint32_t *room, uint64_t offset);
