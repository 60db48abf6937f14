// SPDX-License-Identifier: MIT
// A cache file stores a simulation's frames bit for bit: drawn positions of the guides and the
// head's pose (docs/cache.md). One process writes it; any number of processes read it, in any order
// of frames.
#pragma once

#include "run/cache_file.h"
#include "sim/simulation.h"

// --- Writing. After a failure, or without cache_writer_finish, the file keeps the frames written
// so far.

typedef struct CacheWriter {
    char *path;
    FILE *stream;      // NULL: closed
    uint64_t *offsets; // [frame_count]
    uint64_t at;       // bytes written
    uint32_t frame_count, room;
    float (*positions)[3]; // of all guides; NULL between large frames
    uint8_t *payload;
    int reason;      // errno of the first failed write, 0: none failed
    double write_ms; // total time, including packing
} CacheWriter;

// Creates the file, or empties an existing cache. RESULT_FAILED with path and reason, also for a
// file of another kind, which is not changed, and if another process is writing this file.
Result cache_writer_open(CacheWriter *writer, const char *path, const Simulation *simulation,
                         const Strands *strands, Error *error);

struct CacheReader;

// Continues after the first `frame_count` frames (>= 1) of the file that `reader` has open, and
// removes what follows them. Errors as above.
Result cache_writer_continue(CacheWriter *writer, const struct CacheReader *reader,
                             uint32_t frame_count, const Simulation *simulation, Error *error);

// Appends the frame that the simulation has posed. RESULT_FAILED with path and reason.
Result cache_writer_add(CacheWriter *writer, const Simulation *simulation, Error *error);

// Appends the index, which readers can do without, and waits until everything is on disk.
Result cache_writer_finish(CacheWriter *writer, Error *error);
void cache_writer_close(CacheWriter *writer);

// --- Reading.

typedef struct CacheReader {
    CacheFile cache;
    float (*positions)[3];
    uint64_t particle_count;
} CacheReader;

// Opens a cache of exactly this simulation, finished or not. RESULT_BAD_INPUT with one line about
// the file's defect, or the value in which the scene differs.
Result cache_reader_open(CacheReader *reader, const char *path, const Simulation *simulation,
                         const Strands *strands, Error *error);
void cache_reader_close(CacheReader *reader);

// Checks that the file has frames 0 .. last (without reading them). RESULT_BAD_INPUT with the
// complete frames and where and why they end.
Result cache_reader_check(const CacheReader *reader, int last, Error *error);

// Shows the frame by simulation_show. RESULT_BAD_INPUT with frame and position if it is missing or
// damaged.
Result cache_reader_show(CacheReader *reader, Simulation *simulation, int frame, Error *error);
