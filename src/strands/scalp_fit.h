// SPDX-License-Identifier: MIT
// Finds the head that hair grows on, where no mesh says it.
#pragma once

#include "strands/strands.h"

// An ellipsoid along the axes, m.
typedef struct ScalpFit {
    bool found;         // it looks like a head, see below
    bool other_size;    // it would look like one, but for its size
    double centre[3];   // m
    double radius[3];   // m, > 0; of other_size, too
    double error;       // m, median distance of the roots from the surface
    const char *reason; // why there is none; NULL if there is one
} ScalpFit;

// Fits an ellipsoid to the roots of `count` sets of strands (metres, y up).
//
// The algebraic equation of a sphere is linear in its centre c and in d (Coope 1993, Circle fitting
// by linear and nonlinear least squares): |p|^2 = 2 c.p + d. Two more terms, x^2 - |p|^2/3 and
// y^2 - |p|^2/3, make it an ellipsoid along the axes; a small weight pulls them to 0, since the
// roots of a scalp, which is a part of the surface, hardly tell. Roots that lie off count less, by
// Huber's weights (1964), of which the scale is 1.4826 times the median distance.
//
// A head is: at least 32 roots; radii of 5 to 40 cm (models are not always to scale) of which none
// is 2 times another; a median distance of at most 4 % of the mean radius; roots that do not all
// look one way (a patch, a wisp) nor lie all around (a ball of fur), but more above than below;
// strands that leave outwards; and at most a tenth of the vertices inside. The radii are then made
// smaller by the distance within which nine of ten roots lie, so that roots are seen.
ScalpFit scalp_fit(const Strands *strands, uint32_t count);
