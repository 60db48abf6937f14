// SPDX-License-Identifier: MIT
// Files made of checksummed chunks, which are appended one after the other and read in any order
// (docs/cache.md). If a file is cut off, the chunks before that place are still readable.
#pragma once

#include "base/bytes.h"
#include "base/error.h"

#include <stdbool.h>
#include <stdio.h>

enum { CHUNK_FILE_HEADER_BYTES = 16, CHUNK_HEADER_BYTES = 24 };

// A chunk's header and its place.
typedef struct Chunk {
    char tag[5]; // four letters and a zero
    uint32_t number;
    uint64_t at; // of the header, in bytes from the start of the file
    uint64_t size;
    uint32_t checksum; // CRC-32 of the payload
} Chunk;

// --- Writing, to a stream whose errors are sticky.

// `magic`: 8 letters.
void chunk_file_begin(FILE *stream, const char *magic);
void chunk_write(FILE *stream, const char *tag, uint32_t number, const void *payload, size_t size);

// --- Reading. The file may grow meanwhile, and several processes may read it.

typedef struct ChunkFile {
    char *path;
    int descriptor; // -1 if closed
    uint64_t size;  // when it was opened
} ChunkFile;

// RESULT_BAD_INPUT with path and reason if it cannot be read or has another magic or version.
Result chunk_file_open(ChunkFile *file, const char *path, const char *magic, Error *error);
void chunk_file_close(ChunkFile *file);

// The chunk at `at`; RESULT_BAD_INPUT "PATH: byte N: ..." if the file ends before or within it, or
// its header is damaged.
Result chunk_find(ChunkFile *file, uint64_t at, Chunk *chunk, Error *error);

static inline uint64_t chunk_end(const Chunk *chunk)
{
    return chunk->at + CHUNK_HEADER_BYTES + chunk->size;
}

// The payload of the chunk; free it with bytes_destroy. RESULT_BAD_INPUT as above if it is damaged,
// RESULT_FAILED if memory is short.
Result chunk_read(ChunkFile *file, const Chunk *chunk, Bytes *payload, Error *error);

// Reads `size` bytes at `at`. False if there are fewer (errno 0) or if they cannot be read (errno).
bool chunk_file_read_raw(ChunkFile *file, uint64_t at, void *bytes, size_t size);
