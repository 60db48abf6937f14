// SPDX-License-Identifier: MIT
#include "lanes/shadow_points.h"

#include "base/room.h"

#include "lanes/shadow_tile.h"

#include <stdlib.h>

static const size_t MOST_BYTES = (size_t)192 << 20;

static size_t count_tiles(const MappedCaster *caster)
{
    return ((size_t)caster->material.drawn_strands + W - 1) / W;
}

static bool make_room(ShadowPoints *points, size_t count)
{
    if (count > MOST_BYTES / sizeof *points->all) {
        shadow_points_destroy(points);
        return false;
    }
    return room_make(&points->all, &points->room, count, sizeof *points->all);
}

typedef struct Finder {
    const MappedCaster *caster;
    float (*out)[3][W];
    int parts;
} Finder;

SIMD_INLINE void find_tile(const Tile *tile, float (*out)[3][W])
{
    const MaterialParams *material = &tile->caster->material;
    int parts = (int)material->smooth_parts, segments = (int)material->vertex_count - 1;
    CurveSegment segment;
    for (int j = 0; j < segments; ++j) {
        int end = j + 1 < segments ? parts : parts + 1;
        open_segment(tile, j, &segment);
        for (int k = 0; k < end; ++k)
            find_on_segment(&segment, material->smooth_curve != 0, (float)k / (float)parts,
                            out[j * parts + k]);
    }
}

SIMD_INLINE void find_tiles(const Finder *finder, int part)
{
    const MappedCaster *caster = finder->caster;
    size_t points = (size_t)mapped_caster_points(caster);
    float own[3][W];
    int range[2];
    find_range(caster, part, finder->parts, range);
    for (int t = range[0]; t < range[1]; ++t) {
        const Tile tile = {.caster = caster, .number = (size_t)t};
        float(*out)[3][W] = finder->out + (size_t)t * points;
        if (caster->material.smooth_parts > 1)
            find_tile(&tile, out);
        else
            for (size_t j = 0; j < points; ++j)
                memcpy(out[j], find_points(&tile, (int)j, own), sizeof own);
    }
}

SIMD_STAGE(find_tiles, Finder)

void shadow_points_find(ShadowPoints *points, MappedCaster *casters, uint32_t count, int parts)
{
    size_t sum = 0;
    for (uint32_t i = 0; i < count; ++i)
        sum += count_tiles(&casters[i]) * (size_t)mapped_caster_points(&casters[i]);
    if (!make_room(points, sum)) return;
    sum = 0;
    for (uint32_t i = 0; i < count; ++i) {
        Finder finder = {.caster = &casters[i], .out = points->all + sum, .parts = parts};
        run_find_tiles(&finder, parts);
        casters[i].points = (const float(*)[3][W])finder.out;
        sum += count_tiles(&casters[i]) * (size_t)mapped_caster_points(&casters[i]);
    }
}

void shadow_points_destroy(ShadowPoints *points)
{
    free(points->all);
    *points = (ShadowPoints){0};
}
