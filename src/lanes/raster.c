// SPDX-License-Identifier: MIT
#include "lanes/raster.h"

#include "base/radix.h"

#include <stdatomic.h>
#include <stdlib.h>

// Data that the threads share.
typedef struct Work {
    const LaneRaster *raster;
    const RasterScene *scene;
    atomic_int next; // the next block that no thread has begun
} Work;

Result raster_create(LaneRaster *raster, int width, int height, Error *error)
{
    *raster = (LaneRaster){0};
    Result result = bins_create(&raster->bins, (width + BLOCK_WIDTH - 1) / BLOCK_WIDTH,
                                (height + BLOCK_HEIGHT - 1) / BLOCK_HEIGHT, error);
    for (int i = 0; i < raster->bins.part_room && result == RESULT_OK; ++i) {
        raster->cells[i] =
            aligned_alloc(64, BLOCK_CELLS * (sizeof(Cell) + CELL_PIXELS * sizeof(float)) +
                                  (sizeof(BlockRims) + 63) / 64 * 64);
        raster->scratch[i] = aligned_alloc(64, composite_scratch_size());
        if (!raster->cells[i] || !raster->scratch[i])
            result = error_set(error, RESULT_FAILED, "no memory for a block of pixels");
    }
    if (result != RESULT_OK) raster_destroy(raster);
    return result;
}

void raster_destroy(LaneRaster *raster)
{
    bins_destroy(&raster->bins);
    for (int i = 0; i < PARALLEL_MOST; ++i) {
        free(raster->sorting[i]);
        free(raster->cells[i]);
        free(raster->scratch[i]);
    }
    *raster = (LaneRaster){0};
}

// Makes room for each thread to sort the longest list.
static Result make_room(LaneRaster *raster, Error *error)
{
    size_t longest = raster->bins.longest;
    if (raster->sorting_room >= longest) return RESULT_OK;
    raster->sorting_room = 0;
    for (int i = 0; i < raster->bins.part_room; ++i) {
        free(raster->sorting[i]);
        raster->sorting[i] = malloc(longest * sizeof *raster->sorting[i]);
        if (!raster->sorting[i])
            return error_set(error, RESULT_FAILED, "no memory to sort %zu ribbons", longest);
    }
    raster->sorting_room = longest;
    return RESULT_OK;
}

Result raster_bin(LaneRaster *raster, const Projection *projection, Error *error)
{
    TRY(bins_fill(&raster->bins, projection, error));
    return make_room(raster, error);
}

static void draw_block(const Work *work, size_t b, int part)
{
    const LaneRaster *raster = work->raster;
    const RasterScene *scene = work->scene;
    const Bins *bins = &raster->bins;
    Cell *cells = raster->cells[part];
    float(*hidden)[CELL_PIXELS] = (float(*)[CELL_PIXELS])(cells + BLOCK_CELLS);
    BlockRims *rims = scene->nearest ? NULL : (BlockRims *)(void *)(hidden + BLOCK_CELLS);
    Block block = {cells, hidden, rims, (int)(b % (size_t)bins->columns) * BLOCK_WIDTH,
                   (int)(b / (size_t)bins->columns) * BLOCK_HEIGHT};
    size_t count = bins->begins[b + 1] - bins->begins[b];
    const BlockBase *base = pixels_have_base(scene->base, block.x, block.y) ? scene->base : NULL;
    BlockForm form = scene->nearest ? BLOCK_NEAREST : base ? BLOCK_OVER_MESH : BLOCK_OPEN;
    pixels_clear(&block, base, &scene->style);
    const uint64_t *order = radix_sort(bins->pairs + bins->begins[b], raster->sorting[part], count);
    composite_block(&block, form, &scene->ribbons, order, count, raster->scratch[part]);
    pixels_store(&block, base, &scene->style, scene->image);
}

static void draw_blocks(void *data, int part)
{
    Work *work = data;
    for (int b; (b = atomic_fetch_add(&work->next, 1)) < (int)bins_count(&work->raster->bins);)
        draw_block(work, (size_t)b, part);
}

void raster_draw(LaneRaster *raster, const RasterScene *scene)
{
    Work work = {raster, scene, 0};
    parallel_run(raster->bins.part_room, draw_blocks, &work);
}
