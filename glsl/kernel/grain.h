// SPDX-License-Identifier: MIT
// The density of hair in the cells of a section's volume (sim/volume.h). Hair is counted in grains:
// groups of consecutive particles of a strand, which count at the place of their middle particle.
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

// The cell at a place, in cells along the axes. -1 for NaN, outside the grid, and for cells at its
// border, which stay empty.
SHARED_FUNCTION int grain_cell_at(float x, float y, float z, int width, int height, int depth)
{
    bool inside = x >= 1.0f && y >= 1.0f && z >= 1.0f && x < FLOAT(width - 1) &&
                  y < FLOAT(height - 1) && z < FLOAT(depth - 1);
    return inside ? (INT(z) * height + INT(y)) * width + INT(x) : -1;
}

// The smoothed count of a cell: twice its own count plus the counts of its six neighbours. AT(c):
// the count of cell c.
#define GRAIN_SMOOTH(AT, c, row, slice)                                                            \
    (AT(c) + AT(c) + AT((c)-1) + AT((c) + 1) + AT((c) - (row)) + AT((c) + (row)) +                 \
     AT((c) - (slice)) + AT((c) + (slice)))
