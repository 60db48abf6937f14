// SPDX-License-Identifier: MIT
// Changes of strands that keep their number and that of their vertices.
#pragma once

#include "strands/strands.h"

// The root becomes the tip, with what belongs to each vertex; mobility stays at its place, since it
// is the root that is fixed.
void strands_reverse(Strands *strands);

// So many passes in which every vertex but root and tip goes half-way to the middle between its
// neighbours: a binomial filter (1/4, 1/2, 1/4), after n passes close to a Gaussian of variance
// n / 2 vertices squared. Strands become shorter by what is smoothed away.
void strands_smooth(Strands *strands, uint32_t passes);

// A similarity: p' = scale * rotation * p + translation.
typedef struct StrandsMove {
    double scale;          // > 0
    double rotation[3][3]; // orthogonal
    double translation[3]; // metres
} StrandsMove;

// Nothing moves.
StrandsMove strands_move_none(void);

// About the axis 0 (x), 1 (y) or 2 (z), degrees, counter-clockwise seen from its tip.
StrandsMove strands_move_rotation(int axis, double angle_deg);

// In double, rounded once; by no move at all bits stay. Thickness of vertices (metres) and the
// followers' radius are scaled, too.
void strands_move(Strands *strands, const StrandsMove *move);

// To another unit and axis for writing: positions in units of so many metres, with z up (x, -z, y)
// or y up. The inverse of what reading with that unit and axis does.
void strands_to_unit(Strands *strands, double metres, bool up_z);
