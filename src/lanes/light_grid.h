// SPDX-License-Identifier: MIT
// Light from fibre to fibre, and light from the sky: the radiance among hair, in cubic cells and by
// direction (discrete ordinates). Needs no OpenGL. The result does not depend on the number of
// threads.
//
// Hair in a cell of side h absorbs or scatters the share 1 - exp(-tau) of light that travels along
// d, with
//   tau = k s,  k = sum over fibres of 2 r length sin(t, d) / h^3
// where s is the length of the way through the cell and t a fibre's tangent. The cell sends out
// along d
//   S(d) = first(d) + sum over d' of f(t; -d' -> d) L(d').
// `first` is the lights' own light after one scattering, with the visibility from the shadow maps.
// f is the fibre's scattering function (fibre_lobes.h), widened by the angle that a direction
// stands for, and scaled so that a fibre sends on its albedo and not more. Each order of scattering
// is one sweep through the cells in each direction; the orders that are not swept are added as a
// geometric series. The axes of the cells turn with the first light, so that this light travels
// exactly along one of the directions.
#pragma once

#include "draw/light_scene.h"

typedef struct LightGrid {
    struct LightGridState *state; // owned
} LightGrid;

// Computes the light. RESULT_FAILED if memory is short.
Result light_grid_solve(LightGrid *grid, const GridScene *scene, Error *error);

// Prepares light_grid_show.h for an eye: `draw`'s eye and `to_eye` may differ from those of
// light_grid_solve. RESULT_FAILED if memory is short.
Result light_grid_prepare(LightGrid *grid, const GridScene *scene, Error *error);

// A zeroed struct may be destroyed.
void light_grid_destroy(LightGrid *grid);
