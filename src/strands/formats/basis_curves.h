// SPDX-License-Identifier: MIT
// Curves as they stand in a USD or an Alembic file, and the strands that they are: linear curves as
// they are, cubic ones (bezier, bspline, catmullRom; nonperiodic or pinned) as points on them.
#pragma once

#include "base/usd_samples.h"
#include "strands/strands.h"

typedef enum CurvesArray {
    CURVES_COUNTS,
    CURVES_DIAMETERS,
    CURVES_COLOR,
    CURVES_OPACITY,
    CURVES_ST,
    CURVES_ST1,
    CURVES_THICKNESS,
    CURVES_MOBILITY,
    CURVES_GROUP,
    CURVES_ARRAYS
} CurvesArray;

// The numbers of each value.
extern const uint32_t CURVES_WIDTHS[CURVES_ARRAYS];

typedef struct BasisCurves {
    const char *const *names; // [CURVES_ARRAYS] of the attributes, for messages
    uint32_t per_segment; // vertices for each segment of a cubic curve; 0: 4 of bezier, 2 of others
    UsdValues array[CURVES_ARRAYS], indices[CURVES_ARRAYS];
    char rate[CURVES_ARRAYS][16]; // interpolation as the file says; "": it does not
    UsdSamples points;            // one at least
    char type[USD_WORD_SIZE], basis[USD_WORD_SIZE], wrap[USD_WORD_SIZE];
    uint32_t line; // of the prim
    float followers, follower_radius, both_ends_fixed;
    int prim;
} BasisCurves;

void basis_curves_destroy(BasisCurves *curves);

// The strands, with points (all 0) and attributes: `per_strand` points of each cubic curve, 0: by
// its segments. Fails the reader, at the array's line, where an
// array's size does not fit; the strands may be destroyed in either case.
void basis_curves_make(BasisCurves *curves, Reader *reader, uint32_t per_strand, Strands *strands);

// The points at a time, times the matrix (p' = p M), to `to` [strands.vertex_count].
void basis_curves_place(const BasisCurves *curves, const Strands *strands, double time,
                        double matrix[4][4], float (*to)[3]);

// Widths and the followers' radius grow with a transform: by the cube root of its volume.
void basis_curves_scale(Strands *strands, double matrix[4][4]);
