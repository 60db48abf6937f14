// SPDX-License-Identifier: MIT
// Strands with other vertices.
#pragma once

#include "strands/strands.h"

typedef struct ResampleOptions {
    uint32_t count; // vertices of every strand, 2 .. STRANDS_MAX_SIZE; 0: by `spacing`
    double spacing; // metres: as few vertices as lie at most so far apart, > 0
    bool spline;    // through the vertices runs a spline, else straight lines
} ResampleOptions;

// Puts vertices at equal distances along each strand. Root and tip stay, to the bit. What belongs
// to vertices is interpolated linearly between the two old ones, by the share of the segment;
// mobility is that of the old vertex further from the root.
//
// The spline is Catmull and Rom's with centripetal parameters (Yuksel, Schaefer, Keyser 2011,
// "Parameterization and applications of Catmull-Rom curves"), which has neither cusps nor loops
// within a segment; beyond the ends it goes on as if mirrored there. Lengths along it are those of
// 16 chords a segment.
//
// RESULT_FAILED when memory is short or a strand would have more than STRANDS_MAX_SIZE vertices.
Result strands_resample(Strands *strands, const ResampleOptions *options, Error *error);
