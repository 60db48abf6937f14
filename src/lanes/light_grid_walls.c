// SPDX-License-Identifier: MIT
// What the mesh lets through between the cells of a light grid, with a cell around where all
// passes, so that sweeps need not ask whether a cell lies beside the lattice.
#include "lanes/light_grid_state.h"

#include <stdlib.h>
#include <string.h>

bool light_grid_find_walls(LightGridState *state, const GridScene *scene)
{
    const int *n = state->lattice.count;
    size_t cells = light_lattice_cells(&state->lattice), wide = (size_t)n[0] + 2,
           all = 3 * wide * ((size_t)n[1] + 2) * ((size_t)n[2] + 2);
    state->walled = scene->blocks != NULL;
    if (!state->walled) return true;
    if (state->wall_room < all) {
        free(state->walls);
        state->walls = malloc(all * sizeof *state->walls);
        state->wall_room = state->walls ? all : 0;
    }
    if (!state->walls) return false;
    for (size_t i = 0; i < all; ++i) state->walls[i] = 1;
    for (int axis = 0; axis < 3; ++axis) {
        float *out = (float *)grid_walls(state, axis);
        const float *in = scene->blocks->open + (size_t)axis * cells;
        for (int z = 0; z < n[2]; ++z)
            for (int y = 0; y < n[1]; ++y, in += n[0])
                memcpy(out + ((size_t)z * ((size_t)n[1] + 2) + (size_t)y) * wide, in,
                       (size_t)n[0] * sizeof *in);
    }
    return true;
}
