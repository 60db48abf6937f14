// SPDX-License-Identifier: MIT
// What the parts of the light grid share: light_grid_*.c.
#pragma once

#include "base/simd.h"
#include "draw/light_field.h"
#include "lanes/light_grid.h"

#include <stdatomic.h>

enum {
    GRID_LANES = ORDINATE_LANES,
    GROUP_WIDE = 3 * GRID_LANES, // floats of a cell and group: [channel][lane]
    GRID_CLASSES = LIGHT_GRID_KINDS * TANGENTS,
};

// Steps in which areas are added up.
#define ITEM_STEPS ((float)LIGHT_STEPS)

// The lanes of a group as one vector, wherever they lie. (Compilers do not find it by themselves
// among three channels.)
typedef float GridLanes __attribute__((vector_size(4 * GRID_LANES), aligned(4), may_alias));

// Of a row of cells, along the first axis across a group's way, those that a sweep needs and those
// of them whose light can be another than what comes from around: from [0] to before [1].
typedef struct GridSpan {
    int needed[2], swept[2];
} GridSpan;

// A part of a segment, in the order of cells: its class of tangent (and kind), its area over h^2,
// and of that what each light meets, all in steps of 2^-16.
typedef struct GridItem {
    uint32_t class, area;
    uint32_t lit[]; // [lights]; then, where hair is painted, the albedo over its kind's by channel
} GridItem;

// What cells show of fibres, by patches of tangents (kernel/cell.h): found when a point first asks,
// by whichever thread.
typedef struct GridPatches {
    _Atomic int *of; // [kinds][active + 1][CELL_PATCHES]: number + 1 of the patch; 0: not found
    float (*seen)[CELL_PATCH_NODES][4]; // [room]: red, green, blue and nothing
    _Atomic int count;                  // more than room: the others are found each time
    int room;
    size_t of_room;
} GridPatches;

typedef struct LightGridState {
    int parts; // threads
    LightField field;
    int item_words;
    float mesh_color[3]; // linear RGB
    size_t cell_room, span_room, item_room, slot_room, filled_room;

    int *slot;            // [cells]: -1: nobody asks
    uint32_t *first_item; // [parts][cells], then of the whole
    uint32_t *items;      // words of GridItem
    int *cell_of;         // [active]
    uint32_t item_count;
    int filled, active; // slots: those with hair come first

    float *depth;    // [filled][ORDINATES]: tau
    float *passage;  // [groups][filled][3][lanes]: exp(-tau), (1 - exp(-tau)) / tau, and tau
    float *source;   // [groups][filled][GROUP_WIDE]: S
    float *order;    // [groups][active][GROUP_WIDE]: L of the last order
    float *sum;      // [groups][active][GROUP_WIDE]: L of all orders so far
    float *light;    // [active + 1][GRID_WIDE]: L of all, and what comes from around
    float *hidden;   // [active + 1][4]: mean light, and 1 where it will do
    float *glow;     // [filled][3]: what the mesh sends back of a cell's light, linear RGB
    float *tint;     // [filled][3]: albedo over that of the kind
    int *class;      // [filled]: main tangent and kind
    float *planes;   // [groups][3][plane]: two slices, and rows
    size_t plane;    // floats
    GridSpan *spans; // [groups][slices][rows]: what a sweep visits, see light_grid_spans.c
    bool closing;    // what further orders add is added
    double sums[2][ORDINATE_GROUPS][3]; // of the last two orders, see light_grid_sweep

    float eye[3]; // m, lattice's axes: that GridPatches are for
    GridPatches *patches;
} LightGridState;

// Where a group's lanes of a cell lie.
static inline float *grid_lane(const LightGridState *state, float *of, int group, int slot)
{
    return of + ((size_t)group * (size_t)state->active + (size_t)slot) * GROUP_WIDE;
}
static inline float *grid_source(const LightGridState *state, int group, int slot)
{
    return state->source + ((size_t)group * (size_t)state->filled + (size_t)slot) * GROUP_WIDE;
}
static inline float *grid_passage(const LightGridState *state, int group, int slot)
{
    return state->passage + ((size_t)group * (size_t)state->filled + (size_t)slot) * GROUP_WIDE;
}

// The rows of a slice.
static inline GridSpan *grid_spans(const LightGridState *state, int group, int slice)
{
    const int *n = state->field.lattice.count;
    int main = group / 2, tall = n[(main + 2) % 3];
    size_t most = (size_t)n[0] * (size_t)n[1] + (size_t)n[1] * (size_t)n[2] +
                  (size_t)n[2] * (size_t)n[0]; // at least the rows of any group
    return state->spans + (size_t)group * most + (size_t)slice * (size_t)tall;
}

// Of a row those that are worked out, in an order that light comes from around in, or not.
static inline const int *grid_span_cells(const GridSpan *span, bool around)
{
    return around ? span->needed : span->swept;
}

// Widens `cells` (empty: the first lies behind the last) to those of another row.
static inline void grid_span_join(int cells[2], const int other[2])
{
    if (other[0] >= other[1]) return;
    bool empty = cells[0] >= cells[1];
    cells[0] = empty || other[0] < cells[0] ? other[0] : cells[0];
    cells[1] = empty || other[1] > cells[1] ? other[1] : cells[1];
}

// --- The parts, in their order.

// Lattice, items, what is in each cell. False if there is no hair.
bool light_grid_fill(LightGridState *state, const GridScene *scene, Error *error, Result *result);

// Its steps. Where the cells lie; false: there is no hair.
bool light_grid_find_lattice(LightGridState *state, const GridScene *scene);
// Counts the items of each part and cell, in `first_item`; with `emit`, which needs what
// light_grid_make_slots makes of that, puts them where they belong.
void light_grid_place(LightGridState *state, const GridScene *scene, bool emit);
void light_grid_make_slots(LightGridState *state);
// Of the items what a sweep needs. False if memory is short.
bool light_grid_fill_cells(LightGridState *state, const GridScene *scene);

// Which cells sweeps visit. False if memory is short.
bool light_grid_find_spans(LightGridState *state);

// One order: sweeps `source` and, with `sky`, what comes from around; adds it to `light` (or
// begins it: `fresh`). light_grid_scatter makes the next order's source.
void light_grid_sweep(LightGridState *state, const GridScene *scene, bool sky, bool fresh);
void light_grid_scatter(LightGridState *state);
// The light of what has no cell near it: that from around.
void light_grid_find_around(LightGridState *state, const GridScene *scene);
// Adds what hair meets of the last order to `all`; whether too much of the light would be left to
// light_grid_close.
bool light_grid_needs_more(const LightGridState *state, float all[3]);
// The light of all orders; with `further`, of those after the last, too.
void light_grid_close(LightGridState *state, bool further);

// What a cell (slot `active`: none) shows of the tangents of a patch, found if it is not yet; in
// `scratch` if there is no room.
const float (*light_grid_find_patch(const LightGridState *state, int kind, int slot, int patch,
                                    float scratch[CELL_PATCH_NODES][4]))[4];

static inline _Atomic int *grid_patch(const LightGridState *state, int kind, int slot, int patch)
{
    return state->patches->of +
           ((size_t)kind * ((size_t)state->active + 1) + (size_t)slot) * CELL_PATCHES + patch;
}

static inline const float (*light_grid_patch(const LightGridState *state, int kind, int slot,
                                             int patch, float scratch[CELL_PATCH_NODES][4]))[4]
{
    int number = atomic_load_explicit(grid_patch(state, kind, slot, patch), memory_order_acquire);
    return number ? (const float(*)[4])state->patches->seen[number - 1]
                  : light_grid_find_patch(state, kind, slot, patch, scratch);
}
