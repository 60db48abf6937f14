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
#define BIND_LIGHT_STATE_OUT  2 // LightState, then vec4 a sweep and ordinate: what hair meets
#define BIND_LIGHT_SUMS_OUT   3 // uint, see light_items.comp
#define BIND_LIGHT_PLANES_OUT 3 // vec4, see light_sweep.comp
#define BIND_LIGHT_ALL_OUT    3 // vec4 a slot and ordinate: the light of all orders
#define BIND_LIGHT_SEEN_OUT   3 // three float a point of the hair
#define BIND_LIGHT_DEPTH_OUT  4 // float a slot and ordinate: optical depth of a side
#define BIND_LIGHT_SOURCE_OUT 5 // three float an ordinate and slot: what hair sends
#define BIND_LIGHT_ORDER_OUT  6 // the same: light of the last order
#define BIND_LIGHT_TOTAL_OUT  7 // the same: of all orders so far

// Textures of float, beside those of hair (shared.h), its paint and its shadows.
#define BIND_LIGHT_TABLES  1 // see LIGHT_TANGENT_AT
#define BIND_LIGHT_WALLS   2 // 1 or 0 an axis and cell, with a cell around: what passes the mesh
#define BIND_LIGHT_FIRST   3 // [kind][light][class][LIGHT_WIDE], see light_fill.comp
#define BIND_LIGHT_SCATTER 4 // [kind][class][channel][in][out], see light_scatter.comp
#define BIND_LIGHT_GATHER  5 // [kind][CELL_PATCHES][LIGHT_WIDE][CELL_PATCH_NODES]
#define BIND_LIGHT_ALL     6 // vec4 a slot and ordinate

#define LIGHT_ORDINATES 48                    // directions that light is followed in
#define LIGHT_LANES     8                     // of them, beside each other in a table's row
#define LIGHT_WIDE      (3 * LIGHT_ORDINATES) // [group][channel][lane]
#define LIGHT_CLASSES   256                   // of tangents
#define LIGHT_SQUARES   48                    // of tangents, across a face of a cube
#define LIGHT_KINDS     4                     // of fibres
#define LIGHT_MOST      33                    // sweeps

#define LIGHT_STEPS 65536.0 // in which areas are added up

SHARED_STRUCT(LightCell)
{
    vec4 glow;     // rgb: what the mesh sends back of its light
    vec4 tint;     // rgb: albedo over that of the kind
    vec4 mean;     // rgb: mean light; w = 1: so little of the cell is seen that it will do
    uint tints[4]; // of them three: sums of painted areas, their low words
    uint carry[4]; // their high words
    ivec4 places;  // x: which cell; y: main tangent and kind
};

SHARED_STRUCT(LightState)
{
    uint filled, beside; // cells with hair, cells next to them
    uint done;           // 1: no order more is needed
    vec4 more;           // rgb: how much of the last order the orders after it add
};

// Floats of the tables: [class][ordinate] the sine of their angle; [class][3]; [face][row][column]
// the class.
#define LIGHT_TANGENT_AT   (LIGHT_CLASSES * LIGHT_ORDINATES)
#define LIGHT_NEAREST_AT   (LIGHT_TANGENT_AT + 3 * LIGHT_CLASSES)
#define LIGHT_TABLES_COUNT (LIGHT_NEAREST_AT + 6 * LIGHT_SQUARES * LIGHT_SQUARES)

// Words of BOX_OUT: lowest place (m, lattice's axes), highest, square of the longest segment; as
// floats' bits, see shadow_bounds.comp.
#define LIGHT_BOX_WORDS 7

UNIFORM_BLOCK(LightParams, light_params, BIND_LIGHT)
{
    vec4 turn[3];         // xyz: the lattice's axes in the world, unit
    vec4 low;             // xyz: the first cell's corner, m, by those axes; w: a cell's side, m
    uvec4 count;          // xyz: cells by axis; w: all
    vec4 way[MAX_LIGHTS]; // xyz: unit, to a light afar; where a lamp is, m; w: its map, -1: none
    vec4 ordinate[LIGHT_ORDINATES]; // xyz: unit, the way that light goes
    vec4 eye;                       // xyz: m, by the axes; w: opacity to the eye over that to light
    vec4 eye_axis; // xyz: unit, that the table of what is seen is for; w: the nearest ordinate
    vec4 albedo[LIGHT_KINDS]; // rgb: of light square to the fibre
    uint pieces;              // of a segment
    uint step;                // of so many strands one stands for all in the cells
    uint lights;              // whose light is followed
    uint classes;             // of tangents, of all kinds
    uint room;                // slots
    uint plane;               // cells of a plane, see light_sweep.comp
    uint walled;              // 1: a mesh stands among the cells
    uint tinted;              // 1: some hair is painted
}
END_BLOCK(LightParams, light_params);
