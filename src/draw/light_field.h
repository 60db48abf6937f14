// SPDX-License-Identifier: MIT
// What whoever finds the light among hair (light_grid.h, light_passes.h) starts from: where the
// cells lie, the lights and the mesh among them, and the tables of fibres.
#pragma once

#include "draw/light_scene.h"

#include "glsl/draw/light.h"
#include "glsl/kernel/cell.h"

enum { GRID_WIDE = LIGHT_WIDE }; // floats of a cell: [group][channel][lane]

// 4 pi / ORDINATES is the solid angle of a direction; a disc of it has this variance each way, by
// three quarters: what agreed best with path-traced light.
#define GRID_BLUR (0.75f / ORDINATES)

typedef enum FieldTable { FIELD_FIRST, FIELD_SCATTER, FIELD_GATHER, FIELD_TABLES } FieldTable;

// The tables of one kind of fibre. They hold for `lobes`.
typedef struct GridKind {
    FibreLobes lobes;                          // a copy: arrays are not owned
    float (*scatter)[3][ORDINATES][ORDINATES]; // [TANGENTS][channel][in][out], owned
    bool has_scatter[TANGENTS];
    float (*first)[TANGENTS][GRID_WIDE]; // [lights], owned: of unit light
    float first_way[MAX_LIGHTS][3];      // that `first` is for
    bool has_first[MAX_LIGHTS];
    float (*gather)[GRID_WIDE][CELL_PATCH_NODES]; // [CELL_PATCHES], owned
    float gather_eye[3];
    bool has_gather;
    uint32_t made[FIELD_TABLES]; // another number whenever a table is
} GridKind;

// A zeroed struct is empty.
typedef struct LightField {
    LightLattice lattice;
    float longest; // m, segment
    int pieces;    // of a segment
    int lights;
    bool tinted; // hair has paint
    float to_light[MAX_LIGHTS]
                  [3]; // lattice's axes: unit, of lights afar and of lamps to the middle
    float *walls;      // [axes][cells, and one more around]: LightBlocks.open, 1 beside the lattice
    size_t wall_room;
    bool walled;
    GridKind kinds[LIGHT_GRID_KINDS];
} LightField;

void light_field_destroy(LightField *field);

// Where the cells lie: the lattice's axes, and, from the box of hair by them (lowest place by axis,
// highest (m), square of the longest segment), the cells, `cells` along its longest side; false if
// it is empty. Their side changes in eighths of octaves and their corner by whole cells, so that
// light does not swim with every frame.
void light_field_find_turn(LightField *field, const GridScene *scene);
bool light_field_set_box(LightField *field, int cells, const float box[LIGHT_BOX_WORDS]);

// The lights, and whether hair has paint.
void light_field_find_lights(LightField *field, const GridScene *scene);

// The way to light i at x (world), and the share of its colour there, as light_share of
// lights.glsl.
float light_field_light(const DrawParams *draw, int i, const float x[3], float way[3]);

// What the mesh lets through between the cells; the scene's blocks are found for the lattice first.
// RESULT_FAILED if memory is short.
Result light_field_find_walls(LightField *field, const GridScene *scene, Error *error);

// What passes the mesh between the cell before on an axis and cell (0, 0, 0); NULL: there is none.
static inline const float *light_field_walls(const LightField *field, int axis)
{
    const int *n = field->lattice.count;
    size_t y = (size_t)n[0] + 2, z = y * ((size_t)n[1] + 2);
    return field->walled ? field->walls + (size_t)axis * z * ((size_t)n[2] + 2) + z + y + 1 : NULL;
}

// Of so many strands one stands for all.
static inline uint light_field_step(const GridScene *scene)
{
    return scene->step > 1 ? scene->step : 1;
}

// Of an image: the nearest ordinate to a way of the world, and the least opacity of hair to the eye
// over that to light.
int light_field_nearest(const LightLattice *lattice, const float way[3]);
float light_field_opacity(const GridScene *scene);

// --- Tables (light_tables.c): those that are not there are made. RESULT_FAILED if memory is short.

// The kinds are those of the scene: tables of others are forgotten.
void light_field_set_kinds(LightField *field, const GridScene *scene);
Result light_field_make_first(LightField *field, const GridScene *scene, Error *error);
// Those of `count` classes (of tangents, by kinds), or, NULL, all.
Result light_field_make_scatter(LightField *field, const GridScene *scene, const int *classes,
                                int count, Error *error);
Result light_field_make_gather(LightField *field, const GridScene *scene, Error *error);

// The floats of a table of a kind.
const float *light_field_table(const GridKind *kind, FieldTable table);
