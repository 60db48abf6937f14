// SPDX-License-Identifier: MIT
// A BasisCurves prim as it stands in a USD file, and the strands that it is: linear curves as they
// are, cubic ones (bezier, bspline, catmullRom; nonperiodic or pinned) as points on them.
#pragma once

#include "strands/formats/usd_text.h"
#include "strands/strands.h"

typedef enum UsdArray {
    USD_COUNTS,
    USD_WIDTHS,
    USD_COLOR,
    USD_OPACITY,
    USD_ST,
    USD_ST1,
    USD_THICKNESS,
    USD_MOBILITY,
    USD_ARRAYS
} UsdArray;

// Their attributes' names, and the numbers of each value.
extern const char *const USD_ARRAY_NAMES[USD_ARRAYS];
extern const uint32_t USD_ARRAY_WIDTHS[USD_ARRAYS];

typedef struct UsdCurves {
    UsdValues array[USD_ARRAYS], indices[USD_ARRAYS];
    char rate[USD_ARRAYS][16];       // interpolation as the file says; "": it does not
    UsdValues *points;               // [sample_count] by rising time; without `timed` one
    size_t sample_count, time_count; // time_count: in the file, of which some may not be kept
    bool timed;
    char type[USD_WORD_SIZE], basis[USD_WORD_SIZE], wrap[USD_WORD_SIZE];
    uint32_t line; // of the prim
    float followers, follower_radius, both_ends_fixed;
    int prim;
} UsdCurves;

void usd_curves_destroy(UsdCurves *curves);

// The strands, with points (all 0) and attributes: `per_strand` points of each cubic curve, 0: 4
// for each segment of a bezier, 2 of the others. Fails the reader, at the array's line, where an
// array's size does not fit; the strands may be destroyed in either case.
void usd_curves_make(UsdCurves *curves, Reader *reader, uint32_t per_strand, Strands *strands);

// The points at a time, times the matrix (p' = p M), to `to` [strands.vertex_count].
void usd_curves_place(const UsdCurves *curves, const Strands *strands, double time,
                      double matrix[4][4], float (*to)[3]);
