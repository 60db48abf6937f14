// SPDX-License-Identifier: MIT
// Estimates the head under the hair if there is no mesh.
#pragma once

#include "strands/strands.h"

// An axis-aligned ellipsoid, m.
typedef struct ScalpFit {
    bool found;         // it looks like a head, see below
    bool other_size;    // it would look like a head in another size
    bool around;        // fur: roots surround the ellipsoid, whatever its form and size, and
                        // strands leave it outwards
    double centre[3];   // m
    double radius[3];   // m, > 0; also set with other_size
    double error;       // m, median distance of the roots from the surface
    const char *reason; // why no head was found; NULL if one was
} ScalpFit;

// Fits an ellipsoid to the roots of `count` sets of strands (metres, y up).
//
// The algebraic equation of a sphere is linear in its centre c and in d (Coope 1993, Circle fitting
// by linear and nonlinear least squares): |p|^2 = 2 c.p + d. Two more terms, x^2 - |p|^2/3 and y^2
// - |p|^2/3, make it an axis-aligned ellipsoid. A small regularisation pulls these terms to 0,
// because the roots cover only a part of the surface and hardly determine them. Outliers get
// Huber's weights (1964) with a scale of 1.4826 times the median distance.
//
// The ellipsoid counts as a head under these conditions: there are at least 32 roots; the radii are
// 5 to 40 cm (models are not always to scale) and differ by less than a factor of 2; the median
// distance is at most 4 % of the mean radius; the roots do not all lie in one direction (a patch, a
// wisp) nor all around (a ball of fur), and more of them above than below; strands leave outwards;
// and at most a tenth of the vertices are inside. Finally the radii are reduced by the 90th
// percentile of the roots' distances, so that roots are visible.
ScalpFit scalp_fit(const Strands *strands, uint32_t count);
