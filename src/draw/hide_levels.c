// SPDX-License-Identifier: MIT
#include "draw/hide_levels.h"

#include <stddef.h>

typedef struct Tiles {
    float *tile; // [rows][stride]
    int columns, rows, stride;
} Tiles;

static float least(float a, float b)
{
    return b < a ? b : a;
}

static int at_most(int a, int b)
{
    return a < b ? a : b;
}

// The least of the tiles in columns x .. end_x - 1 and rows y .. end_y - 1.
static float least_of(const Tiles *tiles, int x, int y, int end_x, int end_y)
{
    const float *row = tiles->tile + (ptrdiff_t)y * tiles->stride;
    float found = row[x];
    for (; y < end_y; ++y, row += tiles->stride)
        for (int i = x; i < end_x; ++i) found = least(found, row[i]);
    return found;
}

static void spread(const Tiles *tiles, float *level)
{
    for (int y = 0; y < tiles->rows; ++y)
        for (int x = 0; x < tiles->columns; ++x)
            level[(ptrdiff_t)y * tiles->stride + x] =
                least_of(tiles, x ? x - 1 : 0, y ? y - 1 : 0, at_most(x + 2, tiles->columns),
                         at_most(y + 2, tiles->rows));
}

// In place: a tile is written when all that lie there have been read.
static void halve(Tiles *tiles)
{
    int columns = (tiles->columns + 1) / 2, rows = (tiles->rows + 1) / 2;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x)
            tiles->tile[(ptrdiff_t)y * tiles->stride + x] =
                least_of(tiles, 2 * x, 2 * y, at_most(2 * x + 2, tiles->columns),
                         at_most(2 * y + 2, tiles->rows));
    tiles->columns = columns;
    tiles->rows = rows;
}

void hide_levels_make(float *nearest, int columns, int rows, float *levels)
{
    Tiles tiles = {nearest, columns, rows, columns};
    for (int k = 0; k < HIDE_LEVEL_COUNT; ++k, levels += (ptrdiff_t)rows * columns) {
        spread(&tiles, levels);
        halve(&tiles);
    }
}
