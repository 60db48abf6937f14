// SPDX-License-Identifier: MIT
#include "base/random.h"
#include "glsl/draw/draw.h"
#include "lanes/block_bins.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { COUNT = 3000, COLUMNS = 17, ROWS = 13, BLOCKS = COLUMNS * ROWS };

static RibbonRecord records[COUNT];
static RibbonKey keys[COUNT];

static uint32_t below(Random *random, uint32_t end)
{
    return (uint32_t)(random_real(random) * end);
}

// Boxes anywhere, most of them small, some of ribbons that reach all of it; every 7th slot is
// empty, every 11th key does not say which blocks.
static int setup(void **state)
{
    (void)state;
    Random random = random_create(1, 0);
    for (int i = 0; i < COUNT; ++i) {
        uint32_t width = COLUMNS * BLOCK_WIDTH, height = ROWS * BLOCK_HEIGHT,
                 row = below(&random, height), column = below(&random, width),
                 last_row = row + below(&random, i % 3 ? 20 : height - row),
                 last_column = column + below(&random, i % 3 ? 20 : width - column);
        if (last_row >= height) last_row = height - 1;
        if (last_column >= width) last_column = width - 1;
        records[i] = (RibbonRecord){.a = {(float)column, (float)row},
                                    .slope = (float)(4 * random_real(&random) - 2),
                                    .reach = i % 50 ? (float)(2 * random_real(&random)) : 1e30f,
                                    .rows = row | last_row << 16,
                                    .columns = column | last_column << 16};
        keys[i].depth = i % 7 ? 1 + below(&random, 1000) : 0;
        keys[i].blocks = i % 11
                             ? column / BLOCK_WIDTH | row / BLOCK_HEIGHT << 8 |
                                   last_column / BLOCK_WIDTH << 16 | last_row / BLOCK_HEIGHT << 24
                             : MANY_BLOCKS;
    }
    return 0;
}

// Whether the middle of a pixel of the block, in the ribbon's box, is in reach of its strip.
static bool touches(const RibbonRecord *r, int column, int row)
{
    for (int y = row * BLOCK_HEIGHT; y < (row + 1) * BLOCK_HEIGHT; ++y) {
        double middle = (double)r->a[0] + (y + 0.5 - (double)r->a[1]) * (double)r->slope;
        if (y < (int)(r->rows & 0xffff) || y > (int)(r->rows >> 16)) continue;
        double low = fmax(middle - (double)r->reach, (r->columns & 0xffff) + 0.5),
               high = fmin(middle + (double)r->reach, (r->columns >> 16) + 0.5);
        low = fmax(ceil(low - 0.5), column * BLOCK_WIDTH);
        high = fmin(floor(high - 0.5), (column + 1) * BLOCK_WIDTH - 1);
        if (low <= high) return true;
    }
    return false;
}

static BlockBins make_lists(int parts)
{
    BlockBins lists;
    Error error = {{0}};
    assert_int_equal(block_bins_create(&lists, COLUMNS, ROWS, &error), RESULT_OK);
    free(lists.places);
    lists.places = malloc((size_t)parts * BLOCKS * sizeof *lists.places);
    assert_non_null(lists.places);
    lists.parts = parts;
    assert_int_equal(block_bins_fill(&lists, keys, records, COUNT, &error), RESULT_OK);
    return lists;
}

static bool lists_slot(const BlockBins *lists, int block, int slot)
{
    for (size_t i = lists->begins[block]; i < lists->begins[block + 1]; ++i)
        if ((uint32_t)lists->pairs[i] == (uint32_t)slot) return true;
    return false;
}

static void a_block_bins_all_that_touch_it(void **state)
{
    (void)state;
    BlockBins lists = make_lists(1);
    int found = 0;
    for (int i = 0; i < COUNT; ++i)
        for (int b = 0; b < BLOCKS && keys[i].depth; ++b) {
            if (!touches(&records[i], b % COLUMNS, b / COLUMNS)) continue;
            assert_true(lists_slot(&lists, b, i));
            ++found;
        }
    assert_true(found > COUNT);
    block_bins_destroy(&lists);
}

// In a box of several rows and columns of blocks, no more than what a strip reaches between a row's
// outer pixels' middles.
static void a_block_bins_little_else(void **state)
{
    (void)state;
    BlockBins lists = make_lists(1);
    size_t more = 0, all = 0;
    for (int b = 0; b < BLOCKS; ++b)
        for (size_t i = lists.begins[b]; i < lists.begins[b + 1]; ++i) {
            const RibbonRecord *r = &records[(uint32_t)lists.pairs[i]];
            if ((r->rows & 0xffff) / BLOCK_HEIGHT == (r->rows >> 16) / BLOCK_HEIGHT) continue;
            if ((r->columns & 0xffff) / BLOCK_WIDTH == (r->columns >> 16) / BLOCK_WIDTH) continue;
            ++all;
            more += !touches(r, b % COLUMNS, b / COLUMNS);
        }
    assert_true(all > COUNT / 2 && more < all / 50);
    block_bins_destroy(&lists);
}

static void a_list_goes_by_slots_and_sorts_near_to_far(void **state)
{
    (void)state;
    BlockBins lists = make_lists(1);
    for (int b = 0; b < BLOCKS; ++b)
        for (size_t i = lists.begins[b]; i < lists.begins[b + 1]; ++i) {
            uint64_t pair = lists.pairs[i];
            assert_int_equal(pair >> 32, ~keys[(uint32_t)pair].depth);
            if (i > lists.begins[b]) assert_true((uint32_t)lists.pairs[i - 1] < (uint32_t)pair);
        }
    block_bins_destroy(&lists);
}

static void lists_do_not_depend_on_how_many_make_them(void **state)
{
    (void)state;
    BlockBins one = make_lists(1);
    for (int parts = 2; parts <= 16; parts *= 2) {
        BlockBins lists = make_lists(parts);
        assert_memory_equal(lists.begins, one.begins, (BLOCKS + 1) * sizeof *one.begins);
        assert_memory_equal(lists.pairs, one.pairs, one.begins[BLOCKS] * sizeof *one.pairs);
        block_bins_destroy(&lists);
    }
    block_bins_destroy(&one);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_block_bins_all_that_touch_it),
        cmocka_unit_test(a_block_bins_little_else),
        cmocka_unit_test(a_list_goes_by_slots_and_sorts_near_to_far),
        cmocka_unit_test(lists_do_not_depend_on_how_many_make_them),
    };
    return cmocka_run_group_tests(tests, setup, NULL);
}
