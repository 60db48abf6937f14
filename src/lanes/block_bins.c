// SPDX-License-Identifier: MIT
#include "lanes/block_bins.h"

#include "base/parallel.h"
#include "glsl/draw/draw.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// All slots on the way to their blocks.
typedef struct Binning {
    BlockBins *lists;
    const RibbonKey *keys;
    const RibbonRecord *records;
    size_t count;
} Binning;

static size_t block_count(const BlockBins *lists)
{
    return (size_t)lists->columns * (size_t)lists->rows;
}

Result block_bins_create(BlockBins *lists, int columns, int rows, Error *error)
{
    *lists = (BlockBins){columns, rows, .parts = parallel_threads()};
    size_t blocks = block_count(lists);
    lists->places = malloc((size_t)lists->parts * blocks * sizeof *lists->places);
    lists->begins = malloc((blocks + 1) * sizeof *lists->begins);
    if (lists->places && lists->begins) return RESULT_OK;
    block_bins_destroy(lists);
    return error_set(error, RESULT_FAILED, "no memory for lists of %zu blocks", blocks);
}

void block_bins_destroy(BlockBins *lists)
{
    free(lists->places);
    free(lists->begins);
    free(lists->pairs);
    *lists = (BlockBins){0};
}

static uint32_t *places_of(const BlockBins *lists, int part)
{
    return lists->places + (size_t)part * block_count(lists);
}

// Puts the pair into the block's list; NULL lists: it is only counted.
static inline void put(uint64_t *pairs, const size_t *begins, uint32_t *places, uint32_t block,
                       uint64_t pair)
{
    uint32_t place = places[block]++;
    if (pairs) pairs[begins[block] + place] = pair;
}

// Visits the blocks of a ribbon: in every row of them those between the outermost pixels' middles
// that its strip reaches.
static void put_in_several(const BlockBins *lists, const RibbonRecord *r, uint64_t *pairs,
                           uint32_t *places, uint64_t pair)
{
    int first = (int)(r->rows & 0xffff), last = (int)(r->rows >> 16);
    float left = (float)(r->columns & 0xffff) + 0.5f, right = (float)(r->columns >> 16) + 0.5f;
    for (int row = first / BLOCK_HEIGHT; row <= last / BLOCK_HEIGHT; ++row) {
        int top = row * BLOCK_HEIGHT, bottom = top + BLOCK_HEIGHT - 1;
        if (top < first) top = first;
        if (bottom > last) bottom = last;
        float middle = r->a[0] + (0.5f * (float)(top + bottom + 1) - r->a[1]) * r->slope,
              reach = r->reach + 0.5f * (float)(bottom - top) * fabsf(r->slope),
              low = middle - reach, high = middle + reach;
        low = low > left ? low : left;
        high = high < right ? high : right;
        if (!(low <= high)) continue;
        int to = (int)high / BLOCK_WIDTH;
        for (int column = (int)low / BLOCK_WIDTH; column <= to; ++column)
            put(pairs, lists->begins, places, (uint32_t)(row * lists->columns + column), pair);
    }
}

static void bin_ribbons(const Binning *binning, int part, uint64_t *pairs)
{
    const BlockBins *lists = binning->lists;
    uint32_t *places = places_of(lists, part);
    size_t parts = (size_t)lists->parts, end = binning->count * ((size_t)part + 1) / parts;
    for (size_t i = binning->count * (size_t)part / parts; i < end; ++i) {
        RibbonKey key = binning->keys[i];
        if (!key.depth) continue;
        uint64_t pair = (uint64_t)~key.depth << 32 | i;
        uint32_t left = key.blocks & 255, top = key.blocks >> 8 & 255,
                 right = key.blocks >> 16 & 255, bottom = key.blocks >> 24;
        if (key.blocks == MANY_BLOCKS || (left < right && top < bottom))
            put_in_several(lists, &binning->records[i], pairs, places, pair);
        else
            for (uint32_t row = top; row <= bottom; ++row)
                for (uint32_t column = left; column <= right; ++column)
                    put(pairs, lists->begins, places, row * (uint32_t)lists->columns + column,
                        pair);
    }
}

static void count_part(void *data, int part)
{
    const Binning *binning = data;
    memset(places_of(binning->lists, part), 0, block_count(binning->lists) * sizeof(uint32_t));
    bin_ribbons(binning, part, NULL);
}

static void fill_part(void *data, int part)
{
    const Binning *binning = data;
    bin_ribbons(binning, part, binning->lists->pairs);
}

// From counts to places: in each list the first part's ribbons come first.
static void find_places(BlockBins *lists)
{
    size_t blocks = block_count(lists), at = 0;
    for (size_t b = 0; b < blocks; ++b) {
        uint32_t place = 0;
        for (int part = 0; part < lists->parts; ++part) {
            uint32_t *places = places_of(lists, part), own = places[b];
            places[b] = place;
            place += own;
        }
        lists->begins[b] = at;
        at += place;
    }
    lists->begins[blocks] = at;
}

static Result make_room(BlockBins *lists, size_t count, Error *error)
{
    if (lists->pair_room >= count) return RESULT_OK;
    free(lists->pairs);
    size_t room = count + count / 4;
    lists->pairs = malloc(room * sizeof *lists->pairs);
    lists->pair_room = lists->pairs ? room : 0;
    if (lists->pairs) return RESULT_OK;
    return error_set(error, RESULT_FAILED, "no memory to list %zu ribbons", count);
}

Result block_bins_fill(BlockBins *lists, const RibbonKey *keys, const RibbonRecord *records,
                       size_t count, Error *error)
{
    Binning binning = {lists, keys, records, count};
    parallel_run(lists->parts, count_part, &binning);
    find_places(lists);
    TRY(make_room(lists, lists->begins[block_count(lists)], error));
    parallel_run(lists->parts, fill_part, &binning);
    return RESULT_OK;
}
