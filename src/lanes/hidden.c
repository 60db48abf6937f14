// SPDX-License-Identifier: MIT
#include "lanes/hidden.h"

#include "glsl/kernel/edge.h"

#include <stdlib.h>

static float least(float a, float b)
{
    return a < b ? a : b;
}

// The least inverse depth of the base in the square at x, y, which is its farthest point; 0 if the
// square is not entirely within the base.
static float farthest(const BlockBase *base, const float depth[2], int x, int y)
{
    float far = 0;
    x -= base->x, y -= base->y;
    if (x < 0 || y < 0 || x + HIDDEN_SQUARE > base->width || y + HIDDEN_SQUARE > base->height)
        return 0;
    for (int j = 0; j < HIDDEN_SQUARE; ++j)
        for (int i = 0; i < HIDDEN_SQUARE; ++i) {
            float z = base->depth[(size_t)(y + j) * (size_t)base->width + (size_t)(x + i)];
            far = z > far ? z : far;
        }
    return edge_inverse_w(far, depth[0], depth[1]);
}

static Result make_room(Hidden *hidden, size_t count, Error *error)
{
    if (hidden->room >= count) return RESULT_OK;
    hidden_destroy(hidden);
    hidden->nearest = malloc(count * sizeof *hidden->nearest);
    hidden->own = malloc(count * sizeof *hidden->own);
    if (!hidden->nearest || !hidden->own) {
        hidden_destroy(hidden);
        return error_set(error, RESULT_FAILED, "no memory to find what hides hair");
    }
    hidden->room = count;
    return RESULT_OK;
}

Result hidden_find(Hidden *hidden, const BlockBase *base, const float depth[2], int width,
                   int height, Error *error)
{
    int columns = (width + HIDDEN_SQUARE - 1) / HIDDEN_SQUARE,
        rows = (height + HIDDEN_SQUARE - 1) / HIDDEN_SQUARE;
    TRY(make_room(hidden, (size_t)columns * (size_t)rows, error));
    hidden->columns = columns;
    hidden->rows = rows;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x)
            hidden->own[y * columns + x] =
                farthest(base, depth, x * HIDDEN_SQUARE, y * HIDDEN_SQUARE);
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
            float nearest = hidden->own[y * columns + x];
            for (int j = y - 1; j <= y + 1; ++j)
                for (int i = x - 1; i <= x + 1; ++i)
                    if (i >= 0 && j >= 0 && i < columns && j < rows)
                        nearest = least(nearest, hidden->own[j * columns + i]);
            hidden->nearest[y * columns + x] = nearest;
        }
    return RESULT_OK;
}

void hidden_destroy(Hidden *hidden)
{
    free(hidden->nearest);
    free(hidden->own);
    *hidden = (Hidden){0};
}
