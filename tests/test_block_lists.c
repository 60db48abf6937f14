// SPDX-License-Identifier: MIT
#include "block_lists.h"
#include "random.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { COUNT = 3000, COLUMNS = 37, ROWS = 23, BLOCKS = COLUMNS * ROWS, MOST = COUNT * BLOCKS / 4 };

static RibbonRecord ribbons[COUNT];
static uint32_t order[COUNT], numbers[MOST];
static BlockJob jobs[16 * (BLOCKS + 2 * JOB_GROUP)];
static const int NOWHERE[4] = {1, 1, 0, 0};

static size_t filled = COUNT; // of the ribbons

static size_t make(BlockLists *lists, int row, int end, const int box[4])
{
    size_t count = block_lists_place(lists, row, end, box);
    assert_true(count % ((size_t)lists->parts * JOB_GROUP) == 0 &&
                count <= sizeof jobs / sizeof *jobs);
    block_lists_write_jobs(lists, jobs);
    block_lists_fill(lists, ribbons, order, filled, row, end, numbers);
    return count;
}

static int setup(void **state)
{
    (void)state;
    Random random = random_create(1, 0);
    random_permutation(&random, order, COUNT);
    for (int i = 0; i < COUNT; ++i) {
        RibbonRecord *r = &ribbons[i];
        uint32_t row = (uint32_t)(random_real(&random) * ROWS),
                 column = (uint32_t)(random_real(&random) * COLUMNS);
        *r = (RibbonRecord){.a = {(float)(random_real(&random) * COLUMNS * 8),
                                  (float)(random_real(&random) * ROWS * 4)},
                            .slope = (float)(4 * random_real(&random) - 2),
                            .reach = i % 50 ? (float)(2 * random_real(&random)) : 1e30f};
        r->rows = row | (row + (uint32_t)(random_real(&random) * (ROWS - row))) << 16;
        r->columns = column | (column + (uint32_t)(random_real(&random) * (COLUMNS - column)))
                                  << 16;
    }
    return 0;
}

static bool touches(const RibbonRecord *r, int column, int row)
{
    double middle =
        (double)r->a[0] / 8 - 0.5 + (row - ((double)r->a[1] / 4 - 0.5)) * (double)r->slope;
    return row >= (int)(r->rows & 0xffff) && row <= (int)(r->rows >> 16) &&
           column >= (int)(r->columns & 0xffff) && column <= (int)(r->columns >> 16) &&
           fabs(column - middle) <= (double)r->reach;
}

static void check_job(const BlockJob *job)
{
    int column = (int)job->block % COLUMNS, row = (int)job->block / COLUMNS;
    uint32_t found = 0;
    if (job->block == BLOCKS) { // fills up
        assert_int_equal(job->count, 0);
        return;
    }
    for (int i = 0; i < COUNT; ++i) {
        if (!touches(&ribbons[order[i]], column, row)) continue;
        assert_true(found < job->count);
        assert_int_equal(numbers[job->begin + found++], order[i]);
    }
    assert_int_equal(found, job->count);
}

static BlockLists make_lists(int parts)
{
    BlockLists lists;
    Error error = {{0}};
    assert_int_equal(block_lists_create(&lists, COLUMNS, ROWS, 8, 4, &error), RESULT_OK);
    assert_true(parts <= lists.parts);
    lists.parts = parts;
    return lists;
}

// No ribbon's edge comes so near to a block's middle that rounding would tell.
static void a_block_lists_what_touches_it_in_order(void **state)
{
    (void)state;
    BlockLists lists = make_lists(1);
    uint64_t size = block_lists_count(&lists, ribbons, order, COUNT), sum = 0;
    assert_true(size > COUNT && size < MOST);
    size_t count = make(&lists, 0, ROWS, NOWHERE);
    for (size_t i = 0; i < count; ++i) {
        check_job(&jobs[i]);
        sum += jobs[i].count;
    }
    assert_int_equal(sum, size);
    block_lists_destroy(&lists);
}

static void lists_do_not_depend_on_how_many_make_them(void **state)
{
    (void)state;
    static uint32_t expected[MOST];
    for (int parts = 1; parts <= 16; parts *= 4) {
        BlockLists lists = make_lists(1);
        memset(numbers, 0, sizeof numbers);
        free(lists.places);
        lists.places = malloc((size_t)parts * BLOCKS * sizeof *lists.places);
        assert_non_null(lists.places);
        lists.parts = parts;
        size_t size = (size_t)block_lists_count(&lists, ribbons, order, COUNT),
               count = make(&lists, 0, ROWS, NOWHERE);
        if (parts == 1) memcpy(expected, numbers, size * sizeof *numbers);
        assert_memory_equal(numbers, expected, size * sizeof *numbers);
        for (size_t i = 0; i < count; ++i) check_job(&jobs[i]);
        block_lists_destroy(&lists);
    }
}

// Turns of a group are those of its longest list.
static void parts_of_jobs_are_of_like_work(void **state)
{
    (void)state;
    BlockLists lists = make_lists(1);
    block_lists_count(&lists, ribbons, order, COUNT);
    size_t one = block_lists_place(&lists, 0, ROWS, NOWHERE);
    lists.parts = 2;
    free(lists.places);
    lists.places = malloc((size_t)2 * BLOCKS * sizeof *lists.places);
    assert_non_null(lists.places);
    block_lists_count(&lists, ribbons, order, COUNT);
    size_t two = make(&lists, 0, ROWS, NOWHERE);
    assert_in_range(two, one, 2 * one);
    size_t turns[2] = {0};
    for (size_t g = 0; g < two / JOB_GROUP; ++g) {
        size_t most = 0;
        for (size_t k = g * JOB_GROUP; k < (g + 1) * JOB_GROUP; ++k)
            if (jobs[k].count > most) most = jobs[k].count;
        turns[2 * g >= two / JOB_GROUP] += most;
    }
    assert_in_range(10 * turns[0], 8 * turns[1], 12 * turns[1]);
    block_lists_destroy(&lists);
}

static void bands_have_all_rows_and_no_more_than_fits(void **state)
{
    (void)state;
    BlockLists lists = make_lists(1);
    uint64_t all = block_lists_count(&lists, ribbons, order, COUNT), sum = 0, size, most = all / 5;
    int bands = 0;
    for (int row = 0, end; row < ROWS; row = end, ++bands) {
        end = block_lists_fit(&lists, row, most, &size);
        assert_true(end > row && size <= most);
        size_t count = make(&lists, row, end, NOWHERE);
        for (size_t i = 0; i < count; ++i) check_job(&jobs[i]);
        sum += size;
    }
    assert_int_equal(sum, all);
    assert_in_range(bands, 5, 9);
    assert_int_equal(block_lists_count(&lists, ribbons, order, COUNT), all);
    assert_int_equal(block_lists_fit(&lists, 3, 1, &size), 3);
    block_lists_destroy(&lists);
}

static void blocks_in_the_box_are_there_without_ribbons(void **state)
{
    (void)state;
    BlockLists lists = make_lists(1);
    const int box[4] = {-1, 5, 2, 1000};
    assert_int_equal(block_lists_count(&lists, ribbons, order, 0), 0);
    filled = 0;
    size_t count = make(&lists, 0, ROWS, box), found = 0;
    filled = COUNT;
    for (size_t i = 0; i < count; ++i) {
        assert_int_equal(jobs[i].count, 0);
        if (jobs[i].block == BLOCKS) continue;
        ++found;
        assert_true(jobs[i].block % COLUMNS <= 2 && jobs[i].block / COLUMNS >= 5);
    }
    assert_int_equal(found, 3 * (ROWS - 5));
    block_lists_destroy(&lists);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_block_lists_what_touches_it_in_order),
        cmocka_unit_test(lists_do_not_depend_on_how_many_make_them),
        cmocka_unit_test(parts_of_jobs_are_of_like_work),
        cmocka_unit_test(bands_have_all_rows_and_no_more_than_fits),
        cmocka_unit_test(blocks_in_the_box_are_there_without_ribbons),
    };
    return cmocka_run_group_tests(tests, setup, NULL);
}
