// SPDX-License-Identifier: MIT
#include "lanes/block_raster.h"

#include "base/radix.h"

#include <stdatomic.h>
#include <stdlib.h>

// What threads share.
typedef struct Work {
    const BlockRaster *raster;
    const BlockScene *scene;
    atomic_int next; // block that nobody has begun
} Work;

Result block_raster_create(BlockRaster *raster, int width, int height, Error *error)
{
    *raster = (BlockRaster){0};
    Result result = block_bins_create(&raster->lists, (width + BLOCK_WIDTH - 1) / BLOCK_WIDTH,
                                      (height + BLOCK_HEIGHT - 1) / BLOCK_HEIGHT, error);
    for (int i = 0; i < raster->lists.parts && result == RESULT_OK; ++i) {
        raster->cells[i] = aligned_alloc(
            _Alignof(Cell), BLOCK_CELLS * (sizeof(Cell) + CELL_PIXELS * sizeof(float)));
        if (!raster->cells[i])
            result = error_set(error, RESULT_FAILED, "no memory for a block of pixels");
    }
    if (result != RESULT_OK) block_raster_destroy(raster);
    return result;
}

void block_raster_destroy(BlockRaster *raster)
{
    block_bins_destroy(&raster->lists);
    for (int i = 0; i < PARALLEL_MOST; ++i) {
        free(raster->sorting[i]);
        free(raster->cells[i]);
    }
    *raster = (BlockRaster){0};
}

static int block_count(const BlockRaster *raster)
{
    return raster->lists.columns * raster->lists.rows;
}

// Room for each thread to sort the longest list.
static Result make_room(BlockRaster *raster, Error *error)
{
    size_t longest = 0;
    for (int b = 0; b < block_count(raster); ++b) {
        size_t own = raster->lists.begins[b + 1] - raster->lists.begins[b];
        if (own > longest) longest = own;
    }
    if (raster->sorting_room >= longest) return RESULT_OK;
    raster->sorting_room = 0;
    for (int i = 0; i < raster->lists.parts; ++i) {
        free(raster->sorting[i]);
        raster->sorting[i] = malloc(longest * sizeof *raster->sorting[i]);
        if (!raster->sorting[i])
            return error_set(error, RESULT_FAILED, "no memory to sort %zu ribbons", longest);
    }
    raster->sorting_room = longest;
    return RESULT_OK;
}

Result block_raster_bin(BlockRaster *raster, const BlockScene *scene, uint64_t *touched,
                        Error *error)
{
    Result result =
        block_bins_fill(&raster->lists, scene->keys, scene->records, scene->slots, error);
    *touched = result == RESULT_OK ? raster->lists.begins[block_count(raster)] : 0;
    return result == RESULT_OK ? make_room(raster, error) : result;
}

static void draw_block(const Work *work, int b, uint64_t *sorting, Cell *cells)
{
    const BlockBins *lists = &work->raster->lists;
    const BlockScene *scene = work->scene;
    Block block = {cells, (float(*)[CELL_PIXELS])(cells + BLOCK_CELLS),
                   b % lists->columns * BLOCK_WIDTH, b / lists->columns * BLOCK_HEIGHT};
    size_t count = lists->begins[b + 1] - lists->begins[b];
    const BlockBase *base =
        block_pixels_have_base(scene->base, block.x, block.y) ? scene->base : NULL;
    BlockForm form = scene->nearest ? BLOCK_NEAREST : base ? BLOCK_OVER_MESH : BLOCK_OPEN;
    block_pixels_clear(&block, base, &scene->style);
    const uint64_t *order = radix_sort(lists->pairs + lists->begins[b], sorting, count);
    block_composite(&block, form, scene->records, order, count);
    block_pixels_store(&block, base, &scene->style, scene->image);
}

static void draw_blocks(void *data, int part)
{
    Work *work = data;
    const BlockRaster *raster = work->raster;
    for (int b; (b = atomic_fetch_add(&work->next, 1)) < block_count(raster);)
        draw_block(work, b, raster->sorting[part], raster->cells[part]);
}

void block_raster_composite(BlockRaster *raster, const BlockScene *scene)
{
    Work work = {raster, scene, 0};
    parallel_run(raster->lists.parts, draw_blocks, &work);
}
