// SPDX-License-Identifier: MIT
// A BasisCurves prim as it stands in a `.usda` file, and the strands that it is.
#pragma once

#include "strands/formats/usd_text.h"
#include "strands/strands.h"

typedef enum UsdArray {
    USD_COUNTS,
    USD_POINTS,
    USD_WIDTHS,
    USD_COLOR,
    USD_OPACITY,
    USD_ST,
    USD_ST1,
    USD_THICKNESS,
    USD_MOBILITY,
    USD_ARRAYS
} UsdArray;

// Their attributes' names, "points".
extern const char *const USD_ARRAY_NAMES[USD_ARRAYS];

typedef struct UsdCurves {
    UsdValues array[USD_ARRAYS];
    char type[USD_WORD_SIZE], wrap[USD_WORD_SIZE];
    uint32_t line; // of the prim
    float followers, follower_radius, both_ends_fixed;
} UsdCurves;

// The strands of curves that have points; arrays move into them. Fails the reader, at the array's
// line, where an array's size does not fit the curves, and at curves that are not linear, or
// periodic. The strands may be destroyed in either case.
Result usd_curves_make(Strands *strands, Reader *reader, UsdCurves *curves);
void usd_curves_destroy(UsdCurves *curves);
