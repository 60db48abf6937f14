// SPDX-License-Identifier: MIT
// Where the cells of a light grid lie, and its lights.
#include "lanes/light_grid_tile.h"

#include <math.h>
#include <string.h>

enum { BOX = LIGHT_GRID_BOX };

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

void light_grid_light(const DrawParams *draw, int i, const float x[3], float way[3], float color[3])
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

typedef struct FindBox {
    const LightGridState *state;
    const GridScene *scene;
    float (*box)[BOX]; // [parts]
} FindBox;

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

SIMD_INLINE void find_box(const FindBox *find, int part)
{
    float box[BOX][W], points[2][3][W] = {{{0}}}, *whole = find->box[part];
    int range[2];
    for (int k = 0; k < BOX; ++k)
        for (int i = 0; i < W; ++i) box[k][i] = k < 3 ? 1e30f : k < 6 ? -1e30f : 0;
    for (uint32_t h = 0; h < find->scene->hair_count; ++h) {
        const GridHair *hair = &find->scene->hair[h];
        tile_range(hair, part, find->state->parts, range);
        for (int tile = range[0]; tile < range[1]; ++tile)
            for (int j = 0; j < (int)hair->caster.material.vertex_count; ++j) {
                turn_points(&find->state->lattice, tile_points(hair, tile, j), points[j % 2]);
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

SIMD_STAGE(find_box, FindBox)

void light_grid_find_turn(LightGridState *state, const GridScene *scene)
{
    static const float SIDEWAYS[3] = {0, 0, 0};
    const float light[3] = {ORDINATE[0][ORDINATE_OF_LIGHT], ORDINATE[1][ORDINATE_OF_LIGHT],
                            ORDINATE[2][ORDINATE_OF_LIGHT]};
    float way[3] = {-light[0], -light[1], -light[2]}, unused[3];
    // Of a lamp the way from the origin will do: only that it is steady matters.
    if (scene->draw->light_count) light_grid_light(scene->draw, 0, SIDEWAYS, way, unused);
    const float down[3] = {-way[0], -way[1], -way[2]};
    find_turn(down, light, state->lattice.turn);
}

bool light_grid_set_box(LightGridState *state, int cells, const float box[BOX])
{
    LightLattice *lattice = &state->lattice;
    if (!(box[0] <= box[3])) return false;
    float extent = 1e-6f;
    for (int k = 0; k < 3; ++k) extent = fmaxf(extent, box[k + 3] - box[k]);
    lattice->side = exp2f(ceilf(8 * log2f(extent)) / 8) / (float)cells;
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

bool light_grid_find_lattice(LightGridState *state, const GridScene *scene)
{
    float boxes[PARALLEL_MOST][BOX], box[BOX];
    light_grid_find_turn(state, scene);
    FindBox find = {.state = state, .scene = scene, .box = boxes};
    run_find_box(&find, state->parts);
    memcpy(box, boxes[0], sizeof box);
    for (int part = 1; part < state->parts; ++part)
        for (int k = 0; k < BOX; ++k)
            box[k] = k < 3 ? fminf(box[k], boxes[part][k]) : fmaxf(box[k], boxes[part][k]);
    return light_grid_set_box(state, scene->cells, box);
}

void light_grid_find_lights(LightGridState *state, const GridScene *scene)
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
        light_grid_light(scene->draw, l, middle, way, unused);
        light_lattice_turn(lattice, way, state->to_light[l]);
    }
}
