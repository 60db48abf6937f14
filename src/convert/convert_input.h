// SPDX-License-Identifier: MIT
// The room convert, the program tractrix-convert. It reads hair files and caches (this file), edits
// the strands in the order of the command line (convert_steps.h), measures them (figures.h) and
// writes them in any format of the table, still or animated (convert_output.h).
//
// This file: its input: several hair files together, numbered files as frames, or a cache.
#pragma once

#include "base/target.h"
#include "formats/strands_read.h"
#include "run/cache_file.h"

#include <jansson.h>
#include <stdio.h>

// Frames of a cache as strands, in the order of the files that were simulated.
typedef struct CacheStrands {
    CacheFile cache;
    Strands layout;    // counts and `first`, of all sections one after the other
    uint32_t *order;   // [strand_count]: the cache's number of each strand
    uint32_t *section; // [strand_count]: the section of each strand
    uint32_t section_count;
    double fps;            // frames per second
    int number;            // of the first frame
    float (*positions)[3]; // of a frame, in the cache's order
} CacheStrands;

typedef struct ConvertInput {
    char **paths; // not owned
    int path_count;
    StrandsReadOptions options;
    FILE *messages;    // for reports of repaired files; NULL: nowhere
    bool says_guess;   // messages include guesses of unit and axis
    bool wants_frames; // read all frames of a single file with time, otherwise only the first
    bool cached, numbered, framed; // if none of these, the files are one frame
    bool centred;                  // the first file has set `origin`
    double origin[3];              // m, y up: of all files (Strands.origin)
    Strands still;        // of a single file: until it is handed on, or, if framed, to the end
    StrandsFrames frames; // framed
    CacheStrands cache;
    Target pattern;
    int first, last, every; // requested frames
    bool whole;             // without `last`, truncated or missing frames are an error
    double fps;
    StrandsReport *reports; // [path_count]: of the first frame's files; NULL for a cache
    uint32_t features;      // STRANDS_HAS_...: union over the first frame's files
} ConvertInput;

// The paths are one cache, one name with %d or %04d, or hair files. `first`, `every`: as requested;
// `last` negative: the last frame that exists. `fps`: 0: the cache's, or 60. RESULT_USAGE for an
// invalid combination, RESULT_BAD_INPUT for an invalid cache or missing frames, RESULT_FAILED for
// an unfinished cache or a gap in numbered files, if `whole`.
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

// A frame's strands, of all files one after the other. Errors of strands_read and cache_file_read;
// free the strands in any case.
Result convert_input_read(ConvertInput *input, int frame, Strands *strands, Error *error);

// Prints a description of the input: the report of each file, or the cache's frames.
void convert_input_print(const ConvertInput *input, FILE *stream);

// The same as JSON; NULL when memory is short.
json_t *convert_input_to_json(const ConvertInput *input);
