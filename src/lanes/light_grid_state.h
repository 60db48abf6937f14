// SPDX-License-Identifier: MIT
// What the parts of the light grid share: light_grid.c and light_grid_*.c.
#pragma once

#include "base/simd.h"
#include "draw/light_scene.h"

#include "glsl/draw/light.h"

enum {
    GRID_LANES = ORDINATE_LANES,
    GROUP_WIDE = 3 * GRID_LANES, // floats of a cell and group: [channel][lane]
    GRID_WIDE = 3 * ORDINATES,   // floats of a cell: [group][channel][lane]
    GRID_CLASSES = LIGHT_GRID_KINDS * TANGENTS,
    GATHER_SIDE = 32, // squares across the octahedron of tangents
    GATHER_NODES = (GATHER_SIDE + 1) * (GATHER_SIDE + 1),
    LIGHT_GRID_BOX = 7, // lowest place by axis, highest (m), square of the longest segment
};

// Steps in which areas are added up.
#define ITEM_STEPS ((float)LIGHT_STEPS)

// 4 pi / ORDINATES is the solid angle of a direction; a disc of it has this variance each way, by
// three quarters: what agreed best with path-traced light.
#define GRID_BLUR (0.75f / ORDINATES)

// The lanes of a group as one vector, wherever they lie. (Compilers do not find it by themselves
// among three channels.)
typedef float Lanes __attribute__((vector_size(4 * GRID_LANES), aligned(4), may_alias));

// Of a row of cells, along the first axis across a group's way, those that a sweep needs and those
// of them whose light can be another than what comes from around: from [0] to before [1].
typedef struct GridSpan {
    int needed[2], swept[2];
} GridSpan;

// The tables of one kind of fibre. They hold for `lobes`.
typedef struct GridKind {
    FibreLobes lobes;                          // a copy: arrays are not owned
    float (*scatter)[3][ORDINATES][ORDINATES]; // [TANGENTS][channel][in][out], owned
    bool has_scatter[TANGENTS];
    float (*first)[TANGENTS][GRID_WIDE]; // [lights], owned: of unit light
    float first_way[MAX_LIGHTS][3];      // that `first` is for
    bool has_first[MAX_LIGHTS];
    float (*gather)[GRID_WIDE]; // [GATHER_NODES], owned
    float gather_eye[3];
    bool has_gather;
    uint32_t first_made, scatter_made, gather_made; // another number whenever a table is
} GridKind;

// A part of a segment, in the order of cells: its class of tangent (and kind), its area over h^2,
// and of that what each light meets, all in steps of 2^-16.
typedef struct GridItem {
    uint32_t class, area;
    uint32_t lit[]; // [lights]; then, where hair is painted, the albedo over its kind's by channel
} GridItem;

typedef struct LightGridState {
    int parts; // threads
    LightLattice lattice;
    LightBlocks blocks_drawn;
    float longest; // m, segment
    int pieces;    // of a segment
    int lights;
    int item_words;
    float mesh_color[3]; // linear RGB
    bool tinted;         // hair has paint
    float to_light[MAX_LIGHTS]
                  [3]; // lattice's axes: unit, of lights afar and of lamps to the middle
    size_t cell_room, wall_room, span_room, item_room, slot_room, filled_room;

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
    float *light;    // [active][GRID_WIDE]: L of all
    float *hidden;   // [active][4]: mean light, and 1 where it will do
    float *glow;     // [filled][3]: what the mesh sends back of a cell's light, linear RGB
    float *tint;     // [filled][3]: albedo over that of the kind
    int *class;      // [filled]: main tangent and kind
    float *planes;   // [groups][3][plane]: two slices, and rows
    size_t plane;    // floats
    GridSpan *spans; // [groups][slices][rows]: what a sweep visits, see light_grid_spans.c
    float *walls;    // [axes][cells, and one more around]: LightBlocks.open, 1 beside the lattice
    bool walled;
    bool closing;                       // what further orders add is added
    double sums[2][ORDINATE_GROUPS][3]; // of the last two orders, see light_grid_sweep

    GridKind kinds[LIGHT_GRID_KINDS];
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

// What passes the mesh between the cell before on an axis and cell (0, 0, 0).
static inline const float *grid_walls(const LightGridState *state, int axis)
{
    const int *n = state->lattice.count;
    size_t y = (size_t)n[0] + 2, z = y * ((size_t)n[1] + 2);
    return state->walled ? state->walls + (size_t)axis * z * ((size_t)n[2] + 2) + z + y + 1 : NULL;
}

// The rows of a slice.
static inline GridSpan *grid_spans(const LightGridState *state, int group, int slice)
{
    const int *n = state->lattice.count;
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

// Its steps. Where the cells lie (false: there is no hair): the lattice's axes, the box of hair by
// them, and from that, with `cells` along its longest side, the lattice. Its side changes in
// eighths of octaves and its corner by whole cells, so that light does not swim with every frame.
bool light_grid_find_lattice(LightGridState *state, const GridScene *scene);
void light_grid_find_turn(LightGridState *state, const GridScene *scene);
bool light_grid_set_box(LightGridState *state, int cells, const float box[LIGHT_GRID_BOX]);
// The lights.
void light_grid_find_lights(LightGridState *state, const GridScene *scene);
// Counts the items of each part and cell, in `first_item`; with `emit`, which needs what
// light_grid_make_slots makes of that, puts them where they belong.
void light_grid_place(LightGridState *state, const GridScene *scene, bool emit);
void light_grid_make_slots(LightGridState *state);
// Of the items what a sweep needs. False if memory is short.
bool light_grid_fill_cells(LightGridState *state, const GridScene *scene);

// The way to light i at x (world), and its light there, as light_sent of lights.glsl.
void light_grid_light(const DrawParams *draw, int i, const float x[3], float way[3],
                      float color[3]);

// What sweeps need of the mesh (false: memory is short), and which cells they visit.
bool light_grid_find_walls(LightGridState *state, const GridScene *scene);
bool light_grid_find_spans(LightGridState *state);

// One order: sweeps `source` and, with `sky`, what comes from around; adds it to `light` (or
// begins it: `fresh`). light_grid_scatter makes the next order's source.
void light_grid_sweep(LightGridState *state, const GridScene *scene, bool sky, bool fresh,
                      bool sourceless);
void light_grid_scatter(LightGridState *state);
// Adds what hair meets of the last order to `all`; whether more than a twentieth of the light would
// be left to light_grid_close.
bool light_grid_needs_more(const LightGridState *state, double all[3]);
// The light of all orders; with `further`, of those after the last, too.
void light_grid_close(LightGridState *state, bool further);

// What hair shows, see light_grid_gather.
Result light_grid_show(LightGridState *state, const GridScene *scene, Error *error);

// Of an image: the nearest ordinate to a way of the world, and the least opacity of hair to the eye
// over that to light.
int light_grid_nearest(const LightLattice *lattice, const float way[3]);
float light_grid_opacity(const GridScene *scene);

// The kinds are those of the scene: tables of others are forgotten.
void light_grid_set_kinds(LightGridState *state, const GridScene *scene);

// Tables of kinds, made if they are not there; scatter those of the classes that cells have, or
// all.
Result light_grid_make_first(LightGridState *state, const GridScene *scene, Error *error);
Result light_grid_make_scatter(LightGridState *state, const GridScene *scene, bool all,
                               Error *error);
void light_grid_forget(LightGridState *state); // all tables
Result light_grid_make_gather(LightGridState *state, const GridScene *scene, Error *error);

static inline void grid_group_ways(int group, Ways *ways)
{
    for (int k = 0; k < 3; ++k)
        for (int l = 0; l < GRID_LANES; ++l) ways->axis[k][l] = ORDINATE[k][group * GRID_LANES + l];
}

static inline void grid_same_ways(const float way[3], float factor, Ways *ways)
{
    for (int k = 0; k < 3; ++k)
        for (int l = 0; l < GRID_LANES; ++l) ways->axis[k][l] = factor * way[k];
}
