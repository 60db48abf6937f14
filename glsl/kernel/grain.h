// SPDX-License-Identifier: MIT
// The density of hair in the cells of a section's volume (sim/volume.h). Hair counts in grains:
// groups of particles that follow each other on a strand and count where the middle one lies.
#include "common/shared_math.h"
#ifdef __STDC__
#pragma once
#endif

// The middle particle of the grain that begins with particle j of a strand.
SHARED_FUNCTION int grain_middle(int j, int grain, int last)
{
    int middle = j + grain / 2;
    return middle < last ? middle : last;
}

// The cell at a place along the axes, in cells; -1 for those at the edge, which stay empty, beside
// them, and for what is no number.
SHARED_FUNCTION int grain_cell_at(float x, float y, float z, int width, int height, int depth)
{
    bool inside = x >= 1.0f && y >= 1.0f && z >= 1.0f && x < FLOAT(width - 1) &&
                  y < FLOAT(height - 1) && z < FLOAT(depth - 1);
    return inside ? (INT(z) * height + INT(y)) * width + INT(x) : -1;
}

// A cell's count smoothed: its own twice and of those beside it once. AT(c): the count of cell c.
#define GRAIN_SMOOTH(AT, c, row, slice)                                                            \
    (AT(c) + AT(c) + AT((c)-1) + AT((c) + 1) + AT((c) - (row)) + AT((c) + (row)) +                 \
     AT((c) - (slice)) + AT((c) + (slice)))
