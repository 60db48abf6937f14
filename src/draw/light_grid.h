// SPDX-License-Identifier: MIT
// Light that goes from fibre to fibre, and light from the sky: the radiance among hair in cubic
// cells by direction (discrete ordinates). Needs no OpenGL. The same light whatever number of
// threads.
//
// Hair in a cell of side h takes from light that goes along d the share 1 - exp(-tau), with
//   tau = k s,  k = sum over fibres of 2 r length sin(t, d) / h^3
// (s the way through the cell, t a tangent), and sends out along d
//   S(d) = first(d) + sum over d' of f(t; -d' -> d) L(d').
// `first` is what the lights' own rays leave there, by the visibility that shadow maps find; f is
// the fibre's (fibre_lobes.h), blurred by the width that a direction stands for, and scaled so that
// a fibre sends on its albedo, not more. Each order of scattering is one sweep of the cells in each
// direction; what further orders would add follows as a geometric series. The axes of the cells
// turn with the first light, so that one of the directions is its own.
#pragma once

#include "base/error.h"
#include "draw/fibre_lobes.h"
#include "draw/light_blocks.h"
#include "draw/mapped_caster.h"

#include "glsl/draw/draw.h"

enum { LIGHT_GRID_KINDS = 4 }; // of fibres that scatter in ways of their own; others share the last

// A batch of hair in the light.
typedef struct GridHair {
    MappedCaster caster;
    const float *left; // [map][points]: what of each mapped light reaches the points of its curves
    const float *behind; // the same of the mean number of fibres behind it; for light_dual.h
    size_t points;       // of all its strands (look_points)
    int kind;            // of its fibres
    float (*seen)[4];    // [points], for light_grid_gather: linear RGB; NULL: is not asked for
} GridHair;

typedef struct GridScene {
    const GridHair *hair;
    uint32_t hair_count;
    const FibreLobes *kinds;   // [kind_count]
    int kind_count;            // 1 .. LIGHT_GRID_KINDS
    const DrawParams *draw;    // lights, sky, ground, eye
    float to_eye[3];           // unit, world: against the way that the camera looks
    int map_of[MAX_LIGHTS];    // of each light; -1: it casts no shadow
    const LightBlocks *blocks; // what the mesh takes away within the box of hair; NULL: no mesh
    bool suns;                 // the lights' light is followed, too, not only that of the sky
    int cells;                 // along the longest side of the box, 4 .. 64
    int orders; // of scattering that are swept at most, 0 .. 32; 0: the sky's own light alone
} GridScene;

typedef struct LightGrid {
    struct LightGridState *state; // owned
} LightGrid;

// Finds the light. RESULT_FAILED if memory is short.
Result light_grid_solve(LightGrid *grid, const GridScene *scene, Error *error);

// What of that light each point of the hair sends to the eye, into `seen`. The scene is that of
// light_grid_solve but for `draw`'s eye, `to_eye` and `seen`.
Result light_grid_gather(LightGrid *grid, const GridScene *scene, Error *error);

// A zeroed struct is legal.
void light_grid_destroy(LightGrid *grid);
