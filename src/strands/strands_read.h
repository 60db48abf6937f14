// SPDX-License-Identifier: MIT
// Reads hair of any known format. The content decides which, never the file's name.
#pragma once

#include "base/bytes.h"
#include "base/params.h"
#include "strands/strands_report.h"

// All zero: guess the unit and the axis, mend what can be mended.
typedef struct StrandsReadOptions {
    float unit;    // metres per unit of the file; 0: guess, see strands_read
    UpAxis up;     // the file's axis that is up; UP_AUTO: as the file says or its format has it
    bool strict;   // refuse a file with any defect
    uint32_t seed; // for the shuffle of a file that says `is sorted 0`
    uint32_t points_per_strand; // of files of points without strands; 0: find it
    const char *array;          // the name of the positions in .npz; NULL or "": the usual ones
} StrandsReadOptions;

// All frames of a file with time. A zeroed one is empty.
typedef struct StrandsFrames {
    uint32_t count;       // 0: the file has no time
    float (*position)[3]; // [count * vertex_count] of the strands, metres, y up
    double fps;           // 0: the file does not say
    int first;            // number of the first frame
} StrandsFrames;

// Reads `path` and mends it: metres, y up, and at least one strand. Every strand has 2 ..
// STRANDS_MAX_SIZE vertices, coordinates are finite and at most 1e6 m, and neighbours lie further
// apart than 1e-7 of the strand's largest coordinate and than 1e-9 m, so that float32 gives their
// difference a direction. A merged vertex takes its attributes along. What was mended is in
// `report` (may be NULL); nothing is dropped, padded or cut without being counted there. Strands
// come in the file's order unless the file asks for a shuffle.
//
// A unit of 0 is the one that the file states (USD, HAIR files of this program), or guessed.
// TressFX 2 text is in centimetres, unless all of it lies within 5 units of the origin's box, which
// is metres, as this program writes it. For the others it is the one of m, cm and mm (TressFX: of m
// and cm) that brings the size nearest to that of a head of hair by ratio, 0.35 m, where the size
// is the geometric mean of the diagonal of the vertices' box (0.5 m) and the median strand's length
// (0.25 m): so fur on a large animal is not taken for a head in smaller units. Below 3.5 units that
// is m, below 111 cm.
//
// UP_AUTO is the axis that the file states, or that of its format: z for HAIR files that this
// program did not write (Cem Yuksel's have z up), else y.
//
// The path "-" is standard input, which can be read once.
//
// Fails with RESULT_USAGE for an option that the file has no use for, RESULT_BAD_INPUT (not a hair
// file, malformed, no usable strand, or defects and `strict`) with one line that names the place,
// or RESULT_FAILED (memory); `strands` is empty then. `report` is complete where the content was
// well formed, even on failure: kind is FORMAT_KINDS where it was not.
Result strands_read(Strands *strands, const char *path, const StrandsReadOptions *options,
                    StrandsReport *report, Error *error);

// The same with all frames: those of the vertices that are left of the first frame, which alone is
// mended. RESULT_BAD_INPUT for a frame with a coordinate that is not finite or beyond 1000 km.
Result strands_read_frames(Strands *strands, StrandsFrames *frames, const char *path,
                           const StrandsReadOptions *options, StrandsReport *report, Error *error);
void strands_frames_destroy(StrandsFrames *frames);

// strands_read for content that is in memory (with a zero behind it, as bytes.h says); `name`
// stands for the path in messages.
Result strands_read_bytes(Strands *strands, const char *name, const Bytes *bytes,
                          const StrandsReadOptions *options, StrandsReport *report, Error *error);
