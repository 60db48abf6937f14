// SPDX-License-Identifier: MIT
// Each block's list of ribbons against the pixels that each ribbon reaches.
#include "lanes/bins.h"

#include "base/random.h"

#include "glsl/common/shared_math.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum {
    COUNT = 3000,
    COLUMNS = 17,
    ROWS = 13,
    BLOCKS = COLUMNS * ROWS,
    WIDTH = COLUMNS * BLOCK_WIDTH,
    HEIGHT = ROWS * BLOCK_HEIGHT
};

static ScreenPoint points[2 * COUNT];
static RibbonItem items[COUNT];
static int boxes[COUNT][4]; // px: first column and row, last column and row

static uint16_t clamp(double x, int end)
{
    return (uint16_t)fmin(fmax(x, 0), end - 1);
}

// Lines at random places, most of them short and some wide.
static int setup(void **state)
{
    (void)state;
    Random random = random_create(1, 0);
    for (int i = 0; i < COUNT; ++i) {
        double x = random_real(&random) * WIDTH, y = random_real(&random) * HEIGHT,
               turn = 6.283185307 * random_real(&random),
               length = (i % 3 ? 20 : WIDTH) * random_real(&random),
               width = (i % 50 ? 2 : 100) * random_real(&random), reach = width + 1;
        ScreenPoint *a = &points[2 * i], *b = a + 1;
        *a = (ScreenPoint){(float)x, (float)y, 1, pack_level((float)width)};
        *b = *a;
        b->x += (float)(length * cos(turn)), b->y += (float)(length * sin(turn));
        boxes[i][0] = clamp(fmin((double)a->x, (double)b->x) - reach, WIDTH);
        boxes[i][1] = clamp(fmin((double)a->y, (double)b->y) - reach, HEIGHT);
        boxes[i][2] = clamp(fmax((double)a->x, (double)b->x) + reach, WIDTH);
        boxes[i][3] = clamp(fmax((double)a->y, (double)b->y) + reach, HEIGHT);
        items[i] = (RibbonItem){
            1 + (uint32_t)(1000 * random_real(&random)), 2 * (uint32_t)i,
            (uint16_t)(boxes[i][0] / BLOCK_WIDTH),       (uint16_t)(boxes[i][1] / BLOCK_HEIGHT),
            (uint16_t)(boxes[i][2] / BLOCK_WIDTH),       (uint16_t)(boxes[i][3] / BLOCK_HEIGHT)};
    }
    return 0;
}

// Whether the ribbon may cover part of a pixel of the block: the pixel's middle lies in the
// ribbon's box, and its distance from the ribbon's line is at most the half-widths of ribbon and
// pixel plus `more` px.
static bool touches(int i, int column, int row, double more)
{
    const ScreenPoint *a = &points[2 * i], *b = a + 1;
    double dx = (double)b->x - (double)a->x, dy = (double)b->y - (double)a->y,
           length = hypot(dx, dy), half = (double)low_level(a->place) + more;
    dx /= length, dy /= length;
    half += 0.5 * (fabs(dx) + fabs(dy));
    for (int y = row * BLOCK_HEIGHT; y < (row + 1) * BLOCK_HEIGHT; ++y)
        for (int x = column * BLOCK_WIDTH; x < (column + 1) * BLOCK_WIDTH; ++x) {
            double across = (y + 0.5 - (double)a->y) * dx - (x + 0.5 - (double)a->x) * dy;
            if (x >= boxes[i][0] && x <= boxes[i][2] && y >= boxes[i][1] && y <= boxes[i][3] &&
                fabs(across) < half)
                return true;
        }
    return false;
}

// Builds the lists by this many threads, each for a range of the ribbons.
static Bins make_lists(int parts)
{
    Bins lists;
    Error error = {{0}};
    Projection projection = {.points = points, .parts = parts};
    for (int part = 0; part < parts; ++part) {
        int first = COUNT * part / parts;
        projection.items[part] = items + first;
        projection.item_count[part] = (size_t)(COUNT * (part + 1) / parts - first);
    }
    assert_int_equal(bins_create(&lists, COLUMNS, ROWS, &error), RESULT_OK);
    free(lists.places);
    lists.places = malloc((size_t)parts * BLOCKS * sizeof *lists.places);
    assert_non_null(lists.places);
    assert_int_equal(bins_fill(&lists, &projection, &error), RESULT_OK);
    return lists;
}

static bool lists_ribbon(const Bins *lists, int block, int i)
{
    for (size_t k = lists->begins[block]; k < lists->begins[block + 1]; ++k)
        if ((uint32_t)lists->pairs[k] == items[i].slot) return true;
    return false;
}

static void a_block_lists_all_that_touch_it(void **state)
{
    (void)state;
    Bins lists = make_lists(1);
    int found = 0;
    for (int i = 0; i < COUNT; ++i)
        for (int row = items[i].top; row <= items[i].bottom; ++row)
            for (int column = items[i].left; column <= items[i].right; ++column) {
                if (!touches(i, column, row, 0)) continue;
                assert_true(lists_ribbon(&lists, row * COLUMNS + column, i));
                ++found;
            }
    assert_true(found > COUNT);
    bins_destroy(&lists);
}

// If a ribbon's box has several rows and columns of blocks, it is listed in hardly any block that a
// strip wider by 1.5 px does not reach.
static void a_block_lists_little_else(void **state)
{
    (void)state;
    Bins lists = make_lists(1);
    size_t more = 0, all = 0;
    for (int b = 0; b < BLOCKS; ++b)
        for (size_t k = lists.begins[b]; k < lists.begins[b + 1]; ++k) {
            int i = (int)((uint32_t)lists.pairs[k] / 2);
            const RibbonItem *item = &items[i];
            int row = b / COLUMNS, column = b % COLUMNS;
            assert_true(row >= item->top && row <= item->bottom);
            assert_true(column >= item->left && column <= item->right);
            if (item->top == item->bottom || item->left == item->right) continue;
            ++all;
            more += !touches(i, column, row, 1.5);
        }
    assert_true(all > COUNT / 2);
    if (more > all / 50) fail_msg("%zu of %zu", more, all);
    bins_destroy(&lists);
}

static void a_list_goes_by_slots_and_sorts_near_to_far(void **state)
{
    (void)state;
    Bins lists = make_lists(1);
    size_t longest = 0;
    for (int b = 0; b < BLOCKS; ++b) {
        size_t count = lists.begins[b + 1] - lists.begins[b];
        longest = count > longest ? count : longest;
        for (size_t k = lists.begins[b]; k < lists.begins[b + 1]; ++k) {
            uint64_t pair = lists.pairs[k];
            assert_int_equal(pair >> 32, ~items[(uint32_t)pair / 2].depth);
            if (k > lists.begins[b]) assert_true((uint32_t)lists.pairs[k - 1] < (uint32_t)pair);
        }
    }
    assert_int_equal(lists.longest, longest);
    bins_destroy(&lists);
}

static void lists_do_not_depend_on_how_many_make_them(void **state)
{
    (void)state;
    Bins one = make_lists(1);
    for (int parts = 2; parts <= PARALLEL_MOST; parts *= 2) {
        Bins lists = make_lists(parts);
        assert_memory_equal(lists.begins, one.begins, (BLOCKS + 1) * sizeof *one.begins);
        assert_memory_equal(lists.pairs, one.pairs, one.begins[BLOCKS] * sizeof *one.pairs);
        bins_destroy(&lists);
    }
    bins_destroy(&one);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_block_lists_all_that_touch_it),
        cmocka_unit_test(a_block_lists_little_else),
        cmocka_unit_test(a_list_goes_by_slots_and_sorts_near_to_far),
        cmocka_unit_test(lists_do_not_depend_on_how_many_make_them),
    };
    return cmocka_run_group_tests(tests, setup, NULL);
}
