// SPDX-License-Identifier: MIT
// How strands are written to formats of scenes (USD, Alembic): their look, units and frames.
#pragma once

#include "strands/strands.h"

// How many values an attribute has.
typedef enum CurvesRate {
    CURVES_CONSTANT, // one
    CURVES_UNIFORM,  // one a strand
    CURVES_VERTEX,   // one a vertex
} CurvesRate;

// What the curves look like. NULL arrays are left out; all outlive the writer.
typedef struct CurvesLook {
    const float *width; // diameters in the file's unit
    CurvesRate width_rate;
    const float (*color)[4]; // linear RGB and opacity; the latter is written if any is not 1
    CurvesRate color_rate;
} CurvesLook;

// How many values an attribute of this rate has.
size_t curves_look_count(const Strands *strands, CurvesRate rate);

// Width and colour of the strands' vertices, where the look has none of its own.
void curves_look_complete(CurvesLook *look, const Strands *strands);

typedef struct CurvesOptions {
    double metres_per_unit; // of the positions, > 0
    bool up_z;              // else y
    bool animated;          // there are frames, else one without a time
    double fps;             // frames a second; > 0
    int first, last;        // numbers of the frames
    CurvesLook look;
} CurvesOptions;
