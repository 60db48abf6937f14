// SPDX-License-Identifier: MIT
// A simulation's frames in a file: what is drawn of the guides, and where the head is, bit for bit
// (docs/cache.md). One process writes, any number reads, any frame without the others.
#pragma once

#include "run/cache_file.h"
#include "sim/simulation.h"

// --- Writing. After a failure, or instead of cache_writer_finish, the file keeps the frames that
// are in it.

typedef struct CacheWriter {
    char *path;
    FILE *stream;      // NULL: closed
    uint64_t *offsets; // [frame_count]
    uint64_t at;       // bytes written
    uint32_t frame_count, room;
    float (*positions)[3]; // of all guides
    uint8_t *payload;
    double write_ms; // spent so far, with packing
} CacheWriter;

// Makes the file anew, or empties it. RESULT_FAILED with path and reason, also if another process
// is writing it.
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

// Whether the frames 0 .. last are there (they may yet turn out to be damaged); RESULT_BAD_INPUT
// with the number of whole frames and where and why they end.
Result cache_reader_check(const CacheReader *reader, int last, Error *error);

// Shows the frame: simulation_show. RESULT_BAD_INPUT with frame and place if it is missing or
// damaged.
Result cache_reader_show(CacheReader *reader, Simulation *simulation, int frame, Error *error);
