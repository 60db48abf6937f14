// SPDX-License-Identifier: MIT
#include "draw/renderer.h"

#include "base/activity.h"

#include "glsl/common/shared_math.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

// The options that are really drawn with: an AOV changes some of them.
static RendererOptions settle(const RendererOptions *asked)
{
    RendererOptions options = *asked;
    if (options.kind == IMAGE_FLOAT || options.aov != AOV_NONE) options.tone = TONE_NONE;
    if (options.samples == 0 || options.aov > AOV_COVERAGE) options.samples = 1;
    if (options.aov != AOV_NONE) { // on black, without light
        memcpy(options.background, (float[4]){0, 0, 0, 1}, 4 * sizeof(float));
        options.shadow.kind = SHADOW_NONE;
        options.floor.kind = FLOOR_NONE;
        options.backdrop = false;
    }
    return options;
}

static Raster choose_raster(const Gpu *gpu, const RendererOptions *options)
{
    bool plain = options->oit == OIT_AUTO && options->oit_layers == 0;
    if (options->raster != RASTER_AUTO) return options->raster;
    if (!plain) return RASTER_QUADS;
    return gpu->kind == GPU_HARDWARE ? RASTER_COMPUTE : RASTER_BLOCKS;
}

static Result divide(Renderer *renderer, Error *error)
{
    const RendererOptions *options = &renderer->options;
    renderer->tiles = tiles_divide(&renderer->gpu->limits, options->width, options->height,
                                   options->samples, TILE_MOST_SAMPLES);
    renderer->part = *options;
    renderer->part.width = renderer->tiles.width;
    renderer->part.height = renderer->tiles.height;
    if (tiles_count(&renderer->tiles) == 1) return RESULT_OK;
    return image_create_kind(&renderer->tile, renderer->part.width, renderer->part.height,
                             renderer_channels(renderer), options->kind, error);
}

Result renderer_create(Renderer *renderer, const Gpu *gpu, GpuTimer *timer,
                       const RendererOptions *asked, Error *error)
{
    *renderer = (Renderer){
        .options = settle(asked), .gpu = gpu, .timer = timer, .drawing.tables.stock = gpu->tables};
    RendererOptions *options = &renderer->options;
    if (options->samples != 1 && options->samples != 2 && options->samples != 4)
        return error_set(error, RESULT_USAGE, "--samples %d: expected 1, 2 or 4", options->samples);
    options->raster = choose_raster(gpu, options);
    renderer->backend = options->raster == RASTER_BLOCKS ? &DRAW_LANES : &DRAW_PASSES;
    renderer->read.copies = gpu->kind == GPU_HARDWARE;
    Result result = divide(renderer, error);
    const BackendOptions set = {&renderer->part, gpu, {timer, gpu_timer_begin, gpu_timer_end}};
    THEN(result, renderer->backend->create(&renderer->state, &set, error));
    if (result != RESULT_OK) renderer_destroy(renderer);
    return result;
}

void renderer_destroy(Renderer *renderer)
{
    if (renderer->backend) renderer->backend->destroy(renderer->state);
    drawn_mesh_destroy(&renderer->mesh);
    free(renderer->hair);
    hair_read_destroy(&renderer->read);
    drawing_destroy(&renderer->drawing);
    image_destroy(&renderer->tile);
    *renderer = (Renderer){0};
}

Result renderer_set_mesh(Renderer *renderer, const Mesh *mesh, const float color[3], Error *error)
{
    float linear[3];
    linear_from_srgb_color(color, linear);
    TRY(drawn_mesh_set(&renderer->mesh, mesh, linear, error));
    return renderer->backend->set_mesh(renderer->state, &renderer->mesh, error);
}

void renderer_move_mesh(Renderer *renderer, const Mesh *moved)
{
    drawn_mesh_move(&renderer->mesh, moved);
    if (renderer->backend->move_mesh)
        renderer->backend->move_mesh(renderer->state, &renderer->mesh);
}

Result renderer_set_openness(Renderer *renderer, const float (*open)[2], Error *error)
{
    TRY(drawn_mesh_set_openness(&renderer->mesh, open, error));
    return renderer->backend->set_mesh(renderer->state, &renderer->mesh, error);
}

Result renderer_set_tint(Renderer *renderer, const float (*tint)[3], Error *error)
{
    TRY(drawn_mesh_set_tint(&renderer->mesh, tint, error));
    return renderer->backend->set_mesh(renderer->state, &renderer->mesh, error);
}

int renderer_channels(const Renderer *renderer)
{
    return renderer->options.background[3] < 1 ? 4 : 3;
}

// --- A frame.

static Result list_hair(Renderer *renderer, Error *error)
{
    const Drawing *drawing = &renderer->drawing;
    uint32_t count = 0;
    for (uint32_t i = 0; i < drawing->item_count; ++i) count += drawing->items[i].hair->batch_count;
    if (renderer->hair_room < count) {
        DrawnHair *hair = realloc(renderer->hair, count * sizeof *hair);
        if (!hair) return error_set(error, RESULT_FAILED, "no memory for %u batches", count);
        renderer->hair = hair;
        renderer->hair_room = count;
    }
    count = 0;
    for (uint32_t i = 0; i < drawing->item_count; ++i)
        for (uint32_t b = 0; b < drawing->items[i].hair->batch_count; ++b) {
            const HairBatch *batch = &drawing->items[i].hair->batches[b];
            const Look *look = &drawing->looks[i];
            renderer->hair[count++] =
                (DrawnHair){.batch = batch, .look = look, .material = look_material(look, batch)};
        }
    renderer->frame.hair = renderer->hair;
    renderer->frame.hair_count = count;
    return RESULT_OK;
}

static Result begin_frame(Renderer *renderer, const RenderFrame *frame, const RenderItem *items,
                          uint32_t item_count, Error *error)
{
    Drawing *drawing = &renderer->drawing;
    TRY(drawing_begin(drawing, &renderer->options, &renderer->mesh, frame, items, item_count,
                      error));
    renderer->frame = (BackendFrame){.drawing = drawing, .frame = frame, .mesh = &renderer->mesh};
    if (item_count) drawing_find_middle(&items[0], renderer->frame.middle);
    return list_hair(renderer, error);
}

static Result draw_window(Renderer *renderer, Image *image, Error *error)
{
    if (renderer->options.backdrop)
        TRY(backdrop_find(&renderer->drawing.backdrop, renderer->frame.frame->ambient,
                          &renderer->options, &renderer->drawing.draw, error));
    TRY(renderer->backend->shade(renderer->state, &renderer->frame, error));
    TRY(renderer->backend->composite(renderer->state, &renderer->frame, image, error));
    renderer->backend->count(renderer->state, &renderer->counts);
    return RESULT_OK;
}

static void add_counts(RendererCounts *sum, const RendererCounts *counts)
{
    sum->segments += counts->segments;
    sum->culled += counts->culled;
    sum->hidden += counts->hidden;
    sum->fragments += counts->fragments;
    sum->redraws += counts->redraws;
    sum->bands += counts->bands;
    sum->shadow_maps = counts->shadow_maps;
    if (counts->pool_bytes > sum->pool_bytes) sum->pool_bytes = counts->pool_bytes;
}

// Reads a tile back at once. Unlike a whole image, it cannot be read back one frame later, because
// the next tile uses the same render target.
static Result finish_tile(Renderer *renderer, int sent, Error *error)
{
    const DrawBackend *backend = renderer->backend;
    if (!backend->take) return RESULT_OK;
    TRY(backend->settle(renderer->state, &renderer->frame, error));
    backend->count(renderer->state, &renderer->counts);
    return backend->take(renderer->state, sent, &renderer->tile, error);
}

static Result draw_tiles(Renderer *renderer, Image *image, Error *error)
{
    const Tiles *tiles = &renderer->tiles;
    RendererCounts sum = {0};
    for (int i = 0; i < tiles_count(tiles); ++i) {
        int place[2], size[] = {tiles->width, tiles->height}, sent = renderer_place(renderer);
        tiles_place(tiles, i, place);
        drawing_set_window(&renderer->drawing, &renderer->options, &renderer->mesh, place, size);
        TRY(draw_window(renderer, &renderer->tile, error));
        TRY(finish_tile(renderer, sent, error));
        tiles_copy(tiles, i, &renderer->tile, image);
        add_counts(&sum, &renderer->counts);
    }
    renderer->counts = sum;
    return RESULT_OK;
}

static Result draw_frame(Renderer *renderer, Image *image, Error *error)
{
    const DrawBackend *backend = renderer->backend;
    activity_set("shadows");
    TRY(backend->shadow(renderer->state, &renderer->frame, error));
    activity_set("light among hair");
    TRY(backend->scatter(renderer->state, &renderer->frame, error));
    activity_set("drawing");
    return tiles_count(&renderer->tiles) == 1 ? draw_window(renderer, image, error)
                                              : draw_tiles(renderer, image, error);
}

// The number of strands that are not drawn because other strands represent them (level of detail).
static uint64_t count_thinned(const BackendFrame *frame)
{
    uint64_t count = 0;
    for (uint32_t i = 0; i < frame->hair_count; ++i)
        count += frame->hair[i].batch->strand_count - frame->hair[i].material.drawn_strands;
    return count;
}

Result renderer_begin(Renderer *renderer, const RenderFrame *frame, const RenderItem *items,
                      uint32_t item_count, Image *image, Error *error)
{
    assert(image->width == renderer->options.width && image->height == renderer->options.height);
    assert(image->channels == renderer_channels(renderer));
    TRY(begin_frame(renderer, frame, items, item_count, error));
    bool reads = renderer->backend->reads_hair;
    if (reads)
        TRY(hair_read_begin(&renderer->read, renderer->hair, renderer->frame.hair_count, error));
    Result result = draw_frame(renderer, image, error);
    if (reads) hair_read_end(&renderer->read);
    renderer->counts.thinned = count_thinned(&renderer->frame);
    return result == RESULT_OK ? gpu_check("drawing", error) : result;
}

bool renderer_is_late(const Renderer *renderer)
{
    return renderer->backend->take && tiles_count(&renderer->tiles) == 1;
}

int renderer_place(const Renderer *renderer)
{
    return renderer->backend->place ? renderer->backend->place(renderer->state) : 0;
}

Result renderer_settle(Renderer *renderer, Error *error)
{
    uint64_t thinned = renderer->counts.thinned;
    if (!renderer_is_late(renderer)) return RESULT_OK;
    TRY(renderer->backend->settle(renderer->state, &renderer->frame, error));
    renderer->backend->count(renderer->state, &renderer->counts);
    renderer->counts.thinned = thinned;
    return RESULT_OK;
}

Result renderer_take(Renderer *renderer, int place, Image *image, Error *error)
{
    if (!renderer_is_late(renderer)) return RESULT_OK;
    TRY(renderer->backend->take(renderer->state, place, image, error));
    return gpu_check("reading the image", error);
}

Result renderer_draw(Renderer *renderer, const RenderFrame *frame, const RenderItem *items,
                     uint32_t item_count, Image *image, Error *error)
{
    int place = renderer_place(renderer);
    TRY(renderer_begin(renderer, frame, items, item_count, image, error));
    TRY(renderer_settle(renderer, error));
    return renderer_take(renderer, place, image, error);
}
