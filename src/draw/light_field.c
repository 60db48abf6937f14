// SPDX-License-Identifier: MIT
#include "draw/light_field.h"

#include "glsl/kernel/lamp.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BOX = LIGHT_BOX_WORDS };

// Rows of the rotation by the smallest angle that turns `from` into `to` (unit vectors).
static void find_turn(const float from[3], const float to[3], float turn[3][3])
{
    double v[3] = {(double)from[1] * to[2] - (double)from[2] * to[1],
                   (double)from[2] * to[0] - (double)from[0] * to[2],
                   (double)from[0] * to[1] - (double)from[1] * to[0]},
           c = (double)from[0] * to[0] + (double)from[1] * to[1] + (double)from[2] * to[2];
    if (c < -0.999999) { // rotate by 180 degrees about an axis perpendicular to `from`
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

float light_field_light(const DrawParams *draw, int i, const float x[3], float way[3])
{
    const float *place = draw->light_place[i], *axis = draw->light_axis[i],
                *cone = draw->light_cone[i];
    float square = 0, cosine = 0;
    for (int k = 0; k < 3; ++k) {
        way[k] = place[k] - place[3] * x[k];
        square += way[k] * way[k];
    }
    square = fmaxf(square, LAMP_NEAREST);
    for (int k = 0; k < 3; ++k) {
        way[k] /= sqrtf(square);
        cosine += axis[k] * way[k];
    }
    return lamp_share(place[3], square, axis[3], cone[0], cone[1], cosine);
}

void light_field_find_turn(LightField *field, const GridScene *scene)
{
    static const float SIDEWAYS[3] = {0, 0, 0};
    const float light[3] = {ORDINATE[0][ORDINATE_OF_LIGHT], ORDINATE[1][ORDINATE_OF_LIGHT],
                            ORDINATE[2][ORDINATE_OF_LIGHT]};
    float way[3] = {-light[0], -light[1], -light[2]};
    // For a lamp, the direction from the origin is good enough: the lattice only needs a direction
    // that stays the same.
    if (scene->draw->light_count) light_field_light(scene->draw, 0, SIDEWAYS, way);
    const float down[3] = {-way[0], -way[1], -way[2]};
    find_turn(down, light, field->lattice.turn);
}

bool light_field_set_box(LightField *field, int cells, const float box[BOX])
{
    LightLattice *lattice = &field->lattice;
    if (!(box[0] <= box[3])) return false;
    float extent = 1e-6f;
    for (int k = 0; k < 3; ++k) extent = fmaxf(extent, box[k + 3] - box[k]);
    lattice->side = exp2f(ceilf(8 * log2f(extent)) / 8) / (float)cells;
    for (int k = 0; k < 3; ++k) {
        float first = floorf(box[k] / lattice->side);
        lattice->low[k] = first * lattice->side;
        lattice->count[k] = (int)(floorf(box[k + 3] / lattice->side) - first) + 1;
    }
    field->longest = sqrtf(box[6]);
    float pieces = ceilf(field->longest / (0.75f * lattice->side));
    field->pieces = (int)fminf(fmaxf(pieces, 1), 8);
    return true;
}

// From above (+y of the world) comes the sky, from below the ground, evenly between them; or an
// environment's light, as bright in the mean as both.
static void find_around(LightField *field, const GridScene *scene)
{
    enum { LANES = ORDINATE_LANES };
    const DrawParams *draw = scene->draw;
    float way[ORDINATES][3], light[ORDINATES][3], mean[3] = {0};
    bool uneven = draw->around[0][3] > 0;
    for (int d = 0; d < ORDINATES; ++d)
        for (int n = 0; n < 3; ++n) {
            way[d][n] = 0;
            for (int k = 0; k < 3; ++k) way[d][n] -= field->lattice.turn[k][n] * ORDINATE[k][d];
        }
    if (uneven)
        environment_spread(scene->ambient->environment, &scene->ambient->axes,
                           (const float(*)[3])way, ORDINATES, light);
    for (int d = 0; d < ORDINATES && uneven; ++d)
        for (int c = 0; c < 3; ++c) mean[c] += light[d][c] / ORDINATES;
    for (int d = 0; d < ORDINATES; ++d)
        for (int c = 0; c < 3; ++c)
            field->around[(d / LANES * 3 + c) * LANES + d % LANES] =
                uneven ? light[d][c] / fmaxf(mean[c], 1e-30f) *
                             lamp_around(draw->sky[c], draw->ground[c], 0)
                       : lamp_around(draw->sky[c], draw->ground[c], way[d][1]);
}

void light_field_find_lights(LightField *field, const GridScene *scene)
{
    const LightLattice *lattice = &field->lattice;
    float middle[3] = {0}, way[3];
    field->lights = scene->suns ? scene->draw->light_count : 0;
    field->tinted = false;
    find_around(field, scene);
    for (uint32_t h = 0; h < scene->hair_count; ++h)
        field->tinted |= scene->hair[h].caster.paint != NULL;
    for (int k = 0; k < 3; ++k)
        for (int n = 0; n < 3; ++n)
            middle[n] += lattice->turn[k][n] *
                         (lattice->low[k] + 0.5f * (float)lattice->count[k] * lattice->side);
    for (int l = 0; l < field->lights; ++l) {
        light_field_light(scene->draw, l, middle, way);
        light_lattice_turn(lattice, way, field->to_light[l]);
        field->to_light[l][3] = scene->draw->light_color[l][3];
    }
}

float light_field_strand(const LightField *field, const GridScene *scene)
{
    float most = 0;
    for (uint32_t h = 0; h < scene->hair_count; ++h) {
        const MaterialParams *m = &scene->hair[h].caster.material;
        float weight = (float)m->drawn_strands /
                       (float)cell_strands(m->drawn_strands, light_field_step(scene));
        most = fmaxf(most, 2 * m->radius * m->shadow_opacity * weight / field->lattice.side);
    }
    return most;
}

float light_field_opacity(const GridScene *scene)
{
    float least = 1;
    for (uint32_t h = 0; h < scene->hair_count; ++h) {
        const MaterialParams *m = &scene->hair[h].caster.material;
        least = fminf(least, m->opacity / fmaxf(m->shadow_opacity, 1e-6f));
    }
    return least;
}

int light_field_nearest(const LightLattice *lattice, const float to[3])
{
    float way[3], most = -2;
    int best = 0;
    light_lattice_turn(lattice, to, way);
    for (int d = 0; d < ORDINATES; ++d) {
        float cosine = ORDINATE[0][d] * way[0] + ORDINATE[1][d] * way[1] + ORDINATE[2][d] * way[2];
        if (cosine > most) most = cosine, best = d;
    }
    return best;
}

void light_field_normal(const LightField *field, const int cell[3], float normal[3])
{
    float square = 0;
    for (int k = 0; k < 3; ++k) {
        normal[k] = (float)light_field_lets_in(field, cell, 2 * k) -
                    (float)light_field_lets_in(field, cell, 2 * k + 1);
        square += normal[k] * normal[k];
    }
    for (int k = 0; k < 3 && square > 0; ++k) normal[k] /= sqrtf(square);
}

Result light_field_find_walls(LightField *field, const GridScene *scene, Error *error)
{
    const int *n = field->lattice.count;
    size_t cells = light_lattice_cells(&field->lattice), wide = (size_t)n[0] + 2,
           all = 3 * wide * ((size_t)n[1] + 2) * ((size_t)n[2] + 2);
    field->walled = scene->blocks != NULL;
    if (!field->walled) return RESULT_OK;
    // The blocks must be those of this lattice.
    TRY(light_blocks_find(scene->blocks, &field->lattice, error));
    if (field->wall_room < all) {
        free(field->walls);
        field->walls = malloc(all * sizeof *field->walls);
        field->wall_room = field->walls ? all : 0;
    }
    if (!field->walls) return error_set(error, RESULT_FAILED, "no memory for light among hair");
    for (size_t i = 0; i < all; ++i) field->walls[i] = 1;
    for (int axis = 0; axis < 3; ++axis) {
        float *out = (float *)light_field_walls(field, axis);
        const float *in = scene->blocks->open + (size_t)axis * cells;
        for (int z = 0; z < n[2]; ++z)
            for (int y = 0; y < n[1]; ++y, in += n[0])
                memcpy(out + ((size_t)z * ((size_t)n[1] + 2) + (size_t)y) * wide, in,
                       (size_t)n[0] * sizeof *in);
    }
    return RESULT_OK;
}

void light_field_destroy(LightField *field)
{
    for (int k = 0; k < LIGHT_GRID_KINDS; ++k) {
        free(field->kinds[k].scatter);
        free(field->kinds[k].first);
        free(field->kinds[k].gather);
        free(field->kinds[k].cone);
    }
    free(field->walls);
    *field = (LightField){0};
}
