// SPDX-License-Identifier: MIT
// The room convert, the program tractrix-convert. It takes hair files and caches (this file), edits
// the strands in the order of the command line (convert_steps.h), measures them (figures.h) and
// writes them in any format of the table, still or animated (convert_output.h).
//
// This file: what it reads: hair files side by side, numbered files as frames, or a cache.
#pragma once

#include "base/target.h"
#include "run/cache.h"
#include "strands/strands_read.h"

#include <jansson.h>
#include <stdio.h>

// Frames of a cache as strands, in the order of the files that were simulated.
typedef struct CacheStrands {
    CacheFile cache;
    Strands layout;    // counts and `first`, of all sections one behind the other
    uint32_t *order;   // [strand_count] which strand each of the cache is
    uint32_t *section; // [strand_count] which section each strand is of
    uint32_t section_count;
    double fps;            // frames a second
    float (*positions)[3]; // of a frame, in the cache's order
} CacheStrands;

typedef struct ConvertInput {
    char **paths; // not owned
    int path_count;
    StrandsReadOptions options;
    FILE *messages;                // reports what was mended; NULL: nowhere
    bool says_guess;               // of unit and axis, among the messages
    bool wants_frames;             // of a single file with time all of them, else only the first
    bool cached, numbered, framed; // else the files are one frame
    Strands still;                 // of a single file, until it is handed on; framed: to the end
    StrandsFrames frames;          // framed
    CacheStrands cache;
    Target pattern;
    int first, last, every; // frames that are wanted
    bool whole;             // without `last`, frames that are cut off or missing are an error
    double fps;
    StrandsReport *reports; // [path_count] of the first frame's files; none for a cache
    uint32_t features;      // STRANDS_HAS_...: of any of the first frame's files
} ConvertInput;

// What the paths are: one cache, one name with %d or %04d, or hair files. `first`, `every`: as
// asked for; `last` negative: the last that there is. `fps`: 0: the cache's, or 60. RESULT_USAGE
// for what doesn't go together, RESULT_BAD_INPUT for a cache that can't be used or frames that are
// not there, RESULT_FAILED for an unfinished cache or a gap in numbered files, if `whole`.
Result convert_input_open(ConvertInput *input, Error *error);
void convert_input_close(ConvertInput *input);

static inline bool convert_input_moves(const ConvertInput *input)
{
    return input->cached || input->numbered || input->framed;
}

static inline int convert_input_count(const ConvertInput *input)
{
    return (input->last - input->first) / input->every + 1;
}

// A frame's strands, of all files one behind the other. Errors as strands_read and
// cache_file_read; free the strands in any case.
Result convert_input_read(ConvertInput *input, int frame, Strands *strands, Error *error);

// Prints what the input is: the report of each file, or the cache's frames.
void convert_input_print(const ConvertInput *input, FILE *stream);

// The same as JSON; NULL when memory is short.
json_t *convert_input_to_json(const ConvertInput *input);
