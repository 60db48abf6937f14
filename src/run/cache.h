// SPDX-License-Identifier: MIT
// A simulation's frames in a file: drawn positions of the guides and the head's pose, bit for bit
// (docs/cache.md). One process writes, any number reads, any frame without the others.
#pragma once

#include "base/chunk.h"
#include "sim/simulation.h"

#include <stdbool.h>

// --- The file (docs/cache.md), without the scene that it is of: frames of all guides, and which
// strands of which files they are.

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
    bool finished; // it has its index: no frame is missing
    Error end;     // why there are no more, if that is not the file's proper end
} CacheFile;

// Whether the file begins like a cache; no if there is none. RESULT_BAD_INPUT if it can't be opened
// or read.
Result cache_file_matches(const char *path, bool *matches, Error *error);

// Whether it is a cache that ends before its first frame could begin: its run was stopped at once.
bool cache_file_is_stub(const char *path);

// Opens a cache, finished or not. RESULT_BAD_INPUT with one line about the file's defect,
// RESULT_FAILED when memory is short. A zeroed struct may be closed.
Result cache_file_open(CacheFile *cache, const char *path, Error *error);
void cache_file_close(CacheFile *cache);

// Checks that the file has frames 0 .. last (without reading them). RESULT_BAD_INPUT with the
// complete frames and where and why they end.
Result cache_file_check(const CacheFile *cache, int last, Error *error);

// Reads all frames and compares their checksums. From the first damaged one on, frames no longer
// count: `end` says which and why. False when one was damaged.
bool cache_file_verify(CacheFile *cache);

// The head's rotation (unit quaternion x, y, z, w) and translation, and the positions of
// `vertex_count` vertices in the order of `hair`. RESULT_BAD_INPUT with frame and place if it is
// missing, damaged or not finite.
Result cache_file_read(CacheFile *cache, int frame, float head[CACHE_HEAD_FLOATS],
                       float (*positions)[3], uint64_t vertex_count, Error *error);

// --- Writing. After a failure, or instead of cache_writer_finish, the file keeps the frames that
// are in it.

typedef struct CacheWriter {
    char *path;
    FILE *stream;      // NULL: closed
    uint64_t *offsets; // [frame_count]
    uint64_t at;       // bytes written
    uint32_t frame_count, room;
    float (*positions)[3]; // of all guides; NULL between large frames
    uint8_t *payload;
    int reason;      // errno of the first write that failed, 0: none has
    double write_ms; // spent so far, with packing
} CacheWriter;

// Makes the file anew, or empties one that is a cache already. RESULT_FAILED with path and reason,
// also for a file of another kind, which stays as it is, and if another process is writing it.
Result cache_writer_open(CacheWriter *writer, const char *path, const Simulation *simulation,
                         const Strands *strands, Error *error);

struct CacheReader;

// Goes on behind the first `frame_count` frames (>= 1) of the file that `reader` has open; what
// follows them is cut off. Errors as above.
Result cache_writer_continue(CacheWriter *writer, const struct CacheReader *reader,
                             uint32_t frame_count, const Simulation *simulation, Error *error);

// Appends the frame that the simulation has posed. RESULT_FAILED with path and reason.
Result cache_writer_add(CacheWriter *writer, const Simulation *simulation, Error *error);

// Appends the index, which a reader can do without, and waits for the disk.
Result cache_writer_finish(CacheWriter *writer, Error *error);
void cache_writer_close(CacheWriter *writer);

// --- Reading.

typedef struct CacheReader {
    CacheFile cache;
    float (*positions)[3];
    uint64_t particle_count;
} CacheReader;

// Opens a cache of this very simulation, finished or not. RESULT_BAD_INPUT with one line about what
// is wrong with the file, or in which value the scene differs.
Result cache_reader_open(CacheReader *reader, const char *path, const Simulation *simulation,
                         const Strands *strands, Error *error);
void cache_reader_close(CacheReader *reader);

// Checks that the file has frames 0 .. last (without reading them). RESULT_BAD_INPUT with the
// complete frames and where and why they end.
Result cache_reader_check(const CacheReader *reader, int last, Error *error);

// Shows the frame: simulation_show. RESULT_BAD_INPUT with frame and place if it is missing or
// damaged.
Result cache_reader_show(CacheReader *reader, Simulation *simulation, int frame, Error *error);
