// SPDX-License-Identifier: MIT
#include "lanes/shadow_map.h"

#include "base/room.h"

#include "lanes/shadow_finish.h"
#include "lanes/shadow_splat.h"
#include "lanes/shadow_tile.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const size_t MOST_BYTES = (size_t)256 << 20; // of all threads' sums
// Segments to draw for which another thread pays. Drawing one to three maps takes about 0.15 us;
// clearing the sums of a map of 512 texels and adding them up takes 5 ms.
static const uint64_t SEGMENTS_EACH = 32768;

// The number of threads that draw: all, unless their maps would need too much memory.
static size_t count_parts(size_t map_bytes)
{
    size_t parts = (size_t)parallel_threads(), most = MOST_BYTES / map_bytes;
    return parts <= most ? parts : most ? most : 1;
}

static size_t map_bytes(const ShadowMap *shadow)
{
    size_t side = (size_t)shadow->side;
    return shadow->deep ? LAYERS * side * (size_t)shadow->wide * sizeof *shadow->sums
                        : side * side * sizeof *shadow->first;
}

Result shadow_map_create(ShadowMap *shadow, int side, bool deep, Error *error)
{
    *shadow = (ShadowMap){.side = side,
                          .wide = (side + 47) / 64 * 64 + 16,
                          .coarse = deep ? side / SHADOW_COARSE : side,
                          .tiles = (side + SHADOW_MAP_TILE - 1) / SHADOW_MAP_TILE,
                          .deep = deep,
                          .last = LAYER_END};
    shadow->parts = (int)count_parts(map_bytes(shadow));
    size_t parts = (size_t)shadow->parts, lines = parts * SHADOW_MAP_LINES * ((size_t)side + 2);
    if (!deep) return RESULT_OK;
    shadow->least = malloc(parts * 4 * ((size_t)shadow->coarse + 4) * sizeof *shadow->least);
    shadow->rows = malloc(lines * sizeof *shadow->rows);
    if (shadow->least && shadow->rows) return RESULT_OK;
    shadow_map_destroy(shadow);
    return error_set(error, RESULT_FAILED, "no memory for shadow maps of %d texels", side);
}

static void free_sums(ShadowMap *shadow)
{
    free(shadow->first);
    free(shadow->sums);
    shadow->first = NULL, shadow->sums = NULL;
    shadow->room = 0;
}

void shadow_map_destroy(ShadowMap *shadow)
{
    free_sums(shadow);
    free(shadow->least);
    free(shadow->rows);
    *shadow = (ShadowMap){0};
}

static uint64_t count_segments(MappedCasters casters)
{
    uint64_t segments = 0;
    for (uint32_t i = 0; i < casters.count; ++i) {
        const MaterialParams *material = &casters.list[i].material;
        segments +=
            (uint64_t)material->drawn_strands * material->vertex_count * material->smooth_parts;
    }
    return segments;
}

Result shadow_map_reserve(ShadowMap *shadow, int maps, MappedCasters casters, Error *error)
{
    uint64_t worth = count_segments(casters) / SEGMENTS_EACH, parts = (uint64_t)shadow->parts;
    uint64_t drawers = worth < 1 ? 1 : worth < parts ? worth : parts;
    uint64_t most = worth ? MOST_BYTES / (drawers * map_bytes(shadow)) : 1;
    shadow->drawers = (int)drawers;
    shadow->at_once = (uint64_t)maps < most ? maps : most ? (int)most : 1;
    size_t room = drawers * (size_t)shadow->at_once;
    if ((size_t)shadow->room >= room) return RESULT_OK;
    free_sums(shadow);
    shadow->first =
        room_new(room * (size_t)shadow->coarse * (size_t)shadow->coarse, sizeof *shadow->first);
    if (shadow->deep) shadow->sums = room_new(room, map_bytes(shadow));
    shadow->room = (int)room;
    if (shadow->first && (shadow->sums || !shadow->deep)) return RESULT_OK;
    free_sums(shadow);
    return error_set(error, RESULT_FAILED, "no memory for shadow maps of %d texels", shadow->side);
}

size_t shadow_map_layer_words(const ShadowMap *shadow)
{
    return (size_t)shadow->side * (size_t)shadow->tiles * LAYERS * SHADOW_MAP_TILE;
}

// --- Bounding boxes.

typedef struct Boxes {
    int parts, count;
    const CastParams *params; // [count]
    MappedCasters casters;
    float (*box)[MAX_LIGHTS][6]; // [parts]
} Boxes;

// Widens the box by points within reach. Other positions are broken.
SIMD_INLINE void widen_box(const CastParams *params, const Tile *tile, const float x[3][W],
                           float box[6][W])
{
    float limit = params->limit, reach = params->reach, place[3][W];
    Places p;
    project_points(params, x, &p);
    for (int k = 0; k < W; ++k) {
        bool sound = (k < tile->strands) & (fabsf(x[0][k]) < limit) & (fabsf(x[1][k]) < limit) &
                     (fabsf(x[2][k]) < limit) & (fabsf(p.u[k]) < reach) & (fabsf(p.v[k]) < reach);
        place[0][k] = sound ? p.u[k] : NAN; // min and max ignore NaN
        place[1][k] = sound ? p.v[k] : NAN;
        place[2][k] = sound ? p.z[k] : NAN;
    }
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < W; ++k) {
            box[i][k] = simd_min(place[i][k], box[i][k]);
            box[i + 3][k] = simd_max(place[i][k], box[i + 3][k]);
        }
}

SIMD_INLINE void find_boxes(const Boxes *boxes, int part)
{
    float box[MAX_LIGHTS][6][W], x[3][W];
    for (int b = 0; b < MAX_LIGHTS; ++b)
        for (int i = 0; i < 6; ++i)
            for (int k = 0; k < W; ++k) box[b][i][k] = i < 3 ? INFINITY : -INFINITY;
    for (uint32_t c = 0; c < boxes->casters.count; ++c) {
        const MappedCaster *caster = &boxes->casters.list[c];
        int range[2];
        find_range(caster, part, boxes->parts, range);
        for (int t = range[0]; t < range[1]; ++t) {
            Tile tile = open_tile_at(caster, (size_t)t);
            for (int j = 0; j < (int)caster->material.vertex_count; ++j) {
                const float(*from)[4] = caster->position + tile_particle(&tile, j);
                for (int i = 0; i < 3; ++i)
                    for (int k = 0; k < W; ++k) x[i][k] = from[k][i];
                for (int b = 0; b < boxes->count; ++b)
                    widen_box(&boxes->params[b], &tile, (const float(*)[W])x, box[b]);
            }
        }
    }
    for (int b = 0; b < boxes->count; ++b) {
        float *whole = boxes->box[part][b];
        for (int i = 0; i < 6; ++i) whole[i] = box[b][i][0];
        for (int k = 1; k < W; ++k)
            for (int i = 0; i < 3; ++i) {
                whole[i] = simd_min(box[b][i][k], whole[i]);
                whole[i + 3] = simd_max(box[b][i + 3][k], whole[i + 3]);
            }
    }
}

SIMD_STAGE(find_boxes, Boxes)

void shadow_map_find_boxes(const ShadowMap *shadow, const CastParams *params, int count,
                           MappedCasters casters, double (*out)[6])
{
    float found[PARALLEL_MOST][MAX_LIGHTS][6];
    Boxes boxes = {shadow->parts, count, params, casters, found};
    run_find_boxes(&boxes, shadow->parts);
    for (int b = 0; b < count; ++b)
        for (int i = 0; i < 6; ++i) {
            out[b][i] = (double)found[0][b][i];
            for (int part = 1; part < shadow->parts; ++part)
                out[b][i] = i < 3 ? fmin(out[b][i], (double)found[part][b][i])
                                  : fmax(out[b][i], (double)found[part][b][i]);
        }
}

// --- Whole maps.

// The parameters of a map of first depths, whose texels are `coarse` texels of the map wide.
static CastParams coarse_params(const CastParams *params, int coarse)
{
    CastParams wide = *params;
    wide.texels /= (float)coarse;
    for (int k = 0; k < 2; ++k)
        for (int i = 0; i < 4; ++i) wide.from_world[k][i] /= (float)coarse;
    return wide;
}

// Draws the maps that fit into memory at a time.
static void draw_some(ShadowMap *shadow, const CastParams *params, int maps, MappedCasters casters,
                      float *depths, uint32_t *layers)
{
    size_t texels = (size_t)shadow->side * (size_t)shadow->side,
           words = shadow_map_layer_words(shadow);
    CastParams wide[MAX_LIGHTS];
    ShadowSplat splat = {
        .shadow = shadow, .params = wide, .maps = maps, .casters = casters, .coarse = shadow->deep};
    for (int map = 0; map < maps; ++map)
        wide[map] = coarse_params(&params[map], shadow->deep ? SHADOW_COARSE : 1);
    shadow_splat_draw(&splat);
    for (size_t map = 0; map < (size_t)maps; ++map)
        (shadow->deep ? shadow_finish_spread : shadow_finish_firsts)(shadow, (int)map,
                                                                     depths + map * texels);
    if (!shadow->deep) return;
    splat.params = params;
    splat.depths = depths;
    shadow_splat_draw(&splat);
    for (size_t map = 0; map < (size_t)maps; ++map)
        shadow_finish_layers(shadow, (int)map, params[map].unit, layers + map * words);
}

void shadow_map_draw(ShadowMap *shadow, const CastParams *params, int maps, MappedCasters casters,
                     float *depths, uint32_t *layers)
{
    size_t texels = (size_t)shadow->side * (size_t)shadow->side,
           words = shadow_map_layer_words(shadow);
    for (int map = 0; map < maps; map += shadow->at_once) {
        int count = maps - map < shadow->at_once ? maps - map : shadow->at_once;
        draw_some(shadow, params + map, count, casters, depths + (size_t)map * texels,
                  layers ? layers + (size_t)map * words : NULL);
    }
}
