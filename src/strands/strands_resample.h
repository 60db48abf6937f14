// SPDX-License-Identifier: MIT
// Strands with other numbers of vertices.
#pragma once

#include "strands/strands.h"

typedef struct ResampleOptions {
    uint32_t count; // vertices of every strand, 2 .. STRANDS_MAX_SIZE; 0: use `spacing`
    double spacing; // m, > 0, largest distance; as few vertices as possible
    bool spline;    // along a spline through the vertices, otherwise along straight lines
} ResampleOptions;

// Puts vertices at equal distances along each strand. Root and tip keep their exact positions.
// Vertex data is interpolated linearly within the old segment, except mobility, which is that of
// the old vertex farther from the root.
//
// The spline is a Catmull-Rom spline with centripetal parameters (Yuksel, Schaefer, Keyser 2011,
// "Parameterization and applications of Catmull-Rom curves"), which has no cusps or loops within a
// segment. It is mirrored beyond the ends. Its length is that of 16 chords per segment.
//
// RESULT_FAILED when memory is short or a strand would have more than STRANDS_MAX_SIZE vertices.
Result strands_resample(Strands *strands, const ResampleOptions *options, Error *error);
