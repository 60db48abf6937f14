// SPDX-License-Identifier: MIT
// Frames of a cache as strands, in the order of the files that were simulated.
#pragma once

#include "run/cache.h"
#include "strands/strands.h"

typedef struct CacheStrands {
    CacheFile cache;
    Strands layout;    // counts and `first`, of all sections one behind the other
    uint32_t *order;   // [strand_count] which strand each of the cache is
    uint32_t *section; // [strand_count] which section each strand is of
    uint32_t section_count;
    double fps;            // frames a second
    float (*positions)[3]; // of a frame, in the cache's order
} CacheStrands;

// Opens the file. RESULT_BAD_INPUT with one line about what is wrong with it, RESULT_FAILED when
// memory is short. A zeroed struct may be closed.
Result cache_strands_open(CacheStrands *strands, const char *path, Error *error);
void cache_strands_close(CacheStrands *strands);

// A frame's strands: positions in metres, y up, and nothing else. Errors as cache_file_read.
Result cache_strands_read(CacheStrands *strands, int frame, Strands *read, Error *error);
