// SPDX-License-Identifier: MIT
// Files made of checksummed chunks, which are appended one by one and read in any order
// (docs/cache.md). A file cut off anywhere keeps the chunks before that place.
#pragma once

#include "base/bytes.h"
#include "base/error.h"

#include <stdbool.h>
#include <stdio.h>

enum { CHUNK_FILE_HEADER_BYTES = 16, CHUNK_HEADER_BYTES = 24 };

// A chunk's header, and where it is.
typedef struct Chunk {
    char tag[5]; // four letters and 0
    uint32_t number;
    uint64_t at; // of the header, bytes from the file's start
    uint64_t size;
    uint32_t checksum; // CRC-32 of the payload
} Chunk;

// --- Writing, to a stream whose errors are sticky.

// `magic`: 8 letters.
void chunk_file_begin(FILE *stream, const char *magic);
void chunk_write(FILE *stream, const char *tag, uint32_t number, const void *payload, size_t size);

// --- Reading. The file may grow meanwhile, and others may read it.

typedef struct ChunkFile {
    char *path;
    int descriptor; // -1: closed
    uint64_t size;  // when it was opened
} ChunkFile;

// RESULT_BAD_INPUT with path and reason if it cannot be read or is not of this magic and version.
Result chunk_file_open(ChunkFile *file, const char *path, const char *magic, Error *error);
void chunk_file_close(ChunkFile *file);

// The chunk at `at`; RESULT_BAD_INPUT "PATH: byte N: ..." if the file ends before or within it, or
// its header is damaged.
Result chunk_find(ChunkFile *file, uint64_t at, Chunk *chunk, Error *error);

static inline uint64_t chunk_end(const Chunk *chunk)
{
    return chunk->at + CHUNK_HEADER_BYTES + chunk->size;
}

// Its payload, to be freed by bytes_destroy. RESULT_BAD_INPUT as above if it is damaged,
// RESULT_FAILED if memory is short.
Result chunk_read(ChunkFile *file, const Chunk *chunk, Bytes *payload, Error *error);

// `size` bytes at `at` as they are; false if there are fewer (errno 0) or they cannot be read
// (errno).
bool chunk_file_read_raw(ChunkFile *file, uint64_t at, void *bytes, size_t size);
