// SPDX-License-Identifier: MIT
// Where hair lies among the cells of a light grid, what it takes from each direction, and what the
// lights leave in it. Parts of segments are sorted by cells, so that each cell is worked on by one
// thread, and added up in whole numbers, so that their order does not matter.
#include "draw/light_grid_state.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    W = STRAND_TILE,
    BOX = 7, // lowest place, highest, square of the longest segment
};

#define ITEM_STEPS 65536.0f
enum { KEPT_ITEM_BYTES = 32 << 20 };

// --- The lattice.

// Rows of the rotation by the smallest angle that turns `from` into `to` (unit).
static void find_turn(const float from[3], const float to[3], float turn[3][3])
{
    double v[3] = {(double)from[1] * to[2] - (double)from[2] * to[1],
                   (double)from[2] * to[0] - (double)from[0] * to[2],
                   (double)from[0] * to[1] - (double)from[1] * to[0]},
           c = (double)from[0] * to[0] + (double)from[1] * to[1] + (double)from[2] * to[2];
    if (c < -0.999999) { // half a turn about an axis square to `from`
        double axis[3] = {-(double)from[1], (double)from[0], 0}, length = hypot(axis[0], axis[1]);
        if (length < 1e-6) axis[0] = 1, length = 1;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                turn[i][j] = (float)(2 * axis[i] * axis[j] / (length * length) - (i == j));
        return;
    }
    double cross[3][3] = {{0, -v[2], v[1]}, {v[2], 0, -v[0]}, {-v[1], v[0], 0}};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            double square = 0;
            for (int k = 0; k < 3; ++k) square += cross[i][k] * cross[k][j];
            turn[i][j] = (float)((i == j) + cross[i][j] + square / (1 + c));
        }
}

// The way to light i at x (world), and its light there, as light_sent of lights.glsl.
static void find_light(const DrawParams *draw, int i, const float x[3], float way[3],
                       float color[3])
{
    const float *place = draw->light_place[i], *axis = draw->light_axis[i],
                *cone = draw->light_cone[i];
    float square = 0, cosine = 0;
    for (int k = 0; k < 3; ++k) {
        way[k] = place[k] - place[3] * x[k];
        square += way[k] * way[k];
    }
    square = fmaxf(square, 1e-12f);
    for (int k = 0; k < 3; ++k) {
        way[k] /= sqrtf(square);
        cosine += axis[k] * way[k];
    }
    float inside = fminf(fmaxf(cone[0] - cone[1] * cosine, 0), 1),
          sent = place[3] == 0 ? 1 : fminf(axis[3] / square, 1e6f) * inside * inside;
    for (int k = 0; k < 3; ++k) color[k] = draw->light_color[i][k] * sent;
}

typedef struct Fill {
    LightGridState *state;
    const GridScene *scene;
    float (*box)[BOX]; // [parts]: lowest, highest, longest segment squared
    bool emit;
} Fill;

SIMD_INLINE void turn_points(const LightLattice *lattice, const float (*x)[4], float out[3][W])
{
    for (int k = 0; k < 3; ++k) {
        float a = lattice->turn[k][0], b = lattice->turn[k][1], c = lattice->turn[k][2];
        for (int i = 0; i < W; ++i) out[k][i] = a * x[i][0] + b * x[i][1] + c * x[i][2];
    }
}

static void tile_range(const GridHair *hair, int part, int parts, int range[2])
{
    int64_t tiles = ((int64_t)hair->caster.material.drawn_strands + W - 1) / W;
    range[0] = (int)(tiles * part / parts);
    range[1] = (int)(tiles * (part + 1) / parts);
}

static const float (*tile_points(const GridHair *hair, int tile, int j))[4]
{
    return hair->caster.position +
           ((size_t)tile * hair->caster.material.vertex_count + (size_t)j) * W;
}

static int tile_strands(const GridHair *hair, int tile)
{
    int left = (int)hair->caster.material.drawn_strands - tile * W;
    return left < W ? left : W;
}

// Of what is within reach only: other positions are broken, and none of them a number here, which
// no comparison takes.
SIMD_INLINE void widen(float box[BOX][W], float own[3][W], const float before[3][W], int strands,
                       bool first)
{
    float square[W];
    for (int i = 0; i < W; ++i) {
        bool sound = (i < strands) & (fabsf(own[0][i]) < 1e6f) & (fabsf(own[1][i]) < 1e6f) &
                     (fabsf(own[2][i]) < 1e6f);
        for (int k = 0; k < 3; ++k) own[k][i] = sound ? own[k][i] : NAN;
        square[i] = 0;
    }
    for (int k = 0; k < 3; ++k)
        for (int i = 0; i < W; ++i) {
            box[k][i] = simd_min(own[k][i], box[k][i]);
            box[k + 3][i] = simd_max(own[k][i], box[k + 3][i]);
            float way = own[k][i] - before[k][i];
            square[i] += way * way;
        }
    for (int i = 0; i < W && !first; ++i) box[6][i] = simd_max(square[i], box[6][i]);
}

SIMD_INLINE void find_box(const Fill *fill, int part)
{
    float box[BOX][W], points[2][3][W] = {{{0}}}, *whole = fill->box[part];
    int range[2];
    for (int k = 0; k < BOX; ++k)
        for (int i = 0; i < W; ++i) box[k][i] = k < 3 ? 1e30f : k < 6 ? -1e30f : 0;
    for (uint32_t h = 0; h < fill->scene->hair_count; ++h) {
        const GridHair *hair = &fill->scene->hair[h];
        tile_range(hair, part, fill->state->parts, range);
        for (int tile = range[0]; tile < range[1]; ++tile)
            for (int j = 0; j < (int)hair->caster.material.vertex_count; ++j) {
                turn_points(&fill->state->lattice, tile_points(hair, tile, j), points[j % 2]);
                widen(box, points[j % 2], (const float(*)[W])points[(j + 1) % 2],
                      tile_strands(hair, tile), j == 0);
            }
    }
    for (int k = 0; k < BOX; ++k) {
        whole[k] = box[k][0];
        for (int i = 1; i < W; ++i)
            whole[k] = k < 3 ? simd_min(box[k][i], whole[k]) : simd_max(box[k][i], whole[k]);
    }
}

SIMD_STAGE(find_box, Fill)

// False if there is no hair. The lattice's steps change in eighths of octaves, its corner by whole
// cells, so that light does not swim with every frame.
static bool find_lattice(LightGridState *state, const GridScene *scene)
{
    static const float SIDEWAYS[3] = {0, 0, 0};
    float boxes[PARALLEL_MOST][BOX], box[BOX], unused[3];
    LightLattice *lattice = &state->lattice;
    const float light[3] = {ORDINATE[0][ORDINATE_OF_LIGHT], ORDINATE[1][ORDINATE_OF_LIGHT],
                            ORDINATE[2][ORDINATE_OF_LIGHT]};
    float way[3] = {-light[0], -light[1], -light[2]};
    // Of a lamp the way from the origin will do: only that it is steady matters.
    if (scene->draw->light_count) find_light(scene->draw, 0, SIDEWAYS, way, unused);
    const float down[3] = {-way[0], -way[1], -way[2]};
    find_turn(down, light, lattice->turn);
    Fill fill = {.state = state, .scene = scene, .box = boxes};
    run_find_box(&fill, state->parts);
    memcpy(box, boxes[0], sizeof box);
    for (int part = 1; part < state->parts; ++part)
        for (int k = 0; k < BOX; ++k)
            box[k] = k < 3 ? fminf(box[k], boxes[part][k]) : fmaxf(box[k], boxes[part][k]);
    if (box[0] > box[3]) return false;
    float extent = 1e-6f;
    for (int k = 0; k < 3; ++k) extent = fmaxf(extent, box[k + 3] - box[k]);
    lattice->side = exp2f(ceilf(8 * log2f(extent)) / 8) / (float)scene->cells;
    for (int k = 0; k < 3; ++k) {
        float first = floorf(box[k] / lattice->side);
        lattice->low[k] = first * lattice->side;
        lattice->count[k] = (int)(floorf(box[k + 3] / lattice->side) - first) + 1;
    }
    state->longest = sqrtf(box[6]);
    float pieces = ceilf(state->longest / (0.75f * lattice->side));
    state->pieces = (int)fminf(fmaxf(pieces, 1), 8);
    return true;
}

// --- Parts of segments.

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
    find_light(scene->draw, l, x, way, there);
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
SIMD_INLINE void find_lit(const Fill *fill, const GridHair *hair, const Segments *s, int tile,
                          int j, float on, Pieces *pieces)
{
    const LightGridState *state = fill->state;
    for (int i = 0; i < W; ++i) pieces->area[i] = s->area[i] / (float)state->pieces;
    for (int l = 0; l < state->lights; ++l) {
        float lit[W];
        find_left(fill->scene, hair, l, tile, j, on, lit);
        for (int i = 0; i < W; ++i) lit[i] *= pieces->area[i];
        if (fill->scene->draw->light_place[l][3] != 0)
            for (int i = 0; i < W; ++i)
                lit[i] *= find_lamp(fill->scene, &state->lattice, l, s, on, i);
        for (int i = 0; i < W; ++i) pieces->lit[l][i] = steps_of(lit[i]);
    }
}

SIMD_INLINE void put_item(const Fill *fill, const GridHair *hair, const Segments *s,
                          const Pieces *pieces, size_t particle, int i, uint32_t number)
{
    LightGridState *state = fill->state;
    GridItem *item =
        (GridItem *)(void *)(state->items + (size_t)number * (size_t)state->item_words);
    item->class = s->class[i];
    item->area = steps_of(pieces->area[i]);
    for (int l = 0; l < state->lights; ++l) item->lit[l] = pieces->lit[l][i];
    if (state->tinted) put_tint(hair, particle, pieces->area[i], item->lit + state->lights);
}

SIMD_INLINE void place_segments(const Fill *fill, const GridHair *hair, int tile, int j,
                                Segments *s, uint32_t *counts)
{
    const LightLattice *lattice = &fill->state->lattice;
    int strands = tile_strands(hair, tile), pieces = fill->state->pieces, cells[W];
    size_t at = ((size_t)tile * hair->caster.material.vertex_count + (size_t)j) * W;
    Pieces piece_of;
    find_areas(hair, lattice, tile, j, s);
    if (fill->emit) find_classes(hair, strands, s);
    for (int piece = 0; piece < pieces; ++piece) {
        float on = ((float)piece + 0.5f) / (float)pieces;
        for (int i = 0; i < W; ++i) cells[i] = find_cell(lattice, s, on, i);
        if (fill->emit) find_lit(fill, hair, s, tile, j, on, &piece_of);
        for (int i = 0; i < strands; ++i) {
            if (!s->sound[i]) continue;
            if (fill->emit)
                put_item(fill, hair, s, &piece_of, at + (size_t)i, i, counts[cells[i]]++);
            else
                ++counts[cells[i]];
        }
    }
}

SIMD_INLINE void place(const Fill *fill, int part)
{
    LightGridState *state = fill->state;
    uint32_t *counts = state->first_item + (size_t)part * light_lattice_cells(&state->lattice);
    int range[2];
    Segments s;
    for (uint32_t h = 0; h < fill->scene->hair_count; ++h) {
        const GridHair *hair = &fill->scene->hair[h];
        tile_range(hair, part, state->parts, range);
        for (int turn = range[0]; turn < range[1]; ++turn) {
            int tile = (int)mapped_caster_tile(&hair->caster, turn);
            turn_points(&state->lattice, tile_points(hair, tile, 0), s.b);
            for (int j = 0; j + 1 < (int)hair->caster.material.vertex_count; ++j) {
                memcpy(s.a, s.b, sizeof s.a);
                turn_points(&state->lattice, tile_points(hair, tile, j + 1), s.b);
                place_segments(fill, hair, tile, j, &s, counts);
            }
        }
    }
}

SIMD_STAGE(place, Fill)

// --- Memory.

static bool grow(void *array, size_t *room, size_t count, size_t size)
{
    void **mine = array;
    if (*room >= count) return true;
    free(*mine);
    *mine = malloc(count * size);
    *room = *mine ? count : 0;
    return *mine != NULL;
}

static bool grow_cells(LightGridState *state, size_t cells)
{
    size_t room[3] = {state->cell_room, state->cell_room, state->cell_room};
    bool good = grow(&state->slot, &room[0], cells, sizeof *state->slot) &&
                grow(&state->first_item, &room[1], (size_t)state->parts * cells,
                     sizeof *state->first_item) &&
                grow(&state->cell_of, &room[2], cells, sizeof *state->cell_of);
    state->cell_room = good ? room[0] : 0;
    return good;
}

static bool grow_slots(LightGridState *state)
{
    size_t filled = (size_t)state->filled, active = (size_t)state->active;
    size_t of[10];
    for (int i = 0; i < 10; ++i) of[i] = i < 5 || i == 9 ? state->filled_room : state->slot_room;
    filled += filled / 4, active += active / 4;
    if (state->filled_room >= (size_t)state->filled && state->slot_room >= (size_t)state->active)
        return true;
    bool good = grow(&state->depth, &of[0], filled, ORDINATES * sizeof(float)) &&
                grow(&state->passage, &of[1], filled, GRID_WIDE * sizeof(float)) &&
                grow(&state->source, &of[2], filled, GRID_WIDE * sizeof(float)) &&
                grow(&state->tint, &of[3], filled, 3 * sizeof(float)) &&
                grow(&state->glow, &of[9], filled, 3 * sizeof(float)) &&
                grow(&state->class, &of[4], filled, sizeof(int)) &&
                grow(&state->sum, &of[5], active, GRID_WIDE * sizeof(float)) &&
                grow(&state->order, &of[6], active, GRID_WIDE * sizeof(float)) &&
                grow(&state->light, &of[7], active, GRID_WIDE * sizeof(float)) &&
                grow(&state->hidden, &of[8], active, 4 * sizeof(float));
    state->filled_room = good ? of[0] : 0;
    state->slot_room = good ? of[6] : 0;
    return good;
}

// Items are read no more when cells are filled. Few are kept for the next image, since fresh memory
// costs more than it saves there; 1,000,000 strands of 16 vertices have 300 MB.
static void release_items(LightGridState *state)
{
    if (state->item_room * sizeof *state->items <= KEPT_ITEM_BYTES) return;
    free(state->items);
    state->items = NULL;
    state->item_room = 0;
}

// --- Cells.

// Items of each part and cell begin where those before end; cells with hair get slots, then those
// beside them, where points between cells look, too.
static void make_slots(LightGridState *state)
{
    const int *n = state->lattice.count;
    size_t cells = light_lattice_cells(&state->lattice);
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
        int c = state->cell_of[f], at[3] = {c % n[0], c / n[0] % n[1], c / (n[0] * n[1])};
        for (int q = 0; q < 27; ++q) {
            int x = at[0] + q % 3 - 1, y = at[1] + q / 3 % 3 - 1, z = at[2] + q / 9 - 1;
            if (x < 0 || y < 0 || z < 0 || x >= n[0] || y >= n[1] || z >= n[2]) continue;
            int other = (z * n[1] + y) * n[0] + x;
            if (state->slot[other] >= 0) continue;
            state->slot[other] = state->active;
            state->cell_of[state->active++] = other;
        }
    }
}

// What a cell's items come to.
typedef struct CellSum {
    uint64_t class[GRID_CLASSES][1 + MAX_LIGHTS]; // area, and what each light meets of it
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
        for (int l = 0; l < state->lights; ++l) class[1 + l] += item->lit[l];
        sum->whole += item->area;
        for (int k = 0; k < 3 && state->tinted; ++k) sum->tint[k] += item->lit[state->lights + k];
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

// Classes in their order, whatever thread met them first.
static void sort_classes(CellSum *sum)
{
    for (int u = 1; u < sum->count; ++u) {
        uint16_t class = sum->used[u];
        int to = u;
        for (; to > 0 && sum->used[to - 1] > class; --to) sum->used[to] = sum->used[to - 1];
        sum->used[to] = class;
    }
}

// The main tangent by power iteration on the sum of t t^T, on the side of most tips.
static int find_main_class(const CellSum *sum)
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
    LightPath paths[MAX_LIGHTS]; // of lights afar, where there is a mesh
} CellFill;

// The mesh's shadow on cell f from light l.
static float find_passed(const CellFill *fill, int f, int l)
{
    const LightGridState *state = fill->state;
    const LightLattice *lattice = &state->lattice;
    const GridScene *scene = fill->scene;
    const int *n = lattice->count;
    int c = state->cell_of[f], cell[3] = {c % n[0], c / n[0] % n[1], c / (n[0] * n[1])};
    float way[3], square = 0, lamp[3];
    if (!scene->blocks) return 1;
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

// k h, then first(d) / k = S without scattering, of one cell.
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
    for (int l = 0; l < state->lights; ++l) {
        float part[GRID_WIDE] = {0};
        for (int u = 0; u < sum->count && passed[l] > 0; ++u) {
            int class = sum->used[u];
            float w = (float)sum->class[class][1 + l] * (passed[l] / ITEM_STEPS);
            const float *first = state->kinds[class / TANGENTS].first[l][class % TANGENTS];
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

// A matt surface in a light of 1 that it is square to shows its colour; those in a cell lie any way
// towards the light, half as bright in the mean.
static void fill_glow(const LightGridState *state, const GridScene *scene, const CellSum *sum,
                      const float passed[MAX_LIGHTS], int f)
{
    float *glow = state->glow + 3 * (size_t)f;
    for (int c = 0; c < 3; ++c) glow[c] = 0;
    if (!scene->blocks) return;
    double area = 0;
    for (int u = 0; u < sum->count; ++u) area += (double)sum->class[sum->used[u]][0];
    for (int l = 0; l < state->lights && area > 0; ++l) {
        double lit = 0;
        for (int u = 0; u < sum->count; ++u) lit += (double)sum->class[sum->used[u]][1 + l];
        float share = 0.5f * (float)(lit / area) * passed[l];
        for (int c = 0; c < 3; ++c)
            glow[c] += share * scene->draw->light_color[l][c] * scene->draw->mesh_color[c];
    }
}

// Along a direction a cell is as long as its side over the direction's main component.
SIMD_INLINE void fill_passage(LightGridState *state, int f)
{
    const float *depth = state->depth + (size_t)f * ORDINATES;
    for (int g = 0; g < ORDINATE_GROUPS; ++g) {
        float *left = grid_passage(state, g, f), *mean = left + GRID_LANES;
        memcpy(mean + GRID_LANES, depth + g * GRID_LANES, GRID_LANES * sizeof *depth);
        for (int l = 0; l < GRID_LANES; ++l) {
            int d = g * GRID_LANES + l;
            float main = fabsf(ORDINATE[g / 2][d]), tau = depth[d] / main,
                  through = simd_exp2(-(float)LOG2E * simd_min(tau, 40));
            left[l] = through;
            mean[l] = tau > 1e-3f ? (1 - through) / tau : 1 - 0.5f * tau;
        }
    }
}

SIMD_INLINE void fill_cells(const CellFill *fill, int part)
{
    LightGridState *state = fill->state;
    size_t cells = light_lattice_cells(&state->lattice);
    CellSum *sum = &fill->sums[part];
    int first = (int)((int64_t)state->filled * part / state->parts),
        end = (int)((int64_t)state->filled * (part + 1) / state->parts);
    for (int f = first; f < end; ++f) {
        // Where the last part's items ended, and before where the cell's began.
        size_t c = (size_t)state->cell_of[f];
        uint32_t stop = state->first_item[(size_t)(state->parts - 1) * cells + c],
                 start = c ? state->first_item[(size_t)(state->parts - 1) * cells + c - 1] : 0;
        add_items(state, start, stop, sum);
        sort_classes(sum);
        fill_depths(sum, state->depth + (size_t)f * ORDINATES);
        for (int k = 0; k < 3; ++k)
            state->tint[3 * f + k] =
                state->tinted && sum->whole ? (float)sum->tint[k] / (float)sum->whole : 1;
        float passed[MAX_LIGHTS];
        for (int l = 0; l < state->lights; ++l) passed[l] = find_passed(fill, f, l);
        fill_source(state, fill->scene, sum, passed, f);
        fill_glow(state, fill->scene, sum, passed, f);
        state->class[f] = find_main_class(sum);
        fill_passage(state, f);
        clear_sum(sum);
    }
}

SIMD_STAGE(fill_cells, CellFill)

static void find_lights(LightGridState *state, const GridScene *scene)
{
    const LightLattice *lattice = &state->lattice;
    float middle[3] = {0}, way[3], unused[3];
    state->lights = scene->suns ? scene->draw->light_count : 0;
    state->tinted = false;
    memcpy(state->mesh_color, scene->draw->mesh_color, sizeof state->mesh_color);
    for (uint32_t h = 0; h < scene->hair_count; ++h)
        state->tinted |= scene->hair[h].caster.paint != NULL;
    state->item_words = 2 + state->lights + (state->tinted ? 3 : 0);
    for (int k = 0; k < 3; ++k)
        for (int n = 0; n < 3; ++n)
            middle[n] += lattice->turn[k][n] *
                         (lattice->low[k] + 0.5f * (float)lattice->count[k] * lattice->side);
    for (int l = 0; l < state->lights; ++l) {
        find_light(scene->draw, l, middle, way, unused);
        light_lattice_turn(lattice, way, state->to_light[l]);
    }
}

static Result fill_all(LightGridState *state, const GridScene *scene, Error *error)
{
    size_t cells = light_lattice_cells(&state->lattice);
    Result result = RESULT_OK;
    if (!grow_cells(state, cells)) return RESULT_FAILED;
    memset(state->first_item, 0, (size_t)state->parts * cells * sizeof *state->first_item);
    Fill fill = {.state = state, .scene = scene};
    run_place(&fill, state->parts);
    make_slots(state);
    if (!light_grid_find_walls(state, scene) || !light_grid_find_spans(state) ||
        !grow(&state->items, &state->item_room,
              (size_t)state->item_count * (size_t)state->item_words, sizeof *state->items) ||
        !grow_slots(state))
        return RESULT_FAILED;
    fill.emit = true;
    run_place(&fill, state->parts);
    THEN(result, light_grid_make_first(state, scene, error));
    if (result != RESULT_OK) return result;
    CellSum *sums = calloc((size_t)state->parts, sizeof *sums);
    if (!sums) return RESULT_FAILED;
    CellFill cell_fill = {.state = state, .scene = scene, .sums = sums};
    for (int l = 0; l < state->lights && scene->blocks; ++l)
        light_path_find(&cell_fill.paths[l], &state->lattice, state->to_light[l]);
    run_fill_cells(&cell_fill, state->parts);
    free(sums);
    release_items(state);
    return RESULT_OK;
}

bool light_grid_fill(LightGridState *state, const GridScene *scene, Error *error, Result *result)
{
    ordinates_prepare();
    *result = RESULT_OK;
    if (!find_lattice(state, scene)) return false;
    find_lights(state, scene);
    // The blocks' lattice must be this one.
    if (scene->blocks) {
        LightBlocks *blocks = (LightBlocks *)scene->blocks;
        *result = light_blocks_find(blocks, &state->lattice, error);
        if (*result != RESULT_OK) return false;
    }
    *result = fill_all(state, scene, error);
    if (*result == RESULT_FAILED)
        error_set(error, RESULT_FAILED, "no memory for light among hair: %d x %d x %d cells",
                  state->lattice.count[0], state->lattice.count[1], state->lattice.count[2]);
    return *result == RESULT_OK;
}
