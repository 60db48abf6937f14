// SPDX-License-Identifier: MIT
#include "lanes/bins.h"

#include "base/room.h"

#include "glsl/common/shared_math.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct Binning {
    Bins *bins;
    const Projection *projection;
    uint64_t *pairs; // NULL in the first pass, which only counts
} Binning;

Result bins_create(Bins *bins, int columns, int rows, Error *error)
{
    *bins = (Bins){.columns = columns, .rows = rows, .part_room = parallel_threads()};
    size_t blocks = bins_count(bins);
    bins->places = malloc((size_t)bins->part_room * blocks * sizeof *bins->places);
    bins->begins = malloc((blocks + 1) * sizeof *bins->begins);
    if (bins->places && bins->begins) return RESULT_OK;
    bins_destroy(bins);
    return error_set(error, RESULT_FAILED, "no memory for lists of %zu blocks", blocks);
}

void bins_destroy(Bins *bins)
{
    free(bins->places);
    free(bins->begins);
    free(bins->pairs);
    *bins = (Bins){0};
}

static uint32_t *places_of(const Bins *bins, int part)
{
    return bins->places + (size_t)part * bins_count(bins);
}

static inline void put(const Binning *binning, uint32_t *places, int block, uint64_t pair)
{
    uint32_t place = places[block]++;
    if (binning->pairs) binning->pairs[binning->bins->begins[block] + place] = pair;
}

// For a ribbon whose box has several rows and columns of blocks: lists it only in the blocks of
// each row that its strip touches. The strip lies around the middle line, which moves by `slope` px
// for each pixel row.
static void put_in_strip(const Binning *binning, const RibbonItem *item, uint32_t *places,
                         uint64_t pair)
{
    const ScreenPoint *a = &binning->projection->points[item->slot], *b = a + 1;
    float way_x = b->x - a->x, way_y = b->y - a->y, length = fmaxf(hypotf(way_x, way_y), 1e-10f),
          steep = fmaxf(fabsf(way_y) / length, 1e-5f),
          slope = way_x / length * (way_y < 0 ? -1 : 1) / steep,
          width = fmaxf(low_level(a->place), low_level(b->place)),
          reach = (width + 0.5f * (fabsf(way_x) + fabsf(way_y)) / length) / steep;
    for (int row = item->top; row <= item->bottom; ++row) {
        float middle = a->x + ((float)row * BLOCK_HEIGHT + 0.5f * BLOCK_HEIGHT - a->y) * slope,
              wide = reach + 0.5f * BLOCK_HEIGHT * fabsf(slope) + 1,
              low = fmaxf((middle - wide) / BLOCK_WIDTH, item->left),
              high = fminf((middle + wide) / BLOCK_WIDTH, item->right);
        if (!(low <= high + 1)) continue;
        int to = (int)high < item->right ? (int)high : item->right;
        for (int column = (int)low; column <= to; ++column)
            put(binning, places, row * binning->bins->columns + column, pair);
    }
}

static void bin_part(void *data, int part)
{
    const Binning *binning = data;
    uint32_t *places = places_of(binning->bins, part);
    const RibbonItem *items = binning->projection->items[part];
    if (!binning->pairs) memset(places, 0, bins_count(binning->bins) * sizeof *places);
    for (size_t i = 0; i < binning->projection->item_count[part]; ++i) {
        const RibbonItem *item = &items[i];
        uint64_t pair = (uint64_t)~item->depth << 32 | item->slot;
        if (item->left < item->right && item->top < item->bottom)
            put_in_strip(binning, item, places, pair);
        else
            for (int row = item->top; row <= item->bottom; ++row)
                for (int column = item->left; column <= item->right; ++column)
                    put(binning, places, row * binning->bins->columns + column, pair);
    }
}

// Converts counts to places. In each list the ribbons of the first part come first, so the order
// does not depend on threads.
static void find_places(Bins *bins, int parts)
{
    size_t blocks = bins_count(bins), at = 0;
    bins->longest = 0;
    for (size_t b = 0; b < blocks; ++b) {
        uint32_t place = 0;
        for (int part = 0; part < parts; ++part) {
            uint32_t *places = places_of(bins, part), own = places[b];
            places[b] = place;
            place += own;
        }
        bins->begins[b] = at;
        at += place;
        if (place > bins->longest) bins->longest = place;
    }
    bins->begins[blocks] = at;
}

static Result make_room(Bins *bins, size_t count, Error *error)
{
    if (bins->pair_room >= count) return RESULT_OK;
    if (room_make(&bins->pairs, &bins->pair_room, count + count / 4, sizeof *bins->pairs))
        return RESULT_OK;
    return error_set(error, RESULT_FAILED, "no memory to list %zu ribbons", count);
}

Result bins_fill(Bins *bins, const Projection *projection, Error *error)
{
    Binning binning = {bins, projection, NULL};
    parallel_run(projection->parts, bin_part, &binning);
    find_places(bins, projection->parts);
    TRY(make_room(bins, bins->begins[bins_count(bins)] + 1, error));
    binning.pairs = bins->pairs;
    parallel_run(projection->parts, bin_part, &binning);
    return RESULT_OK;
}
