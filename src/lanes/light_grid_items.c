// SPDX-License-Identifier: MIT
// Cuts segments of hair into parts and sorts these by the cell of a light grid that they lie in.
// Then one thread processes each cell and adds its parts up as integers, so the result does not
// depend on their order.
#include "lanes/light_grid_tile.h"
#include "lanes/shadow.h"

#include <math.h>
#include <string.h>

typedef struct Place {
    LightGridState *state;
    const GridScene *scene;
    bool emit; // false: only count items
} Place;

// One segment of each strand of a tile.
typedef struct Segments {
    float a[3][W], b[3][W]; // ends in the lattice's axes, m
    float area[W];          // 2 r length opacity / h^2, in steps
    uint32_t class[W];
    bool sound[W];
} Segments;

// The share of each light that reaches the segments' ends.
typedef struct Lefts {
    float at[2][MAX_LIGHTS][W]; // [end][map]
} Lefts;

// One part of each segment: its area, and the area that each light reaches, in steps.
typedef struct Pieces {
    float area[W];
    uint32_t lit[MAX_LIGHTS][W];
} Pieces;

SIMD_INLINE void find_areas(const Place *all, const GridStrands *strands, int j, Segments *s)
{
    const LightLattice *lattice = &all->state->field.lattice;
    const MaterialParams *m = &strands->hair->caster.material;
    const uint32_t(*paint)[4] = strands->hair->caster.paint;
    float thinning = (1 - m->tip_ratio) / (float)(m->vertex_count - 1),
          share = 1 - thinning * ((float)j + 0.5f),
          weight = (float)m->drawn_strands /
                   (float)cell_strands(m->drawn_strands, light_field_step(all->scene)),
          unit = weight * ITEM_STEPS / (lattice->side * lattice->side);
    for (int i = 0; i < W; ++i) {
        float x = s->b[0][i] - s->a[0][i], y = s->b[1][i] - s->a[1][i], z = s->b[2][i] - s->a[2][i];
        float length = sqrtf(x * x + y * y + z * z);
        s->area[i] = 2 * m->radius * share * length * m->shadow_opacity * unit;
        s->sound[i] = (length < 1e6f) & (length > 0);
    }
    if (paint)
        for (int i = 0; i < W; ++i) {
            size_t root = strands->root[i], at = root + (size_t)j * W;
            float here = simd_float_of(paint[at][2]), there = simd_float_of(paint[at + W][2]),
                  opacity = (float)(paint[root][1] >> 16) / 65535;
            s->area[i] *= 0.5f * (here + there) / share * opacity;
        }
    for (int i = 0; i < W; ++i)
        s->area[i] *= strands->number[i] == (int)m->last_strand ? m->last_share : 1;
}

static void find_classes(const GridHair *hair, int strands, Segments *s)
{
    for (int i = 0; i < strands; ++i) {
        float way[3];
        for (int k = 0; k < 3; ++k) way[k] = s->b[k][i] - s->a[k][i];
        s->class[i] = (uint32_t)(hair->kind * TANGENTS + (s->sound[i] ? ordinates_class(way) : 0));
    }
}

// The cell of a point between the ends; -1 outside the lattice, which only happens for broken
// positions.
SIMD_INLINE int find_cell(const LightLattice *lattice, const Segments *s, float on, int i)
{
    int at[3];
    float inverse = 1 / lattice->side;
    for (int k = 0; k < 3; ++k) {
        float x = s->a[k][i] + on * (s->b[k][i] - s->a[k][i]);
        float cell = (x - lattice->low[k]) * inverse;
        at[k] = (int)simd_min(simd_max(cell, 0), (float)(lattice->count[k] - 1));
    }
    return (at[2] * lattice->count[1] + at[1]) * lattice->count[0] + at[0];
}

// The share of each map's light that hair lets through to particle j, found on the curves if
// strands are curves. The mesh's share is found by find_passed (light_grid_cells.c).
SIMD_INLINE void find_left(const LaneShadow *shadow, const GridStrands *strands, int j,
                           float left[MAX_LIGHTS][W])
{
    const MappedCaster *caster = &strands->hair->caster;
    const MaterialParams *m = &caster->material;
    int last = (int)m->vertex_count - 1;
    float x[3][W], radius[W], opacity[W], share = 1 - (1 - m->tip_ratio) / (float)last * (float)j;
    grid_read_points(strands, j, x);
    if (m->smooth_parts > 1 && m->smooth_curve != CURVE_CATMULL_ROM && j > 0 && j < last) {
        float before[3][W], after[3][W];
        grid_read_points(strands, j - 1, before);
        grid_read_points(strands, j + 1, after);
        for (int k = 0; k < 3; ++k)
            for (int i = 0; i < W; ++i)
                x[k][i] = (before[k][i] + 4 * x[k][i] + after[k][i]) * (1.f / 6);
    }
    for (int i = 0; i < W; ++i) {
        radius[i] = m->radius * (strands->number[i] == (int)m->last_strand ? m->last_share : 1);
        opacity[i] = m->shadow_opacity;
    }
    for (int i = 0; i < W; ++i) {
        const uint32_t(*paint)[4] = caster->paint ? caster->paint + strands->root[i] : NULL;
        radius[i] *= paint ? simd_float_of(paint[(size_t)j * W][2]) : share;
        opacity[i] *= paint ? (float)(paint[0][1] >> 16) / 65535 : 1;
        radius[i] = simd_max(radius[i], 1e-9f);
    }
    for (int map = 0; map < shadow->params.maps; ++map) {
        ShadowLook look;
        shadow_look(shadow, map, (const float(*)[W])x, 0, &look);
        shadow_look_hair(shadow, map, &look, false, radius, opacity, left[map]);
    }
}

// Rounds to an integer through signed conversion, which all vector instruction sets have. Large
// values are rounded to even integers.
SIMD_INLINE uint32_t steps_of(float x)
{
    float steps = simd_min(simd_max(x, 0) + 0.5f, 4e9f);
    int large = steps >= 0x1p30f;
    return (uint32_t)(int)(steps * (large ? 0.5f : 1.f)) << large;
}

static float find_lamp(const GridScene *scene, const LightLattice *lattice, int l,
                       const Segments *s, float on, int i)
{
    float x[3] = {0}, way[3];
    if (scene->draw->light_place[l][3] == 0) return 1;
    for (int k = 0; k < 3; ++k) {
        float place = s->a[k][i] + on * (s->b[k][i] - s->a[k][i]);
        for (int n = 0; n < 3; ++n) x[n] += lattice->turn[k][n] * place;
    }
    return fminf(light_field_light(scene->draw, l, x, way), CELL_LAMP_MOST);
}

// For a painted particle: the area times its albedo over the kind's mean albedo.
static void put_tint(const GridHair *hair, size_t particle, float area, uint32_t tint[3])
{
    const MaterialParams *m = &hair->caster.material;
    for (int k = 0; k < 3; ++k) {
        float albedo = m->mean_albedo[k];
        if (hair->caster.paint) {
            uint32_t word = hair->caster.paint[particle][k / 2],
                     bits = k == 1 ? word >> 16 : word & 0xffff;
            albedo = m->albedo[0] + (1 - m->albedo[0]) * powf((float)bits / 65535, m->albedo[1]);
        }
        tint[k] = steps_of(area * albedo / fmaxf(m->mean_albedo[k], 1e-6f));
    }
}

// The area of a part that each light reaches, in steps.
SIMD_INLINE void find_lit(const Place *all, const Segments *s, const Lefts *left, int j, float on,
                          Pieces *pieces)
{
    const LightGridState *state = all->state;
    for (int i = 0; i < W; ++i) pieces->area[i] = s->area[i] / (float)state->field.pieces;
    for (int l = 0; l < state->field.lights; ++l) {
        float lit[W];
        int map = all->scene->map_of[l];
        const float *from = left->at[j % 2][map < 0 ? 0 : map],
                    *to = left->at[(j + 1) % 2][map < 0 ? 0 : map];
        for (int i = 0; i < W; ++i)
            lit[i] = pieces->area[i] * (map < 0 ? 1 : from[i] + on * (to[i] - from[i]));
        if (all->scene->draw->light_place[l][3] != 0)
            for (int i = 0; i < W; ++i)
                lit[i] *= find_lamp(all->scene, &state->field.lattice, l, s, on, i);
        for (int i = 0; i < W; ++i) pieces->lit[l][i] = steps_of(lit[i]);
    }
}

SIMD_INLINE void put_item(const Place *all, const GridHair *hair, const Segments *s,
                          const Pieces *pieces, size_t particle, int i, uint32_t number)
{
    LightGridState *state = all->state;
    GridItem *item =
        (GridItem *)(void *)(state->items + (size_t)number * (size_t)state->item_words);
    item->class = s->class[i];
    item->area = steps_of(pieces->area[i]);
    for (int l = 0; l < state->field.lights; ++l) item->lit[l] = pieces->lit[l][i];
    if (state->field.tinted)
        put_tint(hair, particle, pieces->area[i], item->lit + state->field.lights);
}

SIMD_INLINE void place_segments(const Place *all, const GridStrands *strands, int j, Segments *s,
                                const Lefts *left, uint32_t *counts)
{
    const LightLattice *lattice = &all->state->field.lattice;
    int pieces = all->state->field.pieces, cells[W];
    Pieces piece_of;
    find_areas(all, strands, j, s);
    if (all->emit) find_classes(strands->hair, strands->strands, s);
    for (int piece = 0; piece < pieces; ++piece) {
        float on = ((float)piece + 0.5f) / (float)pieces;
        for (int i = 0; i < W; ++i) cells[i] = find_cell(lattice, s, on, i);
        if (all->emit) find_lit(all, s, left, j, on, &piece_of);
        for (int i = 0; i < strands->strands; ++i) {
            if (!s->sound[i]) continue;
            if (all->emit)
                put_item(all, strands->hair, s, &piece_of, strands->root[i] + (size_t)j * W, i,
                         counts[cells[i]]++);
            else
                ++counts[cells[i]];
        }
    }
}

SIMD_INLINE void place(const Place *all, int part)
{
    LightGridState *state = all->state;
    uint32_t *counts =
        state->first_item + (size_t)part * light_lattice_cells(&state->field.lattice);
    GridStrands strands;
    int range[2];
    Segments s;
    Lefts left = {0};
    const LaneShadow *shadow = state->field.lights ? all->scene->shadow : NULL;
    uint step = light_field_step(all->scene);
    for (uint32_t h = 0; h < all->scene->hair_count; ++h) {
        const GridHair *hair = &all->scene->hair[h];
        grid_turn_range(hair, step, part, state->parts, range);
        for (int turn = range[0]; turn < range[1]; ++turn) {
            grid_open_strands(hair, step, turn, &strands);
            grid_turn_points(&state->field.lattice, &strands, 0, s.b);
            if (all->emit && shadow) find_left(shadow, &strands, 0, left.at[0]);
            for (int j = 0; j + 1 < (int)hair->caster.material.vertex_count; ++j) {
                memcpy(s.a, s.b, sizeof s.a);
                grid_turn_points(&state->field.lattice, &strands, j + 1, s.b);
                if (all->emit && shadow) find_left(shadow, &strands, j + 1, left.at[(j + 1) % 2]);
                place_segments(all, &strands, j, &s, &left, counts);
            }
        }
    }
}

SIMD_STAGE(place, Place)

void light_grid_place(LightGridState *state, const GridScene *scene, bool emit)
{
    run_place(&(Place){state, scene, emit}, state->parts);
}
