// SPDX-License-Identifier: MIT
// The file of a cache (docs/cache.md) without its scene: frames of all guides, and the files and
// numbers of their strands. Programs without OpenGL read it.
#pragma once

#include "base/chunk.h"

#include <stdbool.h>

#define CACHE_MAGIC   "TRXCACHE"
#define CACHE_TRAILER "TRXINDEX"

// Of the positions in a frame, which follow the head's pose.
enum { CACHE_HEAD_FLOATS = 7, CACHE_TRAILER_BYTES = 16, CACHE_STRIDE = 3 };

typedef struct CacheFile {
    ChunkFile file;
    Bytes scene;       // JSON text
    Bytes hair;        // see docs/cache.md
    uint64_t *offsets; // [frame_count]
    uint32_t frame_count, room;
    bool finished; // has its index: no frame is missing
    Error end;     // why there are no more frames, if the file is not finished
} CacheFile;

// Whether the file begins like a cache; false if it does not exist. RESULT_BAD_INPUT if it can't be
// opened or read.
Result cache_file_matches(const char *path, bool *matches, Error *error);

// Whether it is a cache that ends before its first frame, because its run was stopped early.
bool cache_file_is_stub(const char *path);

// Opens a cache, finished or not. RESULT_BAD_INPUT with one line about the file's defect,
// RESULT_FAILED when memory is short. A zeroed struct may be closed.
Result cache_file_open(CacheFile *cache, const char *path, Error *error);
void cache_file_close(CacheFile *cache);

// Checks that the file has frames 0 .. last (without reading them). RESULT_BAD_INPUT with the
// complete frames and where and why they end.
Result cache_file_check(const CacheFile *cache, int last, Error *error);

// Reads all frames and compares their checksums. Frames from the first damaged one on no longer
// count, and `end` names it and the reason. False if a frame was damaged.
bool cache_file_verify(CacheFile *cache);

// The head's rotation (unit quaternion x, y, z, w) and translation, and the positions of
// `vertex_count` vertices in the order of `hair`. RESULT_BAD_INPUT with frame and position if it is
// missing, damaged or not finite.
Result cache_file_read(CacheFile *cache, int frame, float head[CACHE_HEAD_FLOATS],
                       float (*positions)[3], uint64_t vertex_count, Error *error);

// Appends an offset to an array that grows. False if memory is short.
bool cache_file_add_offset(uint64_t **offsets, uint32_t *count, uint32_t *room, uint64_t offset);
