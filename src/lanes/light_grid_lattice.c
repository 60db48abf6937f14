// SPDX-License-Identifier: MIT
// Finds the box of hair, which the cells of a light grid fill. It is the box of all strands, even
// if some of them represent all in the cells: otherwise a single long strand would decide where the
// cells lie, and the light would change with the choice of strands.
#include "lanes/light_grid_tile.h"

#include <math.h>
#include <string.h>

enum { BOX = LIGHT_BOX_WORDS };

typedef struct FindBox {
    const LightGridState *state;
    const GridScene *scene;
    float (*box)[BOX]; // [parts]
} FindBox;

// Widens the box by points within reach. Other positions are broken; they are replaced by NaN,
// which min and max ignore.
SIMD_INLINE void widen(float box[BOX][W], float own[3][W], const float before[3][W], bool first)
{
    float square[W];
    for (int i = 0; i < W; ++i) {
        bool sound =
            (fabsf(own[0][i]) < 1e6f) & (fabsf(own[1][i]) < 1e6f) & (fabsf(own[2][i]) < 1e6f);
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
    GridStrands strands;
    int range[2];
    for (int k = 0; k < BOX; ++k)
        for (int i = 0; i < W; ++i) box[k][i] = k < 3 ? 1e30f : k < 6 ? -1e30f : 0;
    for (uint32_t h = 0; h < find->scene->hair_count; ++h) {
        const GridHair *hair = &find->scene->hair[h];
        grid_turn_range(hair, 1, part, find->state->parts, range);
        for (int turn = range[0]; turn < range[1]; ++turn) {
            grid_open_strands(hair, 1, turn, &strands);
            for (int j = 0; j < (int)hair->caster.material.vertex_count; ++j) {
                grid_turn_points(&find->state->field.lattice, &strands, j, points[j % 2]);
                widen(box, points[j % 2], (const float(*)[W])points[(j + 1) % 2], j == 0);
            }
        }
    }
    for (int k = 0; k < BOX; ++k) {
        whole[k] = box[k][0];
        for (int i = 1; i < W; ++i)
            whole[k] = k < 3 ? simd_min(box[k][i], whole[k]) : simd_max(box[k][i], whole[k]);
    }
}

SIMD_STAGE(find_box, FindBox)

bool light_grid_find_lattice(LightGridState *state, const GridScene *scene)
{
    float boxes[PARALLEL_MOST][BOX], box[BOX];
    light_field_find_turn(&state->field, scene);
    FindBox find = {.state = state, .scene = scene, .box = boxes};
    run_find_box(&find, state->parts);
    memcpy(box, boxes[0], sizeof box);
    for (int part = 1; part < state->parts; ++part)
        for (int k = 0; k < BOX; ++k)
            box[k] = k < 3 ? fminf(box[k], boxes[part][k]) : fmaxf(box[k], boxes[part][k]);
    return light_field_set_box(&state->field, scene->cells, box);
}
