// SPDX-License-Identifier: MIT
// Sums the light that hair sends onto surfaces: from the light of each group of directions to the
// six faces of each cell (kernel/onto.h).
#include "lanes/light_grid_onto.h"

#include "base/room.h"

#include <math.h>
#include <stdlib.h>

static bool make_sent(LightGridState *state)
{
    size_t filled = (size_t)state->filled, room = filled + filled / 4;
    return state->sent_room >= filled ||
           room_make(&state->sent, &state->sent_room, room, GRID_WIDE * sizeof *state->sent);
}

bool light_grid_make_onto(LightGridState *state)
{
    if (!make_sent(state)) return false;
    size_t cells = light_lattice_cells(&state->field.lattice);
    if (state->onto_room >= cells) return true;
    free(state->onto);
    free(state->onto_groups);
    state->onto = malloc(cells * sizeof *state->onto);
    state->onto_groups = malloc(ORDINATE_GROUPS * cells * sizeof *state->onto_groups);
    state->onto_room = state->onto && state->onto_groups ? cells : 0;
    return state->onto_room != 0;
}

void light_grid_find_faces(int group, float face[ONTO_FACES][GRID_LANES])
{
    for (int f = 0; f < ONTO_FACES; ++f) {
        float sign = f % 2 ? 1 : -1, sum = 0;
        for (int d = 0; d < ORDINATES; ++d) sum += onto_weight(sign * ORDINATE[f / 2][d]);
        for (int l = 0; l < GRID_LANES; ++l)
            face[f][l] = onto_weight(sign * ORDINATE[f / 2][group * GRID_LANES + l]) / sum;
    }
}

SIMD_INLINE void sum_onto(const LightGridState *state, int part)
{
    size_t cells = light_lattice_cells(&state->field.lattice),
           first = cells * (size_t)part / (size_t)state->parts,
           end = cells * (size_t)(part + 1) / (size_t)state->parts;
    for (size_t i = first; i < end; ++i) {
        float all = 0;
        for (int f = 0; f < ONTO_FACES; ++f)
            for (int c = 0; c < 3; ++c) {
                float sum = 0;
                for (size_t g = 0; g < ORDINATE_GROUPS; ++g)
                    sum += state->onto_groups[g * cells + i][f][c];
                state->onto[i][f][c] = sum;
                all += sum;
            }
        state->onto[i][0][3] = all;
    }
}

SIMD_STAGE(sum_onto, LightGridState)

void light_grid_sum_onto(LightGridState *state)
{
    run_sum_onto(state, state->parts);
}
