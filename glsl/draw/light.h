// SPDX-License-Identifier: MIT
// The light among hair (light_grid.h) in shaders (light_passes.h): the sizes of the grid, and the
// bindings that its passes read and write.
#include "common/shared_math.h"
#include "draw/draw.h"
#ifdef __STDC__
#pragma once
#endif

#define BIND_LIGHT 5 // uniform block

// Shader storage: no pass has two of the same number.
#define BIND_LIGHT_BOX_OUT    0 // LIGHT_BOX_WORDS int, see light_box.comp
#define BIND_LIGHT_SLOTS_OUT  0 // int a cell, see light_slots.comp
#define BIND_LIGHT_CELLS_OUT  1 // LightCell a slot
#define BIND_LIGHT_STATE_OUT  2 // LightState, then vec4 a sweep and ordinate: light that hair meets
#define BIND_LIGHT_SUMS_OUT   3 // uint, see light_items.comp
#define BIND_LIGHT_PLANES_OUT 3 // vec4, see light_sweep.comp
#define BIND_LIGHT_ALL_OUT    3 // vec4 a slot and ordinate: the light of all orders
#define BIND_LIGHT_SEEN_OUT   3 // three float a point of the hair
#define BIND_LIGHT_FACES_OUT  3 // six vec4 a cell, see kernel/onto.h
#define BIND_LIGHT_DEPTH_OUT  4 // float a slot and ordinate: optical depth over a side
#define BIND_LIGHT_SOURCE_OUT 5 // three float an ordinate and slot: light that hair sends
#define BIND_LIGHT_ORDER_OUT  6 // likewise: light of the last order
#define BIND_LIGHT_ONTO_OUT   6 // four halves an ordinate and cell: light of hair alone
#define BIND_LIGHT_TOTAL_OUT  7 // as ORDER: light of all orders so far
#define BIND_LIGHT_SENT_OUT   7 // as SOURCE, summed over all orders but the last, for skin

// Textures of float, beside those of hair (shared.h), its paint and its shadows.
#define BIND_LIGHT_TABLES  1 // see LIGHT_TANGENT_AT
#define BIND_LIGHT_WALLS   2 // 0 or 1 an axis and cell, with a border: 1 if the mesh lets light pass
#define BIND_LIGHT_FIRST   3 // [kind][light][class][LIGHT_WIDE], see light_fill.comp
#define BIND_LIGHT_SCATTER 4 // [kind][class][channel][in][out], see light_scatter.comp
#define BIND_LIGHT_GATHER  5 // [kind][CELL_PATCHES][LIGHT_WIDE][CELL_PATCH_NODES]
#define BIND_LIGHT_ALL     6 // vec4 a slot and ordinate
#define BIND_LIGHT_CONE    7 // vec4: [kind][light][CELL_NODES][CONE_ROWS], see kernel/cone.h

#define LIGHT_ORDINATES 48                    // directions of light
#define LIGHT_LANES     8                     // ordinates side by side in a table's row
#define LIGHT_WIDE      (3 * LIGHT_ORDINATES) // [group][channel][lane]
#define LIGHT_CLASSES   256                   // classes of tangents
#define LIGHT_SQUARES   48                    // squares across a cube's face, to look up classes
#define LIGHT_KINDS     4                     // kinds of fibres
#define LIGHT_MOST      33                    // sweeps

#define LIGHT_STEPS 65536.0 // steps of the integer sums of areas

SHARED_STRUCT(LightCell)
{
    vec4 glow;             // rgb: light that the mesh reflects
    vec4 tint;             // rgb: albedo over the kind's albedo; w: area of the cell's hair
    vec4 around;           // rgb: cone_around; w: spread of tangents, rad (kernel/cone.h)
    float lit[MAX_LIGHTS]; // area that each light reaches
    vec4 mean;             // rgb: mean light; w = 1: the cell is hidden, the mean is enough
    uint tints[4];         // three are used: low words of the sums of painted areas
    uint carry[4];         // their high words
    ivec4 places;          // x: index of the cell; y: main tangent and kind
};

SHARED_STRUCT(LightState)
{
    uint filled, beside; // cells with hair, cells next to them
    uint done;           // 1: no further order is needed
    vec4 more;           // rgb: light of all later orders over that of the last
};

// The tables, as floats: [class][ordinate] sine of the angle between them; [class][3] tangent;
// [face][row][column] class.
#define LIGHT_TANGENT_AT   (LIGHT_CLASSES * LIGHT_ORDINATES)
#define LIGHT_NEAREST_AT   (LIGHT_TANGENT_AT + 3 * LIGHT_CLASSES)
#define LIGHT_TABLES_COUNT (LIGHT_NEAREST_AT + 6 * LIGHT_SQUARES * LIGHT_SQUARES)

// Words of BOX_OUT: lowest place (m, in the lattice's axes), highest place, square of the longest
// segment; float bits as integers, see shadow_bounds.comp.
#define LIGHT_BOX_WORDS 7

UNIFORM_BLOCK(LightParams, light_params, BIND_LIGHT)
{
    vec4 turn[3];         // xyz: unit axes of the lattice in the world; turn[0].w:
                          // light_field_strand
    vec4 low;             // xyz, m: the first cell's corner in these axes; w, m: side of a cell
    uvec4 count;          // xyz: cells along each axis; w: all cells
    vec4 way[MAX_LIGHTS]; // xyz: unit, to the light, or a lamp's place, m; w: map, -1: none
    vec4 ordinate[LIGHT_ORDINATES]; // xyz: unit direction in which light travels
    vec4 around[LIGHT_ORDINATES];   // rgb: ambient light that arrives in each
    vec4 eye;                 // xyz: m, in these axes; w: opacity to the eye over opacity to light
    vec4 eye_axis;            // xyz: unit direction of LIGHT_GATHER's table; w: nearest ordinate
    vec4 albedo[LIGHT_KINDS]; // rgb: for light perpendicular to the fibre
    uint pieces;              // parts of a segment
    uint step;                // one of this many strands represents all in the cells
    uint lights;              // lights that are used
    uint classes;             // classes of tangents of all kinds
    uint room;                // slots
    uint plane;               // cells of a plane, see light_sweep.comp
    uint walled; // 1: there is a mesh among the cells; 2: skin, which takes hair's light
    uint tinted; // 1: some hair is painted
}
END_BLOCK(LightParams, light_params);
