// SPDX-License-Identifier: MIT
// Reads hair of any known format. The content decides the format, not the file's name.
#pragma once

#include "base/bytes.h"
#include "base/params.h"
#include "formats/strands_report.h"

// All zero: guess the unit and the axis, and mend defects.
typedef struct StrandsReadOptions {
    float unit;                 // metres per unit of the file; 0: see strands_read
    UpAxis up;                  // the file's up axis; UP_AUTO: as the file or its format says
    bool strict;                // refuse a file with any defect
    uint32_t seed;              // of the shuffle of files with `is sorted 0`
    uint32_t points_per_strand; // for files of points without strands; 0: find it
    const char *array;          // name of the positions in .npz; NULL or "": the usual names
    bool recenters;             // hair that is far from the world's zero gets an origin of its own
                                // (Strands.origin): beyond 100 m and 20 times its size
    const double *origin;       // [3] m, y up: the origin, unless `recenters`; NULL: 0
    const char *objects;        // which objects of a scene file; NULL or "": all
                                // (format_wants_object)
} StrandsReadOptions;

// All frames of an animated file. A zeroed struct is empty.
typedef struct StrandsFrames {
    uint32_t count;         // 0 if the file is not animated
    uint32_t vertices;      // of a frame
    float (*position)[3];   // [count * vertices] metres, y up
    uint32_t *first_vertex; // [strand_count + 1] of each strand; NULL: those of the strands
    double fps;             // 0 if the file does not say
    int first;              // number of the first frame
} StrandsFrames;

// Reads `path` and mends it: metres, y up, and at least one strand. Every strand has 2 ..
// STRANDS_MAX_SIZE vertices. Coordinates are finite and at most 1e6 m. Neighbours are farther apart
// than 1e-7 of the strand's largest coordinate and than 1e-9 m, so that their difference in float32
// has a direction. If a vertex is merged with the previous one, its attributes are dropped with it.
// `report` (may be NULL) lists everything that was mended; nothing is dropped, padded or cut
// without being counted there. Strands are in the file's order unless the file asks for a shuffle.
//
// A unit of 0 means: the unit that the file states (USD, and HAIR files of this program), otherwise
// a guess. TressFX 2 text is in centimetres, unless the box around it and the origin has a diagonal
// below 5 units; then it is in metres, as this program writes it. For other files the guess is m,
// cm or mm (for binary TressFX: m or cm), whichever brings the size closest, by ratio, to that of a
// head of hair, 0.35 m. The size is the geometric mean of the diagonal of the bounding box (0.5 m
// for a head) and the length of the median strand (0.25 m), so that fur on a large animal is not
// taken for a head in smaller units. Below 3.5 units the guess is m, below 111 it is cm.
//
// UP_AUTO means the axis that the file states, otherwise that of its format: z for HAIR files that
// this program did not write (Cem Yuksel's have z up), y for all others.
//
// The path "-" is standard input, which can be read once.
//
// Errors: RESULT_USAGE for an option that has no effect on the file; RESULT_BAD_INPUT (not a hair
// file, malformed, no usable strand, or defects with `strict`) with one line that names the place;
// RESULT_FAILED (memory). `strands` is then empty. If the content was well formed, `report` is
// complete even on failure; otherwise its kind is FORMAT_KINDS.
Result strands_read(Strands *strands, const char *path, const StrandsReadOptions *options,
                    StrandsReport *report, Error *error);

// Like strands_read, but with all frames. Only the first frame is mended; the others keep its
// remaining vertices. RESULT_BAD_INPUT for a frame with a coordinate that is not finite or beyond
// 1000 km.
Result strands_read_frames(Strands *strands, StrandsFrames *frames, const char *path,
                           const StrandsReadOptions *options, StrandsReport *report, Error *error);
void strands_frames_destroy(StrandsFrames *frames);

// Like strands_read, for content in memory (followed by a zero, see bytes.h). `name` replaces the
// path in messages.
Result strands_read_bytes(Strands *strands, const char *name, const Bytes *bytes,
                          const StrandsReadOptions *options, StrandsReport *report, Error *error);

// For a file that was to be a mesh and was refused with RESULT_BAD_INPUT: if it has the content of
// another format of hair than PLY, `error` names that format instead. Returns `result`.
Result strands_read_as_mesh(Result result, const char *path, Error *error);
