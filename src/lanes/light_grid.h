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

#include "draw/light_scene.h"

typedef struct LightGrid {
    struct LightGridState *state; // owned
} LightGrid;

// Finds the light. RESULT_FAILED if memory is short.
Result light_grid_solve(LightGrid *grid, const GridScene *scene, Error *error);

// Makes ready what light_grid_show.h needs: `draw`'s eye and `to_eye` may be others than those of
// light_grid_solve. RESULT_FAILED if memory is short.
Result light_grid_prepare(LightGrid *grid, const GridScene *scene, Error *error);

// A zeroed struct is legal.
void light_grid_destroy(LightGrid *grid);
