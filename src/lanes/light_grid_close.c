// SPDX-License-Identifier: MIT
// Estimates the orders of scattering that are not swept, and adds up the light of all orders, which
// cells receive and send.
#include "lanes/light_grid_state.h"

#include <math.h>

// The light that hair met in the last order but one ([0]) and in the last order ([1]).
static void find_met(const LightGridState *state, int channel, float met[2])
{
    for (int k = 0; k < 2; ++k) {
        double sum = 0;
        for (int g = 0; g < ORDINATE_GROUPS; ++g) sum += state->sums[k][g][channel];
        met[k] = (float)sum;
    }
}

bool light_grid_needs_more(const LightGridState *state, float all[3])
{
    bool more = false;
    for (int c = 0; c < 3; ++c) {
        float met[2];
        find_met(state, c, met);
        all[c] += met[1];
        more |= cell_needs_more(all[c], met[1], cell_falling(met[0], met[1]));
    }
    return more;
}

// Turns a cell's source of the last order into that of all orders.
SIMD_INLINE void close_source(const LightGridState *state, int f, const float more[3])
{
    for (int g = 0; g < ORDINATE_GROUPS; ++g) {
        float *source = grid_source(state, g, f), *sent = state->sent + (source - state->source);
        for (int c = 0; c < 3; ++c)
            for (int l = c * GRID_LANES; l < (c + 1) * GRID_LANES; ++l)
                source[l] = sent[l] + more[c] * source[l];
    }
}

SIMD_INLINE void close_lights(const LightGridState *state, int part)
{
    float more[3];
    for (int c = 0; c < 3; ++c) {
        float met[2];
        find_met(state, c, met);
        more[c] = state->closing ? cell_further(cell_falling(met[0], met[1])) : 0;
    }
    int first = (int)((int64_t)state->active * part / state->parts),
        end = (int)((int64_t)state->active * (part + 1) / state->parts);
    for (int s = first; s < end && s < state->filled && state->lights_skin; ++s)
        close_source(state, s, more);
    for (size_t s = (size_t)first; s < (size_t)end; ++s)
        for (int g = 0; g < ORDINATE_GROUPS; ++g)
            for (int c = 0; c < 3; ++c) {
                size_t at = s * GRID_WIDE + (size_t)(g * 3 + c) * GRID_LANES;
                const float *sum = grid_lane(state, state->sum, g, (int)s) + c * GRID_LANES,
                            *order = grid_lane(state, state->order, g, (int)s) + c * GRID_LANES;
                for (int l = 0; l < GRID_LANES; ++l)
                    state->light[at + (size_t)l] = sum[l] + more[c] * order[l];
            }
}

SIMD_STAGE(close_lights, LightGridState)

void light_grid_close(LightGridState *state, bool further)
{
    state->closing = further;
    run_close_lights(state, state->parts);
}
