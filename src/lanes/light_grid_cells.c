// SPDX-License-Identifier: MIT
// The optical depth of each cell of a light grid in each direction, and the light that the lamps
// send into it.
#include "lanes/light_grid_state.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Turns counts of items into the index where the items of each part and cell begin. Gives slots to
// cells with hair, then to their neighbours, which interpolation between cells reads, and to cells
// next to the mesh, which reflects light there.
void light_grid_make_slots(LightGridState *state)
{
    const int *n = state->field.lattice.count;
    size_t cells = light_lattice_cells(&state->field.lattice);
    uint32_t sum = 0;
    state->filled = 0;
    for (size_t c = 0; c < cells; ++c) {
        uint32_t before = sum;
        for (int part = 0; part < state->parts; ++part) {
            uint32_t *first = &state->first_item[(size_t)part * cells + c], count = *first;
            *first = sum;
            sum += count;
        }
        state->slot[c] = sum > before ? state->filled : -1;
        if (sum > before) state->cell_of[state->filled++] = (int)c;
    }
    state->item_count = sum;
    state->active = state->filled;
    for (int f = 0; f < state->filled; ++f) {
        int at[3];
        grid_place(state, f, at);
        for (int q = 0; q < 27; ++q) {
            int x = at[0] + q % 3 - 1, y = at[1] + q / 3 % 3 - 1, z = at[2] + q / 9 - 1;
            if (x < 0 || y < 0 || z < 0 || x >= n[0] || y >= n[1] || z >= n[2]) continue;
            int other = (z * n[1] + y) * n[0] + x;
            if (state->slot[other] >= 0) continue;
            state->slot[other] = state->active;
            state->cell_of[state->active++] = other;
        }
    }
    for (int c = 0; c < (int)cells && state->field.walled; ++c) {
        const int at[3] = {c % n[0], c / n[0] % n[1], c / (n[0] * n[1])};
        if (state->slot[c] >= 0 || !light_field_is_beside_mesh(&state->field, at)) continue;
        state->slot[c] = state->active;
        state->cell_of[state->active++] = c;
    }
}

// The sums over a cell's items.
typedef struct CellSum {
    uint64_t class[GRID_CLASSES][1 + MAX_LIGHTS]; // [0]: area; [1 + l]: area lit by light l
    uint64_t whole, tint[3];
    uint16_t used[GRID_CLASSES];
    int count;
    bool is_used[GRID_CLASSES];
} CellSum;

static void add_items(const LightGridState *state, uint32_t first, uint32_t end, CellSum *sum)
{
    for (uint32_t n = first; n < end; ++n) {
        const GridItem *item =
            (const GridItem *)(const void *)(state->items + n * (size_t)state->item_words);
        if (!sum->is_used[item->class]) {
            sum->is_used[item->class] = true;
            sum->used[sum->count++] = (uint16_t)item->class;
        }
        uint64_t *class = sum->class[item->class];
        class[0] += item->area;
        for (int l = 0; l < state->field.lights; ++l) class[1 + l] += item->lit[l];
        sum->whole += item->area;
        for (int k = 0; k < 3 && state->field.tinted; ++k)
            sum->tint[k] += item->lit[state->field.lights + k];
    }
}

static void clear_sum(CellSum *sum)
{
    for (int u = 0; u < sum->count; ++u) {
        sum->is_used[sum->used[u]] = false;
        memset(sum->class[sum->used[u]], 0, sizeof sum->class[0]);
    }
    sum->count = 0;
    sum->whole = 0;
    memset(sum->tint, 0, sizeof sum->tint);
}

// Sorts the classes, because the order in which threads met them is not fixed.
static void sort_classes(CellSum *sum)
{
    for (int u = 1; u < sum->count; ++u) {
        uint16_t class = sum->used[u];
        int to = u;
        for (; to > 0 && sum->used[to - 1] > class; --to) sum->used[to] = sum->used[to - 1];
        sum->used[to] = class;
    }
}

// The main tangent, by power iteration on the sum of t t^T, with the sign of the mean tangent.
// `spread`: of the tangents around it; `strand`: a strand's area (kernel/cone.h).
static int find_main_class(const CellSum *sum, float strand, float *spread)
{
    float tensor[3][3] = {{0}}, mean[3] = {0}, kind_area[LIGHT_GRID_KINDS] = {0},
          main[3] = {0.577f, 0.577f, 0.578f}, most = 0;
    int kind = 0;
    for (int u = 0; u < sum->count; ++u) {
        float w = (float)sum->class[sum->used[u]][0];
        const float *t = TANGENT[sum->used[u] % TANGENTS];
        kind_area[sum->used[u] / TANGENTS] += w;
        if (w > most) most = w, memcpy(main, t, sizeof main);
        for (int i = 0; i < 3; ++i) {
            mean[i] += w * t[i];
            for (int j = 0; j < 3; ++j) tensor[i][j] += w * t[i] * t[j];
        }
    }
    for (int turn = 0; turn < 8; ++turn) {
        float next[3], length = 0;
        for (int i = 0; i < 3; ++i) {
            next[i] = tensor[i][0] * main[0] + tensor[i][1] * main[1] + tensor[i][2] * main[2];
            length += next[i] * next[i];
        }
        for (int i = 0; i < 3 && length > 0; ++i) main[i] = next[i] / sqrtf(length);
    }
    float along = 0, area = 0;
    for (int i = 0; i < 3; ++i) {
        area += tensor[i][i];
        for (int j = 0; j < 3; ++j) along += main[i] * tensor[i][j] * main[j];
    }
    *spread = cone_spread(along / simd_max(area, 1e-12f), area / ITEM_STEPS, strand);
    if (mean[0] * main[0] + mean[1] * main[1] + mean[2] * main[2] < 0)
        for (int i = 0; i < 3; ++i) main[i] = -main[i];
    for (int k = 1; k < LIGHT_GRID_KINDS; ++k)
        if (kind_area[k] > kind_area[kind]) kind = k;
    return kind * TANGENTS + ordinates_class(main);
}

typedef struct CellFill {
    LightGridState *state;
    const GridScene *scene;
    CellSum *sums;               // [parts]
    LightPath paths[MAX_LIGHTS]; // for directional lights, if there is a mesh
} CellFill;

// The share of light l that the mesh lets through to a cell.
static float find_passed(const CellFill *fill, int slot, int l)
{
    const LightGridState *state = fill->state;
    const LightLattice *lattice = &state->field.lattice;
    const GridScene *scene = fill->scene;
    int cell[3];
    float way[3], square = 0, lamp[3];
    if (!scene->blocks) return 1;
    grid_place(state, slot, cell);
    if (scene->draw->light_place[l][3] == 0)
        return light_path_follow(&fill->paths[l], scene->blocks, lattice, cell);
    light_lattice_turn(lattice, scene->draw->light_place[l], lamp);
    for (int k = 0; k < 3; ++k) {
        way[k] = lamp[k] - lattice->low[k] - ((float)cell[k] + 0.5f) * lattice->side;
        square += way[k] * way[k];
    }
    float reach = fmaxf(sqrtf(square), 1e-6f);
    for (int k = 0; k < 3; ++k) way[k] /= reach;
    return light_blocks_march(scene->blocks, lattice, cell, way, reach);
}

// k h in each direction: the extinction k times the side h. fill_source then computes the source S
// without scattering, first(d) / k.
SIMD_INLINE void fill_depths(const CellSum *sum, float depth[ORDINATES])
{
    for (int d = 0; d < ORDINATES; ++d) depth[d] = 0;
    for (int u = 0; u < sum->count; ++u) {
        float w = (float)sum->class[sum->used[u]][0] * (1 / ITEM_STEPS);
        const float *sine = TANGENT_SINE[sum->used[u] % TANGENTS];
        for (int d = 0; d < ORDINATES; ++d) depth[d] += w * sine[d];
    }
}

SIMD_INLINE void fill_source(const LightGridState *state, const GridScene *scene,
                             const CellSum *sum, const float passed[MAX_LIGHTS], int f)
{
    const float *depth = state->depth + (size_t)f * ORDINATES, *tint = state->tint + 3 * f;
    float source[GRID_WIDE];
    for (int i = 0; i < GRID_WIDE; ++i) source[i] = 0;
    for (int l = 0; l < state->field.lights; ++l) {
        float part[GRID_WIDE] = {0};
        for (int u = 0; u < sum->count && passed[l] > 0; ++u) {
            int class = sum->used[u];
            float w = (float)sum->class[class][1 + l] * (passed[l] / ITEM_STEPS);
            const float *first = state->field.kinds[class / TANGENTS].first[l][class % TANGENTS];
            if (w > 0)
                for (int i = 0; i < GRID_WIDE; ++i) part[i] += w * first[i];
        }
        for (int g = 0; g < ORDINATE_GROUPS; ++g)
            for (int c = 0; c < 3; ++c) {
                float color = scene->draw->light_color[l][c] * tint[c];
                for (int k = 0; k < GRID_LANES; ++k) {
                    int at = (g * 3 + c) * GRID_LANES + k;
                    source[at] += part[at] * color / simd_max(depth[g * GRID_LANES + k], 1e-12f);
                }
            }
    }
    for (int g = 0; g < ORDINATE_GROUPS; ++g)
        memcpy(grid_source(state, g, f), source + g * GROUP_WIDE, GROUP_WIDE * sizeof *source);
}

// Fills in a cell's GridCone, except for the ambient part, which light_grid_gather.c finds.
static void fill_cone(const LightGridState *state, const CellSum *sum,
                      const float passed[MAX_LIGHTS], float spread, int f)
{
    GridCone cone = {.area = (float)sum->whole * (1 / ITEM_STEPS)};
    for (int l = 0; l < state->field.lights; ++l) {
        uint64_t lit = 0;
        for (int u = 0; u < sum->count; ++u) lit += sum->class[sum->used[u]][1 + l];
        cone.lit[l] = (float)lit * (passed[l] / ITEM_STEPS);
    }
    cone.spread = spread * cone.area;
    state->cone[f] = cone;
}

// Transmittance and mean share of a passage. Along a direction the way through a cell is as long as
// its side over the direction's main component.
SIMD_INLINE void fill_passage(LightGridState *state, int f)
{
    const float *depth = state->depth + (size_t)f * ORDINATES;
    for (int g = 0; g < ORDINATE_GROUPS; ++g) {
        float *left = grid_passage(state, g, f), *mean = left + GRID_LANES;
        memcpy(mean + GRID_LANES, depth + g * GRID_LANES, GRID_LANES * sizeof *depth);
        for (int l = 0; l < GRID_LANES; ++l) {
            int d = g * GRID_LANES + l;
            float tau = depth[d] / fabsf(ORDINATE[g / 2][d]);
            left[l] = cell_left(tau);
            mean[l] = cell_mean_share(tau, left[l]);
        }
    }
}

SIMD_INLINE void fill_cells(const CellFill *fill, int part)
{
    LightGridState *state = fill->state;
    size_t cells = light_lattice_cells(&state->field.lattice);
    CellSum *sum = &fill->sums[part];
    int first = (int)((int64_t)state->filled * part / state->parts),
        end = (int)((int64_t)state->filled * (part + 1) / state->parts);
    float strand = light_field_strand(&state->field, fill->scene);
    for (int f = first; f < end; ++f) {
        // Placing items has moved first_item to the end of each cell's items, so the last part's
        // entry is the end of this cell, and the previous cell's entry is its beginning.
        size_t c = (size_t)state->cell_of[f];
        uint32_t stop = state->first_item[(size_t)(state->parts - 1) * cells + c],
                 start = c ? state->first_item[(size_t)(state->parts - 1) * cells + c - 1] : 0;
        add_items(state, start, stop, sum);
        sort_classes(sum);
        fill_depths(sum, state->depth + (size_t)f * ORDINATES);
        for (int k = 0; k < 3; ++k)
            state->tint[3 * f + k] =
                state->field.tinted && sum->whole ? (float)sum->tint[k] / (float)sum->whole : 1;
        float passed[MAX_LIGHTS];
        for (int l = 0; l < state->field.lights; ++l) passed[l] = find_passed(fill, f, l);
        fill_source(state, fill->scene, sum, passed, f);
        float spread;
        state->class[f] = find_main_class(sum, strand, &spread);
        fill_cone(state, sum, passed, spread, f);
        fill_passage(state, f);
        clear_sum(sum);
    }
}

SIMD_STAGE(fill_cells, CellFill)

float light_grid_behind(const LightGridState *state, const int cell[3], const float way[3],
                        int ordinate, int first, float most)
{
    const int *n = state->field.lattice.count;
    float length = 0, sum = 0;
    int axis = 0;
    for (int k = 0; k < 3; ++k) {
        if (fabsf(way[k]) > fabsf(way[axis])) axis = k;
        length += way[k] * way[k];
    }
    float main = fmaxf(fabsf(way[axis]), 1e-6f), step_length = sqrtf(length) / main;
    for (int step = first; (float)step < main && sum <= most; ++step) {
        int at[3];
        bool inside = true;
        for (int k = 0; k < 3; ++k) {
            at[k] = (int)floorf((float)cell[k] + 0.5f + (float)step * way[k] / main);
            inside &= at[k] >= 0 && at[k] < n[k];
        }
        if (!inside) break;
        int slot = state->slot[(at[2] * n[1] + at[1]) * n[0] + at[0]];
        if (slot >= 0 && slot < state->filled)
            sum += (step ? 1 : 0.5f) * step_length *
                   state->depth[(size_t)slot * ORDINATES + (size_t)ordinate];
    }
    return sum;
}

// The share of light l's colour that the mesh in a cell receives from it.
static float find_received(const CellFill *fill, int slot, const int cell[3], int l)
{
    const LightGridState *state = fill->state;
    const LightLattice *lattice = &state->field.lattice;
    const DrawParams *draw = fill->scene->draw;
    float place[3], x[3] = {0}, to_light[3], way[3], n[3];
    for (int k = 0; k < 3; ++k)
        place[k] = lattice->low[k] + ((float)cell[k] + 0.5f) * lattice->side;
    for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 3; ++i) x[i] += lattice->turn[k][i] * place[k];
    float share = fminf(light_field_light(draw, l, x, to_light), CELL_LAMP_MOST);
    light_lattice_turn(lattice, to_light, way);
    light_field_normal(&state->field, cell, n);
    share *= cell_facing(n[0], n[1], n[2], way[0], way[1], way[2]);
    if (share > 0) share *= find_passed(fill, slot, l);
    if (!(share > 0)) return 0;
    float reach = 1e6f;
    if (draw->light_place[l][3] != 0) {
        float square = 0;
        for (int k = 0; k < 3; ++k) square += powf(draw->light_place[l][k] - x[k], 2);
        reach = sqrtf(square) / lattice->side;
    }
    for (int k = 0; k < 3; ++k) way[k] *= reach;
    return share * cell_left(light_grid_behind(state, cell, way,
                                               light_field_nearest(lattice, to_light), 0, 40));
}

// The light that the mesh in a cell reflects after it has come directly from the lights; the light
// that it reflects after a scattering is found by light_grid_scatter.
SIMD_INLINE void fill_glows(const CellFill *fill, int part)
{
    const LightGridState *state = fill->state;
    const DrawParams *draw = fill->scene->draw;
    int first = (int)((int64_t)state->active * part / state->parts),
        end = (int)((int64_t)state->active * (part + 1) / state->parts);
    for (int slot = first; slot < end; ++slot) {
        float *glow = state->glow + 3 * (size_t)slot;
        int cell[3];
        grid_place(state, slot, cell);
        memset(glow, 0, 3 * sizeof *glow);
        if (!light_field_is_beside_mesh(&state->field, cell)) continue;
        for (int l = 0; l < state->field.lights; ++l) {
            float share = find_received(fill, slot, cell, l);
            for (int c = 0; c < 3; ++c)
                glow[c] += share * draw->light_color[l][c] * draw->mesh_color[c];
        }
    }
}

SIMD_STAGE(fill_glows, CellFill)

bool light_grid_fill_cells(LightGridState *state, const GridScene *scene)
{
    CellFill fill = {.state = state, .scene = scene};
    fill.sums = calloc((size_t)state->parts, sizeof *fill.sums);
    if (!fill.sums) return false;
    for (int l = 0; l < state->field.lights && scene->blocks; ++l)
        light_path_find(&fill.paths[l], &state->field.lattice, state->field.to_light[l]);
    run_fill_cells(&fill, state->parts);
    run_fill_glows(&fill, state->parts);
    free(fill.sums);
    return true;
}
