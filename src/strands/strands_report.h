// SPDX-License-Identifier: MIT
// What was found in a file of strands, and how it is printed.
#pragma once

#include "strands/formats/format.h"

#include <stdio.h>

// What can be wrong with content that is well formed, and how it is mended.
typedef enum DefectKind {
    DEFECT_NOT_FINITE, // strands with a coordinate that is no finite number, or beyond 1000 km:
                       // dropped
    DEFECT_TOO_SHORT,  // strands of fewer than two distinct vertices: dropped
    DEFECT_COINCIDENT, // vertices that coincide with the one before them: merged into that one
    DEFECT_ATTRIBUTE,  // values of attributes that are no finite number: replaced by 0 (UVs) or 1
    DEFECT_OVER_LIMIT, // strands longer than the file's own maxNumVerticesInStrand: kept whole
    DEFECT_UNREAD,     // bytes behind all known arrays: not read
    DEFECT_KINDS
} DefectKind;

typedef struct Defect {
    uint32_t count;       // of strands, vertices, values or bytes, as above (at most 2^32 - 1)
    uint64_t first_place; // line of a text file, from 1; byte of a binary file, from 0
} Defect;

typedef struct StrandsReport {
    FormatKind kind;
    float version;                                // 0 where the format has none
    uint32_t declared_strands, declared_vertices; // in the file
    uint32_t strands, vertices;                   // after mending
    uint32_t features;                            // STRANDS_HAS_...: what they have beside places
    bool opaque;                                  // no opacities below 1
    float unit_used;                              // metres per unit of the file
    bool up_z;                                    // the file's z is up, else its y
    bool unit_guessed, up_guessed;                // neither the caller nor the file says
    uint32_t samples;            // in time, of which the first was read; 0: the file has no time
    bool all_samples;            // ... or all of them
    char note[FORMAT_NOTE_SIZE]; // what the reader chose or left out; "": nothing to say
    bool shuffled;               // the file said `is sorted 0`
    bool rotation_was_deg;       // a `rotation` was taken to be in degrees
    Defect defects[DEFECT_KINDS];
    uint32_t empty_roots;  // strands of one vertex, left out as the data set intends (no defect)
    uint32_t shared_roots; // strands that begin exactly where an earlier one does (kept, no defect)
    uint32_t size_min, size_median, size_max; // vertices per strand, after mending
    double length_min, length_median, length_max, length_total; // metres
    float low[3], high[3];                                      // box of all vertices, metres
} StrandsReport;

// Fills what the mended strands have: counts, sizes, lengths, box, shared roots.
Result strands_report_measure(StrandsReport *report, const Strands *strands, Error *error);

// No defects at all.
bool strands_report_is_clean(const StrandsReport *report);

// One line for a defect, without a newline: the place, the count, what is wrong, and what is done
// about it if `mended`. "FILE:LINE: ..." for text, "FILE: byte N: ..." for binary content.
void strands_report_describe(const StrandsReport *report, const char *path, DefectKind kind,
                             bool mended, char *text, size_t size);

// Prints one such line for each kind of defect that there is, one with the reader's note, and one
// if the file has more than one time sample. Returns how many lines.
uint32_t strands_report_print_mended(const StrandsReport *report, const char *path, FILE *stream);

// Prints a line with what was guessed of the unit and the axis, and how to change it; nothing where
// nothing was, and for metres with y up, which change no coordinate.
void strands_report_print_guess(const StrandsReport *report, const char *path, FILE *stream);

// Whether that line would say the same of both.
bool strands_report_same_guess(const StrandsReport *a, const StrandsReport *b);

// Prints everything: kind, version, counts, lengths, box, unit and, last, the defects.
void strands_report_print(const StrandsReport *report, const char *path, FILE *stream);
