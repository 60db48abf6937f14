// SPDX-License-Identifier: MIT
// Finds the cells of a light grid that contain hair, step by step, and allocates memory for them.
#include "lanes/light_grid_state.h"

#include "base/room.h"

#include <stdlib.h>
#include <string.h>

enum { KEPT_ITEM_BYTES = 32 << 20 };

// --- Memory.

static bool grow_cells(LightGridState *state, size_t cells)
{
    size_t room[3] = {state->cell_room, state->cell_room, state->cell_room};
    bool good = room_make(&state->slot, &room[0], cells, sizeof *state->slot) &&
                room_make(&state->first_item, &room[1], (size_t)state->parts * cells,
                          sizeof *state->first_item) &&
                room_make(&state->cell_of, &room[2], cells, sizeof *state->cell_of);
    state->cell_room = good ? room[0] : 0;
    return good;
}

static bool grow_slots(LightGridState *state)
{
    size_t filled = (size_t)state->filled, active = (size_t)state->active;
    size_t of[11];
    for (int i = 0; i < 11; ++i) of[i] = i < 5 || i == 10 ? state->filled_room : state->slot_room;
    filled += filled / 4, active += active / 4;
    if (state->filled_room >= (size_t)state->filled && state->slot_room >= (size_t)state->active)
        return true;
    bool good = room_make(&state->depth, &of[0], filled, ORDINATES * sizeof(float)) &&
                room_make(&state->passage, &of[1], filled, GRID_WIDE * sizeof(float)) &&
                room_make(&state->source, &of[2], filled, GRID_WIDE * sizeof(float)) &&
                room_make(&state->tint, &of[3], filled, 3 * sizeof(float)) &&
                room_make(&state->glow, &of[9], active, 3 * sizeof(float)) &&
                room_make(&state->class, &of[4], filled, sizeof(int)) &&
                room_make(&state->cone, &of[10], filled, sizeof *state->cone) &&
                room_make(&state->sum, &of[5], active, GRID_WIDE * sizeof(float)) &&
                room_make(&state->order, &of[6], active, GRID_WIDE * sizeof(float)) &&
                room_make(&state->light, &of[7], active + 1, GRID_WIDE * sizeof(float)) &&
                room_make(&state->hidden, &of[8], active + 1, 4 * sizeof(float));
    state->filled_room = good ? of[0] : 0;
    state->slot_room = good ? of[6] : 0;
    return good;
}

// Frees the items, which are not needed any more once cells are filled: 300 MB for 1,000,000
// strands of 16 vertices. Small arrays are kept for the next image, because allocating them again
// takes longer than it is worth.
static void release_items(LightGridState *state)
{
    if (state->item_room * sizeof *state->items <= KEPT_ITEM_BYTES) return;
    free(state->items);
    state->items = NULL;
    state->item_room = 0;
}

// --- All steps.

static Result fill_all(LightGridState *state, const GridScene *scene, Error *error)
{
    size_t cells = light_lattice_cells(&state->field.lattice);
    Result result = RESULT_OK;
    if (!grow_cells(state, cells)) return RESULT_FAILED;
    memset(state->first_item, 0, (size_t)state->parts * cells * sizeof *state->first_item);
    light_grid_place(state, scene, false);
    light_grid_make_slots(state);
    if (!light_grid_find_spans(state) ||
        !room_make(&state->items, &state->item_room,
                   (size_t)state->item_count * (size_t)state->item_words, sizeof *state->items) ||
        !grow_slots(state))
        return RESULT_FAILED;
    light_grid_place(state, scene, true);
    THEN(result, light_field_make_first(&state->field, scene, error));
    if (result != RESULT_OK) return result;
    if (!light_grid_fill_cells(state, scene)) return RESULT_FAILED;
    release_items(state);
    return RESULT_OK;
}

bool light_grid_fill(LightGridState *state, const GridScene *scene, Error *error, Result *result)
{
    ordinates_prepare();
    *result = RESULT_OK;
    if (!light_grid_find_lattice(state, scene)) return false;
    light_field_find_lights(&state->field, scene);
    state->item_words = 2 + state->field.lights + (state->field.tinted ? 3 : 0);
    memcpy(state->mesh_color, scene->draw->mesh_color, sizeof state->mesh_color);
    *result = light_field_find_walls(&state->field, scene, error);
    if (*result != RESULT_OK) return false;
    *result = fill_all(state, scene, error);
    if (*result == RESULT_FAILED)
        error_set(error, RESULT_FAILED, "no memory for light among hair: %d x %d x %d cells",
                  state->field.lattice.count[0], state->field.lattice.count[1],
                  state->field.lattice.count[2]);
    return *result == RESULT_OK;
}
