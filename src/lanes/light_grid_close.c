// SPDX-License-Identifier: MIT
// The orders of scattering that are not swept, and the light of all of them.
#include "lanes/light_grid_state.h"

#include <math.h>

// Of two orders after each other what hair meets falls by this factor.
static double falling(const LightGridState *state, int channel)
{
    double before = 0, last = 0;
    for (int g = 0; g < ORDINATE_GROUPS; ++g) {
        before += state->sums[0][g][channel];
        last += state->sums[1][g][channel];
    }
    return before > 0 ? fmin(last / before, 0.95) : 0;
}

bool light_grid_needs_more(const LightGridState *state, double all[3])
{
    const double most_left = 0.05;
    bool more = false;
    for (int c = 0; c < 3; ++c) {
        double last = 0, ratio = falling(state, c);
        for (int g = 0; g < ORDINATE_GROUPS; ++g) last += state->sums[1][g][c];
        all[c] += last;
        double left = last * ratio / (1 - ratio);
        more |= left > most_left * (all[c] + left);
    }
    return more;
}

SIMD_INLINE void close_lights(const LightGridState *state, int part)
{
    float more[3];
    for (int c = 0; c < 3; ++c) {
        double ratio = state->closing ? falling(state, c) : 0;
        more[c] = (float)(ratio / (1 - ratio));
    }
    int first = (int)((int64_t)state->active * part / state->parts),
        end = (int)((int64_t)state->active * (part + 1) / state->parts);
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
