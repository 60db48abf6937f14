// SPDX-License-Identifier: MIT
// Input that both implementations of the light among hair share (light_grid.h in C, light_passes.h
// in shaders): the place of the cells, the lights and the mesh among them, and the tables of
// fibres.
#pragma once

#include "draw/light_cone.h"
#include "draw/light_scene.h"

#include "glsl/draw/light.h"
#include "glsl/kernel/cell.h"

enum { GRID_WIDE = LIGHT_WIDE }; // floats per cell: [group][channel][lane]

// The variance by which lobes are widened, because a direction stands for a solid angle of 4 pi /
// ORDINATES. A disc of this angle has the variance 1 / ORDINATES along each axis; the factor 3/4
// agreed best with path-traced light.
#define GRID_BLUR (0.75f / ORDINATES)

typedef enum FieldTable {
    FIELD_FIRST,
    FIELD_SCATTER,
    FIELD_GATHER,
    FIELD_CONE,
    FIELD_TABLES
} FieldTable;

// The tables of one kind of fibre, valid for `lobes`.
typedef struct GridKind {
    FibreLobes lobes;                          // a copy: arrays are not owned
    float (*scatter)[3][ORDINATES][ORDINATES]; // [TANGENTS][channel][in][out], owned
    bool has_scatter[TANGENTS];
    float (*first)[TANGENTS][GRID_WIDE]; // [lights], owned: for light of strength 1
    float first_way[MAX_LIGHTS][4];      // the directions for which `first` was computed
    bool has_first[MAX_LIGHTS];
    float (*gather)[GRID_WIDE][CELL_PATCH_NODES]; // [CELL_PATCHES], owned
    float gather_eye[3];
    bool has_gather;
    float (*cone)[CELL_NODES][CONE_ROWS][4]; // [lights], owned: see kernel/cone.h
    ConeView cone_views[MAX_LIGHTS];         // for which `cone` was computed
    bool has_cone[MAX_LIGHTS];
    uint32_t made[FIELD_TABLES]; // changes whenever a table is made
} GridKind;

// A zeroed struct is empty.
typedef struct LightField {
    LightLattice lattice;
    float longest; // m, of all segments
    int pieces;    // number that a segment is divided into
    int lights;
    bool tinted;                   // hair has paint
    float to_light[MAX_LIGHTS][4]; // in the lattice's axes: unit vector to a light far away, or
                                   // from the middle to a lamp; w: its variance, see draw.h
    float around[GRID_WIDE];       // ambient radiance by ordinate
    float *walls; // [axes][cells plus one around]: LightBlocks.open, 1 outside the lattice
    size_t wall_room;
    bool walled;
    GridKind kinds[LIGHT_GRID_KINDS];
} LightField;

void light_field_destroy(LightField *field);

// Place the cells. light_field_find_turn finds the lattice's axes. light_field_set_box finds the
// cells from the hair's box in these axes (lowest place along each axis, highest (m), square of the
// longest segment), with `cells` along its longest side; it returns false if the box is empty. The
// side of a cell changes in steps of a factor of 2^(1/8) and the corner by whole cells, so that
// light does not swim from frame to frame.
void light_field_find_turn(LightField *field, const GridScene *scene);
bool light_field_set_box(LightField *field, int cells, const float box[LIGHT_BOX_WORDS]);

// Fills in the lights, the light from all around, and whether hair has paint.
void light_field_find_lights(LightField *field, const GridScene *scene);

// The direction to light i at x (world), and the share of the light's colour there; as light_share
// of lights.glsl.
float light_field_light(const DrawParams *draw, int i, const float x[3], float way[3]);

// Fills in `walls`: how much light the mesh lets through between neighbouring cells. First finds
// the scene's blocks for the lattice. RESULT_FAILED if memory is short.
Result light_field_find_walls(LightField *field, const GridScene *scene, Error *error);

// The part of `walls` of an axis, from cell (0, 0, 0) on: light that passes from the cell before on
// this axis. NULL: no mesh.
static inline const float *light_field_walls(const LightField *field, int axis)
{
    const int *n = field->lattice.count;
    size_t y = (size_t)n[0] + 2, z = y * ((size_t)n[1] + 2);
    return field->walled ? field->walls + (size_t)axis * z * ((size_t)n[2] + 2) + z + y + 1 : NULL;
}

// Whether the mesh lets light into this cell along a direction of the group (ordinates.h).
static inline bool light_field_lets_in(const LightField *field, const int cell[3], int group)
{
    const int *n = field->lattice.count;
    const size_t step[3] = {1, (size_t)n[0] + 2, ((size_t)n[0] + 2) * ((size_t)n[1] + 2)};
    size_t at = (size_t)cell[0] + step[1] * (size_t)cell[1] + step[2] * (size_t)cell[2];
    int axis = group / 2;
    return light_field_walls(field, axis)[at + (group % 2 ? 0 : step[axis])] > 0;
}

// Whether the cell is next to the mesh: does not let light in along all directions.
static inline bool light_field_is_beside_mesh(const LightField *field, const int cell[3])
{
    bool all = true;
    for (int group = 0; group < ORDINATE_GROUPS && field->walled; ++group)
        all = all && light_field_lets_in(field, cell, group);
    return !all;
}

// The mean unit normal of the mesh in a cell next to it, by the walls around the cell (in the
// lattice's axes); 0 where walls face each other, as in a thin gap.
void light_field_normal(const LightField *field, const int cell[3], float normal[3]);

// The group size: one strand of each group of this many is used and represents them all.
static inline uint light_field_step(const GridScene *scene)
{
    return scene->step > 1 ? scene->step : 1;
}

// The area that a strand of the sample adds to a cell that it crosses along an axis, over the
// square of the cell's side: the largest of all hair, without the file's thickness.
float light_field_strand(const LightField *field, const GridScene *scene);

// The ordinate that is nearest to a direction of the world, and the least ratio of the hair's
// opacity to the eye and to light.
int light_field_nearest(const LightLattice *lattice, const float way[3]);
float light_field_opacity(const GridScene *scene);

// --- Tables (light_tables.c). Each function makes the tables that are missing. RESULT_FAILED if
// memory is short.

// Sets the kinds of fibres to those of the scene, and drops the tables of others.
void light_field_set_kinds(LightField *field, const GridScene *scene);
Result light_field_make_first(LightField *field, const GridScene *scene, Error *error);
// `classes`: the `count` classes (tangent and kind) that are needed; NULL: all.
Result light_field_make_scatter(LightField *field, const GridScene *scene, const int *classes,
                                int count, Error *error);
Result light_field_make_gather(LightField *field, const GridScene *scene, Error *error);
Result light_field_make_cone(LightField *field, const GridScene *scene, Error *error);

// The values of one table of a kind.
const float *light_field_table(const GridKind *kind, FieldTable table);
