// SPDX-License-Identifier: MIT
#include "lanes/light_grid.h"

#include "lanes/light_grid_state.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static Result make_planes(LightGridState *state, Error *error)
{
    const int *n = state->field.lattice.count;
    size_t most = (size_t)(n[0] > n[1] ? n[0] : n[1]);
    most = (most > (size_t)n[2] ? most : (size_t)n[2]) + 2;
    size_t plane = (most > 6 ? most : 6) * most * 3 * GRID_LANES;
    if (state->plane >= plane) return RESULT_OK;
    free(state->planes);
    state->planes = malloc(3 * ORDINATE_GROUPS * plane * sizeof *state->planes);
    state->plane = state->planes ? plane : 0;
    return state->planes ? RESULT_OK
                         : error_set(error, RESULT_FAILED, "no memory for light among hair");
}

Result light_grid_solve(LightGrid *grid, const GridScene *scene, Error *error)
{
    if (!grid->state) grid->state = calloc(1, sizeof *grid->state);
    LightGridState *state = grid->state;
    Result result;
    if (!state) return error_set(error, RESULT_FAILED, "no memory for light among hair");
    state->parts = parallel_threads();
    light_field_set_kinds(&state->field, scene);
    state->filled = state->active = 0;
    if (!light_grid_fill(state, scene, error, &result)) return result;
    TRY(make_planes(state, error));
    TRY(light_field_make_scatter(&state->field, scene, state->class, state->filled, error));
    bool sky = light_scene_has_sky(scene->draw);
    state->lights_skin = scene->skin && state->field.walled;
    if (state->lights_skin) {
        if (!light_grid_make_onto(state))
            return error_set(error, RESULT_FAILED, "no memory for light of hair on skin");
        memcpy(state->sent, state->source, (size_t)state->filled * GRID_WIDE * sizeof(float));
    }
    light_grid_sweep(state, sky, true);
    float all[3] = {0};
    light_grid_needs_more(state, all);
    for (int order = 1; order <= scene->orders; ++order) {
        light_grid_scatter(state);
        light_grid_sweep(state, false, false);
        bool more = light_grid_needs_more(state, all);
        if (order > 1 && !more) break;
    }
    light_grid_close(state, scene->orders > 1);
    if (state->lights_skin) {
        light_grid_sweep_onto(state);
        light_grid_sum_onto(state);
    }
    memcpy(state->light + (size_t)state->active * GRID_WIDE, state->field.around,
           sizeof state->field.around);
    return RESULT_OK;
}

void light_grid_destroy(LightGrid *grid)
{
    LightGridState *state = grid->state;
    if (!state) return;
    light_field_destroy(&state->field);
    free(state->slot);
    free(state->first_item);
    free(state->items);
    free(state->cell_of);
    free(state->depth);
    free(state->passage);
    free(state->sum);
    free(state->spans);
    free(state->source);
    free(state->order);
    free(state->light);
    free(state->sent);
    free(state->onto);
    free(state->onto_groups);
    free(state->hidden);
    free(state->glow);
    free(state->tint);
    free(state->class);
    free(state->cone);
    free(state->planes);
    if (state->patches) {
        free((void *)state->patches->of);
        free(state->patches->seen);
        free(state->patches);
    }
    free(state);
    grid->state = NULL;
}
