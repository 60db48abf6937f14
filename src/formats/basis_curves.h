// SPDX-License-Identifier: MIT
// Curves of a USD or Alembic file, and their conversion to strands: linear curves directly, cubic
// curves (bezier, bspline, catmullRom; nonperiodic or pinned) by points on them.
#pragma once

#include "formats/usd_samples.h"
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

// The number of components of a value of each array.
extern const uint32_t CURVES_WIDTHS[CURVES_ARRAYS];

typedef struct BasisCurves {
    const char *const *names; // [CURVES_ARRAYS] attribute names for messages
    uint32_t per_segment; // vertices per segment of a cubic curve; 0: 4 for bezier, 2 for others
    UsdValues array[CURVES_ARRAYS], indices[CURVES_ARRAYS];
    char rate[CURVES_ARRAYS][16]; // interpolation declared in the file; "" if none
    UsdSamples points;            // at least one sample
    char type[USD_WORD_SIZE], basis[USD_WORD_SIZE], wrap[USD_WORD_SIZE];
    uint32_t line; // line of the prim
    float followers, follower_radius, both_ends_fixed;
    Fibre fibre;       // in the file's units
    uint32_t unfit;    // bit k: array k does not fit, and was not read
    uint32_t polygons; // cubic curves of too few points, which became polygons
    bool changes;      // the numbers of points change; only the first sample is used
} BasisCurves;

void basis_curves_destroy(BasisCurves *curves);

// A copy that owns its arrays. Fails the reader.
void basis_curves_copy(BasisCurves *copy, const BasisCurves *curves, Reader *reader);

// Whether the curves have no ends (periodic), and whether their type and basis are known.
bool basis_curves_is_closed(const BasisCurves *curves);
bool basis_curves_is_known(const BasisCurves *curves);

// Makes the strands with attributes and with points that are all 0. `per_strand`: points of each
// cubic curve; 0: by its segments. A cubic curve whose number of points makes no whole segments
// becomes the polygon of its points. Attributes whose size does not fit are not read (`unfit`).
// Fails the reader at the line of points or counts that do not fit; the strands may be destroyed in
// either case.
void basis_curves_make(BasisCurves *curves, Reader *reader, uint32_t per_strand, Strands *strands);

// Writes the points at a time, multiplied by the matrix (p' = p M), to `to` [strands.vertex_count].
void basis_curves_place(const BasisCurves *curves, const Strands *strands, double time,
                        double matrix[4][4], float (*to)[3]);

// Scales widths and the followers' radius by a transform: by the cube root of its volume.
void basis_curves_scale(Strands *strands, double matrix[4][4]);
