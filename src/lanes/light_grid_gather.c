// SPDX-License-Identifier: MIT
// Work for one position of the eye before light_grid_show.h reads the light. Finds the cells that
// lie so deep in hair that they are hardly visible; their mean light is enough. Finds the ambient
// part of the light of cells with hair. Makes room for the light that cells show.
#include "lanes/light_grid_show.h"

#include "base/room.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct Gather {
    LightGridState *state;
    int ordinate;  // the ordinate nearest to the direction of the eye
    float opacity; // least ratio, over all hair, of opacity to the eye and opacity to light
    const DrawParams *draw;
    float around[3]; // mean ambient radiance; `ambient`: there is some
    bool ambient;
} Gather;

// --- Hidden cells.

static bool is_hidden(const Gather *gather, int slot)
{
    const LightGridState *state = gather->state;
    const LightLattice *lattice = &state->field.lattice;
    const float most = CELL_HIDDEN_BEHIND / gather->opacity;
    int cell[3];
    float way[3];
    grid_place(state, slot, cell);
    for (int k = 0; k < 3; ++k)
        way[k] = (state->eye[k] - lattice->low[k]) / lattice->side - (float)cell[k] - 0.5f;
    return light_grid_behind(state, cell, way, gather->ordinate, 2, most) > most;
}

// Finds the ambient part of a cell's light (kernel/cone.h). `mean`: the cell's mean light.
static void find_around(const Gather *gather, int f, const float mean[3])
{
    const LightGridState *state = gather->state;
    const FibreLobes *lobes = &state->field.kinds[state->class[f] / TANGENTS].lobes;
    GridCone *cone = &state->cone[f];
    for (int c = 0; c < 3; ++c) {
        float lamps = 0;
        for (int l = 0; l < state->field.lights; ++l)
            lamps += cone->lit[l] * gather->draw->light_color[l][c];
        cone->around[c] = cone_around(mean[c], lamps, gather->around[c], cone->area,
                                      lobes->albedo[SCATTER_INCLINATIONS - 1][c]);
    }
}

SIMD_INLINE void find_mean(const float light[GRID_WIDE], float mean[3])
{
    for (int k = 0; k < 3; ++k) {
        float sum = 0;
        for (int g = 0; g < ORDINATE_GROUPS; ++g)
            for (int l = 0; l < GRID_LANES; ++l) sum += light[(g * 3 + k) * GRID_LANES + l];
        mean[k] = sum / ORDINATES;
    }
}

SIMD_INLINE void find_hidden(const Gather *gather, int part)
{
    LightGridState *state = gather->state;
    int first = (int)((int64_t)state->active * part / state->parts),
        end = (int)((int64_t)state->active * (part + 1) / state->parts);
    for (int s = first; s < end; ++s) {
        float *mean = state->hidden + (size_t)s * 4;
        bool ambient = gather->ambient && s < state->filled;
        mean[3] = is_hidden(gather, s) ? 1 : 0;
        if (mean[3] > 0 || ambient) find_mean(state->light + (size_t)s * GRID_WIDE, mean);
        if (ambient) find_around(gather, s, mean);
    }
}

SIMD_STAGE(find_hidden, Gather)

// --- Patches of cells.

typedef float Wide __attribute__((vector_size(4 * CELL_PATCH_NODES), aligned(4), may_alias));

typedef struct FindPatch {
    const float (*table)[CELL_PATCH_NODES]; // [GRID_WIDE]
    const float *light;                     // [GRID_WIDE]
    float (*seen)[4];                       // [CELL_PATCH_NODES]
} FindPatch;

SIMD_INLINE void find_patch(const FindPatch *find, int part)
{
    Wide sum[3] = {{0}};
    (void)part;
    for (int g = 0, i = 0; g < ORDINATE_GROUPS; ++g)
        for (int c = 0; c < 3; ++c)
            for (int l = 0; l < GRID_LANES; ++l, ++i)
                sum[c] += find->light[i] * *(const Wide *)find->table[i];
    for (int n = 0; n < CELL_PATCH_NODES; ++n) {
        for (int c = 0; c < 3; ++c) find->seen[n][c] = sum[c][n];
        find->seen[n][3] = 0;
    }
}

SIMD_CALL(find_patch, FindPatch)

const float (*light_grid_find_patch(const LightGridState *state, int kind, int slot, int patch,
                                    float scratch[CELL_PATCH_NODES][4]))[4]
{
    GridPatches *patches = state->patches;
    int number = atomic_fetch_add_explicit(&patches->count, 1, memory_order_relaxed);
    bool kept = number < patches->room;
    FindPatch find = {.table =
                          (const float(*)[CELL_PATCH_NODES])state->field.kinds[kind].gather[patch],
                      .light = state->light + (size_t)slot * GRID_WIDE,
                      .seen = kept ? patches->seen[number] : scratch};
    call_find_patch(&find);
    if (kept)
        atomic_store_explicit(grid_patch(state, kind, slot, patch), number + 1,
                              memory_order_release);
    return (const float(*)[4])find.seen;
}

// Empties the cache of patches, and makes room for more patches than the last image used.
static bool forget_patches(LightGridState *state, int kinds)
{
    if (!state->patches) state->patches = calloc(1, sizeof *state->patches);
    GridPatches *patches = state->patches;
    if (!patches) return false;
    size_t count = (size_t)kinds * ((size_t)state->active + 1) * CELL_PATCHES;
    int most = atomic_load(&patches->count), least = 4 * state->active;
    most = most > least ? most : least;
    room_make(&patches->of, &patches->of_room, count, sizeof *patches->of);
    if (patches->room < most) {
        free(patches->seen);
        patches->room = most + most / 4;
        patches->seen = room_new((size_t)patches->room, sizeof *patches->seen);
        if (!patches->seen) patches->room = 0; // patches are then computed at each use
    }
    atomic_store(&patches->count, 0);
    if (patches->of) memset((void *)patches->of, 0, count * sizeof *patches->of);
    return patches->of != NULL;
}

Result light_grid_prepare(LightGrid *grid, const GridScene *scene, Error *error)
{
    LightGridState *state = grid->state;
    if (!state || !state->filled) return RESULT_OK;
    light_lattice_turn(&state->field.lattice, scene->draw->eye, state->eye);
    Gather gather = {.state = state,
                     .opacity = light_field_opacity(scene),
                     .draw = scene->draw,
                     .ambient = light_scene_has_sky(scene->draw),
                     .ordinate = light_field_nearest(&state->field.lattice, scene->to_eye)};
    find_mean(state->field.around, gather.around);
    TRY(light_field_make_gather(&state->field, scene, error));
    TRY(light_field_make_cone(&state->field, scene, error));
    memset(state->hidden + 4 * (size_t)state->active, 0, 4 * sizeof *state->hidden);
    run_find_hidden(&gather, state->parts);
    return forget_patches(state, scene->kind_count)
               ? RESULT_OK
               : error_set(error, RESULT_FAILED, "no memory for light among hair");
}
