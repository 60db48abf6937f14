// SPDX-License-Identifier: MIT
// The properties and defects of a file of strands, and how they are printed.
#pragma once

#include "formats/format.h"

#include <stdio.h>

// Defects of well-formed content, and how they are mended.
typedef enum DefectKind {
    DEFECT_NOT_FINITE, // strands with a coordinate that is not finite or beyond 1000 km: dropped
    DEFECT_TOO_SHORT,  // strands with fewer than two distinct vertices: dropped
    DEFECT_COINCIDENT, // vertices that coincide with the previous one: merged with it
    DEFECT_ATTRIBUTE,  // attribute values that are not finite: replaced by 0 (UVs) or 1
    DEFECT_OVER_LIMIT, // strands longer than the file's own maxNumVerticesInStrand: kept whole
    DEFECT_PADDING,    // strands that end with zeros behind their tip: cut off
    DEFECT_UNREAD,     // bytes after all known arrays: not read
    DEFECT_KINDS
} DefectKind;

typedef struct Defect {
    uint32_t count;       // strands, vertices, values or bytes, as listed above (at most 2^32 - 1)
    uint64_t first_place; // line of a text file, from 1; byte of a binary file, from 0
} Defect;

typedef struct StrandsReport {
    FormatKind kind;
    float version;                                // 0 if the format has none
    uint32_t declared_strands, declared_vertices; // in the file
    uint32_t strands, vertices;                   // after mending
    uint32_t features;                            // STRANDS_HAS_...
    bool opaque;                                  // no opacity is below 1
    float unit_used;                              // metres per unit of the file
    bool up_z;                                    // the file's up axis is z, otherwise y
    bool unit_guessed, up_guessed;                // neither the caller nor the file gives it
    uint32_t samples;            // number in time, of which the first was read; 0 if not animated
    bool all_samples;            // all of them were read
    char note[FORMAT_NOTE_SIZE]; // choices and omissions of the reader; "" if none
    uint32_t flaws;              // how many of these --strict refuses
    FormatContents contents;     // objects and unread attributes of a scene file
    bool shuffled;               // the file said `is sorted 0`
    bool rotation_was_deg;       // a `rotation` was taken to be in degrees
    Defect defects[DEFECT_KINDS];
    uint32_t empty_roots;  // strands of one vertex, left out as intended by the data set (not a
                           // defect)
    uint32_t shared_roots; // strands whose root coincides with an earlier one (kept, not a defect)
    uint32_t size_min, size_median, size_max; // vertices per strand, after mending
    double length_min, length_median, length_max, length_total; // metres
    float low[3], high[3];                                      // box of all vertices, metres
} StrandsReport;

// Fills in the properties of the mended strands: counts, sizes, lengths, box, shared roots.
Result strands_report_measure(StrandsReport *report, const Strands *strands, Error *error);

// Whether there are no defects and no flaws.
bool strands_report_is_clean(const StrandsReport *report);

// Writes one line about a defect, without a newline: place, count, what is wrong and, if `mended`,
// what was done about it. "FILE:LINE: ..." for text, "FILE: byte N: ..." for binary content.
void strands_report_describe(const StrandsReport *report, const char *path, DefectKind kind,
                             bool mended, char *text, size_t size);

// Prints such a line for each kind of defect found, one with the reader's note, and one if the file
// has more than one time sample. Returns the number of lines.
uint32_t strands_report_print_mended(const StrandsReport *report, const char *path, FILE *stream);

// Prints a line with the guessed unit and axis and how to change them. Prints nothing if nothing
// was guessed, or if the guess is metres with y up, which change no coordinate.
void strands_report_print_guess(const StrandsReport *report, const char *path, FILE *stream);

// Whether strands_report_print_guess would print the same for both.
bool strands_report_same_guess(const StrandsReport *a, const StrandsReport *b);

// Prints the objects of a file that has several or leaves some out, and the attributes that are not
// read; a line each.
void strands_report_print_contents(const StrandsReport *report, FILE *stream);

// Prints everything: kind, version, counts, lengths, box, unit and finally the defects.
void strands_report_print(const StrandsReport *report, const char *path, FILE *stream);
