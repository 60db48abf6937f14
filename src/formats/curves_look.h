// SPDX-License-Identifier: MIT
// How strands are written to scene formats (USD, Alembic): look, units and frames.
#pragma once

#include "strands/strands.h"

// The rate of an attribute: how many values it has.
typedef enum CurvesRate {
    CURVES_CONSTANT, // one
    CURVES_UNIFORM,  // one per strand
    CURVES_VERTEX,   // one per vertex
} CurvesRate;

// The look of the curves. NULL arrays are left out; all arrays must outlive the writer.
typedef struct CurvesLook {
    const float *width; // diameters, in the file's unit
    CurvesRate width_rate;
    const float (*color)[4]; // linear RGB and opacity; opacity is written if any is not 1
    CurvesRate color_rate;
} CurvesLook;

// The number of values of an attribute with this rate.
size_t curves_look_count(const Strands *strands, CurvesRate rate);

// Fills in width and colour from the strands' vertices where the look has none.
void curves_look_complete(CurvesLook *look, const Strands *strands);

typedef struct CurvesOptions {
    double metres_per_unit; // of the positions, > 0
    bool up_z;              // otherwise y
    bool animated;          // with frames, otherwise a single sample without time
    double fps;             // frames a second; > 0
    int first, last;        // numbers of the frames
    CurvesLook look;
} CurvesOptions;
