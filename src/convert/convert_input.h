// SPDX-License-Identifier: MIT
// What tractrix-convert reads: hair files side by side, numbered files as frames, or a cache.
#pragma once

#include "base/target.h"
#include "convert/cache_strands.h"
#include "strands/strands_read.h"

#include <stdio.h>

typedef struct ConvertInput {
    char **paths; // not owned
    int path_count;
    StrandsReadOptions options;
    FILE *messages;        // what was mended and so on; NULL: not told
    bool cached, numbered; // else the files are one frame
    CacheStrands cache;
    Target pattern;
    int first, last, every; // frames that are wanted
    double fps;
    StrandsReport *reports; // [path_count] of the first frame's files; none for a cache
    uint32_t features;      // strands_features.h: of any of the first frame's files
} ConvertInput;

// What the paths are: one cache, one name with %d or %04d, or hair files. `first`, `every`: as
// asked for; `last` negative: the last that there is. `fps`: 0: the cache's, or 60. RESULT_USAGE
// for what doesn't go together, RESULT_BAD_INPUT for a cache that can't be used or frames that are
// not there.
Result convert_input_open(ConvertInput *input, Error *error);
void convert_input_close(ConvertInput *input);

static inline bool convert_input_moves(const ConvertInput *input)
{
    return input->cached || input->numbered;
}

static inline int convert_input_count(const ConvertInput *input)
{
    return (input->last - input->first) / input->every + 1;
}

// A frame's strands, of all files one behind the other. Errors as strands_read and
// cache_strands_read; free the strands in any case.
Result convert_input_read(ConvertInput *input, int frame, Strands *strands, Error *error);
