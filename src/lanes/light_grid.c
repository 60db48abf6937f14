// SPDX-License-Identifier: MIT
#include "lanes/light_grid.h"

#include "lanes/light_grid_state.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// --- Tables of kinds of fibres.

// What a fibre of the class sends along each direction of light 1 from `way` (unit, towards it),
// times the width that it shows there.
static void make_first_row(const FibreLobes *lobes, const float way[3], int class,
                           float row[GRID_WIDE])
{
    const float *t = TANGENT[class];
    Ways in, out;
    grid_same_ways(way, 1, &in);
    for (int g = 0; g < ORDINATE_GROUPS; ++g) {
        float f[3][ORDINATE_LANES];
        grid_group_ways(g, &out);
        fibre_lobes_scatter(lobes, t, &out, &in, GRID_BLUR, f);
        for (int l = 0; l < GRID_LANES; ++l) {
            float along = t[0] * out.axis[0][l] + t[1] * out.axis[1][l] + t[2] * out.axis[2][l],
                  sine = sqrtf(fmaxf(1 - along * along, 0));
            for (int c = 0; c < 3; ++c)
                row[(g * 3 + c) * GRID_LANES + l] = (float)M_PI * sine * f[c][l];
        }
    }
}

typedef struct MakeFirst {
    GridKind *kind;
    int light, parts;
} MakeFirst;

static void make_first(void *data, int part)
{
    const MakeFirst *make = data;
    GridKind *kind = make->kind;
    for (int class = part; class < TANGENTS; class += make->parts)
        make_first_row(&kind->lobes, kind->first_way[make->light], class,
                       kind->first[make->light][class]);
}

Result light_grid_make_first(LightGridState *state, const GridScene *scene, Error *error)
{
    for (int k = 0; k < scene->kind_count && state->lights > 0; ++k) {
        GridKind *kind = &state->kinds[k];
        if (!kind->first) kind->first = malloc(MAX_LIGHTS * sizeof *kind->first);
        if (!kind->first) return error_set(error, RESULT_FAILED, "no memory for light among hair");
        for (int l = 0; l < state->lights; ++l) {
            if (kind->has_first[l] &&
                memcmp(kind->first_way[l], state->to_light[l], sizeof kind->first_way[l]) == 0)
                continue;
            memcpy(kind->first_way[l], state->to_light[l], sizeof kind->first_way[l]);
            MakeFirst make = {kind, l, state->parts};
            parallel_run(state->parts, make_first, &make);
            kind->has_first[l] = true;
            ++kind->first_made;
        }
    }
    return RESULT_OK;
}

// Rows are scaled so that light 1 from everywhere leaves as the fibre's albedo.
static void make_scatter_table(const FibreLobes *lobes, int class,
                               float (*table)[ORDINATES][ORDINATES])
{
    const float *t = TANGENT[class];
    Ways in, out;
    for (int g = 0; g < ORDINATE_GROUPS; ++g) {
        float sum[3][GRID_LANES] = {{0}};
        grid_group_ways(g, &out);
        for (int d = 0; d < ORDINATES; ++d) {
            float f[3][ORDINATE_LANES], from[3] = {ORDINATE[0][d], ORDINATE[1][d], ORDINATE[2][d]};
            grid_same_ways(from, -1, &in);
            fibre_lobes_scatter(lobes, t, &out, &in, 2 * GRID_BLUR, f);
            for (int c = 0; c < 3; ++c)
                for (int l = 0; l < GRID_LANES; ++l) {
                    table[c][d][g * GRID_LANES + l] = f[c][l];
                    sum[c][l] += f[c][l];
                }
        }
        for (int l = 0; l < GRID_LANES; ++l) {
            float along = t[0] * out.axis[0][l] + t[1] * out.axis[1][l] + t[2] * out.axis[2][l],
                  albedo[3];
            fibre_lobes_albedo(lobes, sqrtf(fmaxf(1 - along * along, 0)), albedo);
            for (int c = 0; c < 3; ++c)
                for (int d = 0; d < ORDINATES; ++d)
                    table[c][d][g * GRID_LANES + l] *= albedo[c] / fmaxf(sum[c][l], 1e-12f);
        }
    }
}

typedef struct MakeScatter {
    LightGridState *state;
    uint16_t needed[GRID_CLASSES];
    int count, parts;
} MakeScatter;

static void make_scatter(void *data, int part)
{
    const MakeScatter *make = data;
    for (int n = part; n < make->count; n += make->parts) {
        GridKind *kind = &make->state->kinds[make->needed[n] / TANGENTS];
        int class = make->needed[n] % TANGENTS;
        make_scatter_table(&kind->lobes, class, kind->scatter[class]);
    }
}

// Adds a class, of its kind, to those whose table is to be made.
static void need_scatter(MakeScatter *make, int class)
{
    GridKind *kind = &make->state->kinds[class / TANGENTS];
    if (kind->has_scatter[class % TANGENTS]) return;
    kind->has_scatter[class % TANGENTS] = true;
    make->needed[make->count++] = (uint16_t) class;
    ++kind->scatter_made;
}

Result light_grid_make_scatter(LightGridState *state, const GridScene *scene, bool all,
                               Error *error)
{
    MakeScatter make = {.state = state, .parts = state->parts};
    for (int k = 0; k < scene->kind_count; ++k) {
        GridKind *kind = &state->kinds[k];
        if (!kind->scatter) kind->scatter = malloc(TANGENTS * sizeof *kind->scatter);
        if (!kind->scatter)
            return error_set(error, RESULT_FAILED, "no memory for light among hair");
    }
    for (int class = 0; class < scene->kind_count * TANGENTS && all; ++class)
        need_scatter(&make, class);
    for (int f = 0; f < state->filled && !all; ++f) need_scatter(&make, state->class[f]);
    if (make.count) parallel_run(state->parts, make_scatter, &make);
    return RESULT_OK;
}

static void forget_kind(GridKind *kind)
{
    memset(kind->has_scatter, 0, sizeof kind->has_scatter);
    memset(kind->has_first, 0, sizeof kind->has_first);
    kind->has_gather = false;
}

void light_grid_set_kinds(LightGridState *state, const GridScene *scene)
{
    for (int k = 0; k < scene->kind_count; ++k) {
        GridKind *kind = &state->kinds[k];
        if (kind->lobes.serial == scene->kinds[k].serial) continue;
        kind->lobes = scene->kinds[k];
        forget_kind(kind);
    }
}

void light_grid_forget(LightGridState *state)
{
    for (int k = 0; k < LIGHT_GRID_KINDS; ++k) {
        free(state->kinds[k].scatter);
        free(state->kinds[k].first);
        free(state->kinds[k].gather);
        state->kinds[k] = (GridKind){0};
    }
}

// --- The whole.

static Result make_planes(LightGridState *state, Error *error)
{
    const int *n = state->lattice.count;
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
    light_grid_set_kinds(state, scene);
    state->filled = state->active = 0;
    if (!light_grid_fill(state, scene, error, &result)) return result;
    TRY(make_planes(state, error));
    TRY(light_grid_make_scatter(state, scene, false, error));
    bool sky = light_scene_has_sky(scene->draw);
    light_grid_sweep(state, scene, sky, true, state->lights == 0);
    double all[3] = {0};
    light_grid_needs_more(state, all);
    for (int order = 1; order <= scene->orders; ++order) {
        light_grid_scatter(state);
        light_grid_sweep(state, scene, false, false, false);
        bool more = light_grid_needs_more(state, all);
        if (order > 1 && !more) break;
    }
    light_grid_close(state, scene->orders > 1);
    return RESULT_OK;
}

Result light_grid_gather(LightGrid *grid, const GridScene *scene, Error *error)
{
    return light_grid_show(grid->state, scene, error);
}

void light_grid_destroy(LightGrid *grid)
{
    LightGridState *state = grid->state;
    if (!state) return;
    light_grid_forget(state);
    free(state->slot);
    free(state->first_item);
    free(state->items);
    free(state->cell_of);
    free(state->depth);
    free(state->passage);
    free(state->sum);
    free(state->walls);
    free(state->spans);
    free(state->source);
    free(state->order);
    free(state->light);
    free(state->hidden);
    free(state->glow);
    free(state->tint);
    free(state->class);
    free(state->planes);
    free(state);
    grid->state = NULL;
}
