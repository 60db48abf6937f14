// SPDX-License-Identifier: MIT
// The data that the parts of the light grid share (light_grid_*.c).
#pragma once

#include "base/simd.h"
#include "draw/light_field.h"
#include "lanes/light_grid.h"

#include "glsl/kernel/onto.h"

#include <stdatomic.h>

enum {
    GRID_LANES = ORDINATE_LANES,
    GROUP_WIDE = 3 * GRID_LANES, // floats of a cell and group: [channel][lane]
    GRID_CLASSES = LIGHT_GRID_KINDS * TANGENTS,
};

// Steps in which areas are added up.
#define ITEM_STEPS ((float)LIGHT_STEPS)

// The lanes of a group as one vector, at any address. (Compilers do not find this vector by
// themselves among three channels.)
typedef float GridLanes __attribute__((vector_size(4 * GRID_LANES), aligned(4), may_alias));

// The cells of a row that a sweep visits, from [0] to before [1]. A row runs along the first axis
// across the group's direction. `swept` are the cells whose light can differ from the
// environment's; `needed` are those whose light is asked for.
typedef struct GridSpan {
    int needed[2], swept[2];
} GridSpan;

// The part of a segment in one cell, sorted by cells: its class (tangent and kind), its area
// divided by h^2, and the parts of this area that each light reaches, in steps of 2^-16.
typedef struct GridItem {
    uint32_t class, area;
    uint32_t lit[]; // [lights]; then, where hair is painted, the albedo over its kind's by channel
} GridItem;

// The light that fibres in cells send to the eye, in patches of tangents (kernel/cell.h). The
// thread whose point first asks for a patch computes it.
typedef struct GridPatches {
    _Atomic int *of; // [kinds][active + 1][CELL_PATCHES]: number + 1 of the patch; 0: not computed
                     // yet
    float (*seen)[CELL_PATCH_NODES][4]; // [room]: red, green, blue and an unused number
    _Atomic int count;                  // may exceed room: further patches are computed each time
    int room;
    size_t of_room;
} GridPatches;

// The correction of a cell's light (kernel/cone.h). Numbers are multiplied by the area of the
// cell's hair, because they are added up over the cells around a point.
typedef struct GridCone {
    float lit[MAX_LIGHTS]; // area that each light reaches
    float around[3];       // cone_around
    float spread;          // rad, of tangents, times area
    float area;
    float unused[3];
} GridCone;

// The same as one vector.
typedef float GridConeLanes __attribute__((vector_size(64), aligned(4), may_alias));
_Static_assert(sizeof(GridCone) == sizeof(GridConeLanes), "a vector");

typedef struct LightGridState {
    int parts; // threads
    LightField field;
    int item_words;
    float mesh_color[3]; // linear RGB
    size_t cell_room, span_room, item_room, slot_room, filled_room;

    int *slot;            // [cells]: -1: not needed
    uint32_t *first_item; // [parts][cells], then for all parts together
    uint32_t *items;      // words of GridItem
    int *cell_of;         // [active]
    uint32_t item_count;
    int filled, active; // slots: those with hair come first

    float *depth;    // [filled][ORDINATES]: tau
    float *passage;  // [groups][filled][3][lanes]: exp(-tau), (1 - exp(-tau)) / tau, and tau
    float *source;   // [groups][filled][GROUP_WIDE]: S
    float *order;    // [groups][active][GROUP_WIDE]: L of the last order
    float *sum;      // [groups][active][GROUP_WIDE]: sum of L over all orders so far
    float *light;    // [active + 1][GRID_WIDE]: L of all orders and of the environment
    float *hidden;   // [active + 1][4]: mean light, and 1 if it suffices
    float *glow;     // [active][3]: light that the mesh reflects in a cell, linear RGB
    float *tint;     // [filled][3]: ratio of the albedo to the kind's
    int *class;      // [filled]: main tangent and kind
    GridCone *cone;  // [filled]
    float *planes;   // [groups][3][plane]: two slices, and rows
    size_t plane;    // floats
    GridSpan *spans; // [groups][slices][rows]: cells that a sweep visits, see light_grid_spans.c
    bool closing;    // the light of orders that are not swept is extrapolated
    double sums[2][ORDINATE_GROUPS][3]; // of the last two orders, see light_grid_sweep

    bool lights_skin;                    // sent, onto: the light that hair sends onto skin
    float *sent;                         // [groups][filled][GROUP_WIDE]: sum of S over all orders
    float (*onto)[ONTO_FACES][4];        // [cells]: see kernel/onto.h; [0][3]: sum of all values
    float (*onto_groups)[ONTO_FACES][3]; // [groups][cells]: parts of this sum
    size_t sent_room, onto_room;         // cells

    float eye[3]; // m, in the lattice's axes: the eye of GridPatches
    GridPatches *patches;
} LightGridState;

// The values of a group for a cell.
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

// The place of a slot's cell in the lattice.
static inline void grid_place(const LightGridState *state, int slot, int cell[3])
{
    const int *n = state->field.lattice.count, c = state->cell_of[slot];
    cell[0] = c % n[0];
    cell[1] = c / n[0] % n[1];
    cell[2] = c / (n[0] * n[1]);
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

// The cells of a row that an order visits; `around`: light comes from the environment in it.
static inline const int *grid_span_cells(const GridSpan *span, bool around)
{
    return around ? span->needed : span->swept;
}

// Widens `cells` so that it includes the cells of another row. A range is empty if its first cell
// lies behind its last.
static inline void grid_span_join(int cells[2], const int other[2])
{
    if (other[0] >= other[1]) return;
    bool empty = cells[0] >= cells[1];
    cells[0] = empty || other[0] < cells[0] ? other[0] : cells[0];
    cells[1] = empty || other[1] > cells[1] ? other[1] : cells[1];
}

// --- The parts, in their order.

// Finds lattice, items and the content of each cell. False if there is no hair.
bool light_grid_fill(LightGridState *state, const GridScene *scene, Error *error, Result *result);

// The steps of light_grid_fill. The place of the cells; false: there is no hair.
bool light_grid_find_lattice(LightGridState *state, const GridScene *scene);
// Counts the items of each thread and cell in `first_item`. With `emit`, after
// light_grid_make_slots, it writes the items to their places.
void light_grid_place(LightGridState *state, const GridScene *scene, bool emit);
void light_grid_make_slots(LightGridState *state);
// Computes from the items the content of the cells that sweeps need. False if memory is short.
bool light_grid_fill_cells(LightGridState *state, const GridScene *scene);

// The optical depth of the hair from `cell` along `way` (cells; its length is the reach), as it is
// in this ordinate's direction: from step `first` on along the way's longest axis (0: half of the
// cell itself) until it exceeds `most`.
float light_grid_behind(const LightGridState *state, const int cell[3], const float way[3],
                        int ordinate, int first, float most);

// Finds the cells that sweeps visit. False if memory is short.
bool light_grid_find_spans(LightGridState *state);

// Sweeps one order: `source`, and with `sky` also the environment's light. Adds it to `light`, or
// with `fresh` begins `light`. light_grid_scatter makes the source of the next order.
void light_grid_sweep(LightGridState *state, bool sky, bool fresh);
void light_grid_scatter(LightGridState *state);
// Adds the light of the last swept order that reaches hair to `all`. Returns whether another order
// must be swept, because light_grid_close would have to extrapolate too much of the light.
bool light_grid_needs_more(const LightGridState *state, float all[3]);
// Sums the light of all orders; with `further` also of the orders after the last one.
void light_grid_close(LightGridState *state, bool further);

// Makes room for `sent` and `onto`. False if memory is short.
bool light_grid_make_onto(LightGridState *state);
// The weights of a group's directions for the faces of a cell.
void light_grid_find_faces(int group, float face[ONTO_FACES][GRID_LANES]);
// Sweeps `source`, which must be the sum over all orders, through all cells, without other light,
// into onto_groups; light_grid_sum_onto sums these.
void light_grid_sweep_onto(LightGridState *state);
void light_grid_sum_onto(LightGridState *state);

// The patch of a cell (slot `active`: outside of all cells), which is computed if it is not there
// yet. If there is no room it is written to `scratch`.
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
