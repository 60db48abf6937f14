// SPDX-License-Identifier: MIT
// Parts of segments of hair, sorted by the cells of a light grid that they lie in: so each cell is
// worked on by one thread, and adds them up in whole numbers, so that their order does not matter.
#include "lanes/light_grid_tile.h"

#include <math.h>
#include <string.h>

typedef struct Place {
    LightGridState *state;
    const GridScene *scene;
    bool emit; // items, not only how many there are
} Place;

// Of one segment of each strand of a tile.
typedef struct Segments {
    float a[3][W], b[3][W]; // its ends, along the lattice's axes, m
    float area[W];          // 2 r length times opacity over h^2, in steps
    uint32_t class[W];
    bool sound[W];
} Segments;

// One piece of each segment: its area, and what each light leaves of it, in steps.
typedef struct Pieces {
    float area[W];
    uint32_t lit[MAX_LIGHTS][W];
} Pieces;

SIMD_INLINE void find_areas(const GridHair *hair, const LightLattice *lattice, int tile, int j,
                            Segments *s)
{
    const MaterialParams *m = &hair->caster.material;
    const uint32_t(*paint)[4] = hair->caster.paint;
    float thinning = (1 - m->tip_ratio) / (float)(m->vertex_count - 1),
          share = 1 - thinning * ((float)j + 0.5f),
          unit = ITEM_STEPS / (lattice->side * lattice->side);
    size_t at = ((size_t)tile * m->vertex_count + (size_t)j) * W,
           root = (size_t)tile * m->vertex_count * W;
    for (int i = 0; i < W; ++i) {
        float x = s->b[0][i] - s->a[0][i], y = s->b[1][i] - s->a[1][i], z = s->b[2][i] - s->a[2][i];
        float length = sqrtf(x * x + y * y + z * z);
        s->area[i] = 2 * m->radius * share * length * m->shadow_opacity * unit;
        s->sound[i] = (length < 1e6f) & (length > 0);
    }
    if (paint)
        for (int i = 0; i < W; ++i) {
            float here = simd_float_of(paint[at + (size_t)i][2]),
                  there = simd_float_of(paint[at + W + (size_t)i][2]),
                  opacity = (float)(paint[root + (size_t)i][1] >> 16) / 65535;
            s->area[i] *= 0.5f * (here + there) / share * opacity;
        }
    int last = (int)m->last_strand - tile * W;
    if (last >= 0 && last < W) s->area[last] *= m->last_share;
}

static void find_classes(const GridHair *hair, int strands, Segments *s)
{
    for (int i = 0; i < strands; ++i) {
        float way[3];
        for (int k = 0; k < 3; ++k) way[k] = s->b[k][i] - s->a[k][i];
        s->class[i] = (uint32_t)(hair->kind * TANGENTS + (s->sound[i] ? ordinates_class(way) : 0));
    }
}

// Cell of a place between the ends; -1 beside the lattice, which only broken positions are.
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

// What light l leaves at places between particles j and j + 1 of a tile's strands.
SIMD_INLINE void find_left(const GridScene *scene, const GridHair *hair, int l, int tile, int j,
                           float on, float out[W])
{
    int map = scene->map_of[l];
    for (int i = 0; i < W; ++i) out[i] = 1;
    if (map < 0) return;
    size_t parts = hair->caster.material.smooth_parts,
           points = (hair->caster.material.vertex_count - 1) * parts + 1,
           at = (size_t)map * hair->points + ((size_t)tile * points + (size_t)j * parts) * W;
    const float *left = hair->left + at, *next = left + parts * W;
    for (int i = 0; i < W; ++i) out[i] = left[i] + on * (next[i] - left[i]);
}

// By signed conversions, which all vectors have: what is large is even.
SIMD_INLINE uint32_t steps_of(float x)
{
    float steps = simd_min(simd_max(x, 0) + 0.5f, 4e9f);
    int large = steps >= 0x1p30f;
    return (uint32_t)(int)(steps * (large ? 0.5f : 1.f)) << large;
}

static float find_lamp(const GridScene *scene, const LightLattice *lattice, int l,
                       const Segments *s, float on, int i)
{
    const float *color = scene->draw->light_color[l];
    float x[3] = {0}, way[3], there[3];
    if (scene->draw->light_place[l][3] == 0) return 1;
    for (int k = 0; k < 3; ++k) {
        float place = s->a[k][i] + on * (s->b[k][i] - s->a[k][i]);
        for (int n = 0; n < 3; ++n) x[n] += lattice->turn[k][n] * place;
    }
    light_grid_light(scene->draw, l, x, way, there);
    float most = fmaxf(fmaxf(color[0], color[1]), color[2]);
    return most > 0 ? fminf(fmaxf(fmaxf(there[0], there[1]), there[2]) / most, 1e3f) : 0;
}

// Of a painted particle the area times the albedo over the kind's.
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

// What each light leaves of one piece's areas, in steps.
SIMD_INLINE void find_lit(const Place *all, const GridHair *hair, const Segments *s, int tile,
                          int j, float on, Pieces *pieces)
{
    const LightGridState *state = all->state;
    for (int i = 0; i < W; ++i) pieces->area[i] = s->area[i] / (float)state->pieces;
    for (int l = 0; l < state->lights; ++l) {
        float lit[W];
        find_left(all->scene, hair, l, tile, j, on, lit);
        for (int i = 0; i < W; ++i) lit[i] *= pieces->area[i];
        if (all->scene->draw->light_place[l][3] != 0)
            for (int i = 0; i < W; ++i)
                lit[i] *= find_lamp(all->scene, &state->lattice, l, s, on, i);
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
    for (int l = 0; l < state->lights; ++l) item->lit[l] = pieces->lit[l][i];
    if (state->tinted) put_tint(hair, particle, pieces->area[i], item->lit + state->lights);
}

SIMD_INLINE void place_segments(const Place *all, const GridHair *hair, int tile, int j,
                                Segments *s, uint32_t *counts)
{
    const LightLattice *lattice = &all->state->lattice;
    int strands = tile_strands(hair, tile), pieces = all->state->pieces, cells[W];
    size_t at = ((size_t)tile * hair->caster.material.vertex_count + (size_t)j) * W;
    Pieces piece_of;
    find_areas(hair, lattice, tile, j, s);
    if (all->emit) find_classes(hair, strands, s);
    for (int piece = 0; piece < pieces; ++piece) {
        float on = ((float)piece + 0.5f) / (float)pieces;
        for (int i = 0; i < W; ++i) cells[i] = find_cell(lattice, s, on, i);
        if (all->emit) find_lit(all, hair, s, tile, j, on, &piece_of);
        for (int i = 0; i < strands; ++i) {
            if (!s->sound[i]) continue;
            if (all->emit)
                put_item(all, hair, s, &piece_of, at + (size_t)i, i, counts[cells[i]]++);
            else
                ++counts[cells[i]];
        }
    }
}

SIMD_INLINE void place(const Place *all, int part)
{
    LightGridState *state = all->state;
    uint32_t *counts = state->first_item + (size_t)part * light_lattice_cells(&state->lattice);
    int range[2];
    Segments s;
    for (uint32_t h = 0; h < all->scene->hair_count; ++h) {
        const GridHair *hair = &all->scene->hair[h];
        tile_range(hair, part, state->parts, range);
        for (int turn = range[0]; turn < range[1]; ++turn) {
            int tile = (int)mapped_caster_tile(&hair->caster, turn);
            turn_points(&state->lattice, tile_points(hair, tile, 0), s.b);
            for (int j = 0; j + 1 < (int)hair->caster.material.vertex_count; ++j) {
                memcpy(s.a, s.b, sizeof s.a);
                turn_points(&state->lattice, tile_points(hair, tile, j + 1), s.b);
                place_segments(all, hair, tile, j, &s, counts);
            }
        }
    }
}

SIMD_STAGE(place, Place)

void light_grid_place(LightGridState *state, const GridScene *scene, bool emit)
{
    run_place(&(Place){state, scene, emit}, state->parts);
}
