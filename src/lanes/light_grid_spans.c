// SPDX-License-Identifier: MIT
// Finds the cells that a sweep has to visit. In each row they reach from the first to the last cell
// that contains hair or is next to it, or that lies on the way from such a cell to another. In
// front of all hair the light is the environment's, and light behind all hair is not needed.
#include "lanes/light_grid_state.h"

#include "base/room.h"

#include <stdlib.h>
#include <string.h>

// The axes of a group of directions, and its rows of cells.
typedef struct Rows {
    int slices, tall, wide;
    ptrdiff_t stride[3]; // of slots: from slice to slice, row to row, column to column
    GridSpan *spans;
} Rows;

static Rows find_rows(const LightGridState *state, int group)
{
    const int *n = state->field.lattice.count;
    const ptrdiff_t stride[3] = {1, n[0], (ptrdiff_t)n[0] * n[1]};
    int main = group / 2, x = (main + 1) % 3, y = (main + 2) % 3;
    return (Rows){.slices = n[main],
                  .tall = n[y],
                  .wide = n[x],
                  .stride = {stride[main], stride[y], stride[x]},
                  .spans = grid_spans(state, group, 0)};
}

// The first and the last cell of a row that have slots.
static void find_own(const LightGridState *state, const Rows *rows, int slice, int y, int own[2])
{
    const int *slot = state->slot + slice * rows->stride[0] + y * rows->stride[1];
    own[0] = rows->wide, own[1] = 0;
    for (int x = 0; x < rows->wide; ++x) {
        if (slot[x * rows->stride[2]] < 0) continue;
        own[0] = x < own[0] ? x : own[0];
        own[1] = x + 1;
    }
}

// Extends `cells` by the spans of the rows around row y of a slice, widened by one cell on each
// side.
static void join_around(const Rows *rows, int slice, int y, bool needed, int cells[2])
{
    if (slice < 0 || slice >= rows->slices) return;
    const GridSpan *spans = rows->spans + (size_t)slice * (size_t)rows->tall;
    for (int at = y > 0 ? y - 1 : 0; at <= y + 1 && at < rows->tall; ++at) {
        const int *other = needed ? spans[at].needed : spans[at].swept;
        if (other[0] >= other[1]) continue;
        int wider[2] = {other[0] > 0 ? other[0] - 1 : 0,
                        other[1] < rows->wide ? other[1] + 1 : rows->wide};
        grid_span_join(cells, wider);
    }
}

static void find_group(const LightGridState *state, int group)
{
    Rows rows = find_rows(state, group);
    int step = group % 2 ? 1 : -1, first = step > 0 ? 0 : rows.slices - 1;
    for (int i = 0, slice = first; i < rows.slices; ++i, slice += step)
        for (int y = 0; y < rows.tall; ++y) {
            GridSpan *span = &rows.spans[slice * rows.tall + y];
            find_own(state, &rows, slice, y, span->swept);
            memcpy(span->needed, span->swept, sizeof span->needed);
            join_around(&rows, slice - step, y, false, span->swept);
        }
    for (int i = 0, slice = rows.slices - 1 - first; i < rows.slices; ++i, slice -= step)
        for (int y = 0; y < rows.tall; ++y) {
            GridSpan *span = &rows.spans[slice * rows.tall + y];
            join_around(&rows, slice + step, y, true, span->needed);
            for (int k = 0; k < 2; ++k) // do not sweep cells that are not needed
                span->swept[k] =
                    k ? span->swept[k] < span->needed[k] ? span->swept[k] : span->needed[k]
                    : span->swept[k] > span->needed[k] ? span->swept[k]
                                                       : span->needed[k];
        }
}

bool light_grid_find_spans(LightGridState *state)
{
    const int *n = state->field.lattice.count;
    size_t rows =
        (size_t)n[0] * (size_t)n[1] + (size_t)n[1] * (size_t)n[2] + (size_t)n[2] * (size_t)n[0];
    room_make(&state->spans, &state->span_room, ORDINATE_GROUPS * rows, sizeof *state->spans);
    for (int group = 0; group < ORDINATE_GROUPS && state->spans; ++group) find_group(state, group);
    return state->spans != NULL;
}
