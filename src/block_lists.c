// SPDX-License-Identifier: MIT
#include "block_lists.h"

#include "parallel.h"

#include <stdlib.h>
#include <string.h>

enum {
    AHEAD = 16,
    LENGTHS = 1024,
    REGION_COLUMNS = 32, // whose lists are composited one after the other: their ribbons
    REGION_ROWS = 16     // stay in a core's cache
};

// A range of ribbons on the way to their blocks.
typedef struct Dealing {
    BlockLists *lists;
    const RibbonRecord *ribbons;
    const uint32_t *order;
    size_t count;
    int row, end;
    uint32_t *numbers; // NULL: they are only counted
} Dealing;

Result block_lists_create(BlockLists *lists, int columns, int rows, float width, float height,
                          Error *error)
{
    size_t blocks = (size_t)columns * (size_t)rows;
    *lists = (BlockLists){.columns = columns,
                          .rows = rows,
                          .width = width,
                          .height = height,
                          .parts = parallel_threads()};
    lists->places = malloc((size_t)lists->parts * blocks * sizeof *lists->places);
    lists->jobs = malloc((blocks + JOB_GROUP) * sizeof *lists->jobs);
    lists->sorted = malloc((blocks + JOB_GROUP) * sizeof *lists->sorted);
    if (lists->places && lists->jobs && lists->sorted) return RESULT_OK;
    block_lists_destroy(lists);
    return error_set(error, RESULT_FAILED, "no memory for lists of %zu blocks", blocks);
}

void block_lists_destroy(BlockLists *lists)
{
    free(lists->places);
    free(lists->jobs);
    free(lists->sorted);
    *lists = (BlockLists){0};
}

static int smaller(int a, int b)
{
    return a < b ? a : b;
}

static uint32_t *places_of(const BlockLists *lists, int part)
{
    return lists->places + (size_t)part * (size_t)(lists->columns * lists->rows);
}

// Visits the blocks of a ribbon: in every row those whose middle lies within reach of the strip's.
static inline void deal_ribbon(const Dealing *dealing, uint32_t number, uint32_t *places)
{
    const BlockLists *lists = dealing->lists;
    const RibbonRecord *r = &dealing->ribbons[number];
    int first = (int)(r->rows & 0xffff), last = (int)(r->rows >> 16);
    int from = first > dealing->row ? first : dealing->row,
        end = last + 1 < dealing->end ? last + 1 : dealing->end;
    float left = (float)(r->columns & 0xffff), right = (float)(r->columns >> 16), slope = r->slope,
          reach = r->reach;
    float middle =
        r->a[0] / lists->width - 0.5f + ((float)from - (r->a[1] / lists->height - 0.5f)) * slope;
    for (int row = from; row < end; ++row) {
        float x = middle + (float)(row - from) * slope, low = x - reach, high = x + reach;
        low = low > left ? low : left;
        high = high < right ? high : right;
        if (!(low <= high)) continue;
        int column = (int)low, to = (int)high;
        if ((float)column < low) ++column;
        uint32_t *place = places + (size_t)row * (size_t)lists->columns;
        for (; column <= to; ++column) {
            if (dealing->numbers) dealing->numbers[place[column]] = number;
            ++place[column];
        }
    }
}

static void deal(const Dealing *dealing, int part)
{
    uint32_t *places = places_of(dealing->lists, part);
    size_t parts = (size_t)dealing->lists->parts, begin = dealing->count * (size_t)part / parts,
           end = dealing->count * ((size_t)part + 1) / parts;
    for (size_t i = begin; i < end; ++i) {
        size_t later = i + AHEAD < end ? i + AHEAD : i;
        __builtin_prefetch(&dealing->ribbons[dealing->order[later]]);
        deal_ribbon(dealing, dealing->order[i], places);
    }
}

static void count_part(void *data, int part)
{
    const Dealing *dealing = data;
    const BlockLists *lists = dealing->lists;
    memset(places_of(lists, part), 0, (size_t)(lists->columns * lists->rows) * sizeof(uint32_t));
    deal(dealing, part);
}

static void fill_part(void *data, int part)
{
    deal(data, part);
}

uint64_t block_lists_count(BlockLists *lists, const RibbonRecord *ribbons, const uint32_t *order,
                           size_t count)
{
    Dealing dealing = {lists, ribbons, order, count, 0, lists->rows, NULL};
    parallel_run(lists->parts, count_part, &dealing);
    uint64_t sum = 0;
    size_t all = (size_t)lists->parts * (size_t)(lists->columns * lists->rows);
    for (size_t i = 0; i < all; ++i) sum += lists->places[i];
    return sum;
}

static uint64_t count_row(const BlockLists *lists, int row)
{
    uint64_t sum = 0;
    for (int part = 0; part < lists->parts; ++part)
        for (int i = 0; i < lists->columns; ++i)
            sum += places_of(lists, part)[row * lists->columns + i];
    return sum;
}

int block_lists_fit(const BlockLists *lists, int row, uint64_t most, uint64_t *size)
{
    *size = 0;
    for (; row < lists->rows; ++row) {
        uint64_t own = count_row(lists, row);
        if (*size + own > most) return row;
        *size += own;
    }
    return row;
}

// From counts to places, a block's list in one piece.
static BlockJob place_block(BlockLists *lists, int block, uint32_t *at)
{
    BlockJob job = {.block = (uint32_t)block, .begin = *at};
    for (int part = 0; part < lists->parts; ++part) {
        uint32_t *place = &places_of(lists, part)[block], own = *place;
        *place = *at;
        *at += own;
    }
    job.count = *at - job.begin;
    return job;
}

static uint32_t length_of(const BlockJob *job)
{
    return LENGTHS - 1 - (job->count < LENGTHS ? job->count : LENGTHS - 1);
}

static void sort_jobs(const BlockJob *jobs, size_t count, BlockJob *sorted)
{
    size_t places[LENGTHS] = {0}, at = 0;
    for (size_t i = 0; i < count; ++i) ++places[length_of(&jobs[i])];
    for (int k = 0; k < LENGTHS; ++k) {
        size_t own = places[k];
        places[k] = at;
        at += own;
    }
    for (size_t i = 0; i < count; ++i) sorted[places[length_of(&jobs[i])]++] = jobs[i];
}

// Of a region, sorted by length.
static size_t place_region(BlockLists *lists, const int in[4], const int box[4], uint32_t *at,
                           BlockJob *sorted)
{
    size_t count = 0;
    for (int y = in[1]; y < in[3]; ++y)
        for (int x = in[0]; x < in[2]; ++x) {
            BlockJob job = place_block(lists, y * lists->columns + x, at);
            if (job.count || (x >= box[0] && x <= box[2] && y >= box[1] && y <= box[3]))
                lists->jobs[count++] = job;
        }
    sort_jobs(lists->jobs, count, sorted);
    return count;
}

static BlockJob idle_job(const BlockLists *lists)
{
    return (BlockJob){.block = (uint32_t)(lists->columns * lists->rows)};
}

static uint64_t turns_of(const BlockLists *lists, size_t group)
{
    uint64_t most = 0;
    for (int k = 0; k < JOB_GROUP; ++k) {
        uint32_t own = lists->sorted[group * JOB_GROUP + (size_t)k].count;
        if (own > most) most = own;
    }
    return most;
}

// Ends parts where their share of all work is reached: a group's work is a fifth of what a mean
// group's is, and as much more as its lists are long. So no part has more than five times its share
// of the groups. Returns the largest part's number of groups.
static size_t split(BlockLists *lists, size_t groups)
{
    uint64_t all = 0, work = 0;
    size_t begin = 0, largest = 0;
    int part = 0;
    for (size_t g = 0; g < groups; ++g) all += turns_of(lists, g);
    for (size_t g = 0; g < groups; ++g) {
        work += 4 * groups * turns_of(lists, g) + all + 1;
        uint64_t share = (5 * all + 1) * groups / (uint64_t)lists->parts;
        while (part < lists->parts - 1 && work >= share * (uint64_t)(part + 1))
            lists->ends[part++] = g + 1;
    }
    while (part < lists->parts) lists->ends[part++] = groups;
    for (part = 0; part < lists->parts; begin = lists->ends[part++])
        if (lists->ends[part] - begin > largest) largest = lists->ends[part] - begin;
    return largest;
}

size_t block_lists_place(BlockLists *lists, int row, int end, const int box[4])
{
    uint32_t at = 0;
    size_t count = 0;
    for (int y = row; y < end; y += REGION_ROWS)
        for (int x = 0; x < lists->columns; x += REGION_COLUMNS) {
            const int in[4] = {x, y, smaller(x + REGION_COLUMNS, lists->columns),
                               smaller(y + REGION_ROWS, end)};
            count += place_region(lists, in, box, &at, lists->sorted + count);
        }
    while (count % JOB_GROUP) lists->sorted[count++] = idle_job(lists);
    lists->part_groups = split(lists, count / JOB_GROUP);
    return lists->part_groups * (size_t)lists->parts * JOB_GROUP;
}

void block_lists_write_jobs(const BlockLists *lists, BlockJob *jobs)
{
    size_t begin = 0;
    for (int part = 0; part < lists->parts; ++part) {
        size_t count = (lists->ends[part] - begin) * JOB_GROUP,
               room = lists->part_groups * JOB_GROUP;
        memcpy(jobs, lists->sorted + begin * JOB_GROUP, count * sizeof *jobs);
        for (size_t i = count; i < room; ++i) jobs[i] = idle_job(lists);
        begin = lists->ends[part];
        jobs += room;
    }
}

void block_lists_fill(BlockLists *lists, const RibbonRecord *ribbons, const uint32_t *order,
                      size_t count, int row, int end, uint32_t *numbers)
{
    Dealing dealing = {lists, ribbons, order, count, row, end, numbers};
    parallel_run(lists->parts, fill_part, &dealing);
}
