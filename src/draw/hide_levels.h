// SPDX-License-Identifier: MIT
// How far away something may be and still be seen, by tiles of a picture and by larger ones.
#pragma once

enum { HIDE_LEVEL_COUNT = 6 };

// `nearest` [rows][columns]: a figure for each tile; it is used up. `levels`
// [HIDE_LEVEL_COUNT][rows][columns]: at level k, tile (x, y), which has 2^k x 2^k of the first, the
// least of all that lie in it and in the eight around it. Where a level has no such tile nothing is
// written. Both counts >= 1.
void hide_levels_make(float *nearest, int columns, int rows, float *levels);
