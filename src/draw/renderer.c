// SPDX-License-Identifier: MIT
#include "draw/renderer.h"

#include "base/activity.h"
#include "draw/drawing.h"

#include "glsl/common/shared_math.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// A way from hair to pixels.
typedef struct RasterType {
    Result (*create)(Renderer *renderer, Error *error);
    Result (*add_base)(Renderer *renderer, Error *error); // NULL: nothing is to be made
    Result (*draw)(Renderer *renderer, Image *image, Error *error);
    // NULL, both: `draw` has filled the image. See renderer_settle, renderer_take.
    Result (*settle)(Renderer *renderer, Error *error);
    Result (*take)(Renderer *renderer, int place, Image *image, Error *error);
} RasterType;
static const RasterType RASTERS[4];

static Result create_quads(Renderer *renderer, Error *error)
{
    return quads_create(&renderer->quads, renderer->gpu, &renderer->part, error);
}

static Result create_blocks(Renderer *renderer, Error *error)
{
    return blocks_create(&renderer->blocks, &renderer->gpu->limits, &renderer->part, error);
}

// Blocks project for it, and draw what it cannot.
static Result create_compute(Renderer *renderer, Error *error)
{
    TRY(create_blocks(renderer, error));
    renderer->blocks.most_slots = compute_most_slots(renderer->gpu);
    return compute_create(&renderer->compute, renderer->gpu, &renderer->part, error);
}

// The options as they are drawn by: with what an AOV asks for.
static RendererOptions settle(const RendererOptions *asked)
{
    RendererOptions options = *asked;
    if (options.kind == IMAGE_FLOAT || options.aov != AOV_NONE) options.tone = TONE_NONE;
    if (options.samples == 0 || options.aov > AOV_COVERAGE) options.samples = 1;
    if (options.aov != AOV_NONE) { // on black, without light
        memcpy(options.background, (float[4]){0, 0, 0, 1}, 4 * sizeof(float));
        options.shadow.kind = SHADOW_NONE;
        options.floor.kind = FLOOR_NONE;
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

static bool has_base(const Renderer *renderer)
{
    return base_layer_is_needed(&renderer->base, &renderer->options.floor);
}

// What drawing over mesh or floor needs, if there is any.
static Result make_base(Renderer *renderer, Error *error)
{
    if (!has_base(renderer)) return RESULT_OK;
    Result result = render_target_add_base(&renderer->target, error);
    const RasterType *raster = &RASTERS[renderer->raster];
    return result == RESULT_OK && raster->add_base ? raster->add_base(renderer, error) : result;
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
    *renderer =
        (Renderer){.options = settle(asked), .drawing = {.gpu = gpu}, .gpu = gpu, .timer = timer};
    const RendererOptions *options = &renderer->options;
    if (options->samples != 1 && options->samples != 2 && options->samples != 4)
        return error_set(error, RESULT_USAGE, "--samples %d: expected 1, 2 or 4", options->samples);
    renderer->raster = choose_raster(gpu, options);
    renderer->base.shading = options->mesh_shading;
    Result result = divide(renderer, error);
    THEN(result,
         render_target_create(&renderer->target, renderer->part.width, renderer->part.height,
                              options->samples, options->kind, error));
    THEN(result, RASTERS[renderer->raster].create(renderer, error));
    THEN(result, make_base(renderer, error));
    // Dual scattering needs what C finds of shadows, whatever the driver.
    bool dual = options->scatter == SCATTER_DUAL && options->shadow.kind == SHADOW_DOM;
    ShadowOptions shadow = options->shadow;
    shadow.behind = dual;
    shadow.copies = gpu->kind == GPU_HARDWARE;
    if (options->shadow.kind != SHADOW_NONE)
        THEN(result, shadows_create(&renderer->shadow, &gpu->limits, &shadow,
                                    gpu->kind == GPU_CPU_DRIVER || dual, error));
    renderer->shadow.with_texels = gpu->kind == GPU_CPU_DRIVER;
    const HairScatterOptions scatter = {options->scatter,
                                        options->scatter_cells ? options->scatter_cells : 32,
                                        options->scatter_orders ? options->scatter_orders : 16};
    hair_scatter_create(&renderer->scatter, &gpu->limits, &scatter);
    if (result != RESULT_OK) renderer_destroy(renderer);
    return result;
}

void renderer_destroy(Renderer *renderer)
{
    render_target_destroy(&renderer->target);
    quads_destroy(&renderer->quads);
    blocks_destroy(&renderer->blocks);
    compute_destroy(&renderer->compute);
    base_layer_destroy(&renderer->base);
    shadows_destroy(&renderer->shadow);
    hair_scatter_destroy(&renderer->scatter);
    mesh_destroy(&renderer->mesh);
    free(renderer->casters);
    drawing_destroy(&renderer->drawing);
    image_destroy(&renderer->tile);
    *renderer = (Renderer){0};
}

static Result copy_mesh(Mesh *copy, const Mesh *mesh, Error *error)
{
    mesh_destroy(copy);
    TRY(mesh_create(copy, mesh->vertex_count, mesh->triangle_count, error));
    if (mesh->vertex_count)
        memcpy(copy->position, mesh->position, mesh->vertex_count * sizeof *mesh->position);
    if (mesh->triangle_count)
        memcpy(copy->triangle, mesh->triangle, mesh->triangle_count * sizeof *mesh->triangle);
    return RESULT_OK;
}

Result renderer_set_mesh(Renderer *renderer, const Mesh *mesh, const float color[3], Error *error)
{
    float linear[3];
    linear_from_srgb_color(color, linear);
    RenderMesh *mine = &renderer->base.mesh;
    renderer->base.any = false;
    shadows_forget_mesh(&renderer->shadow);
    render_mesh_destroy(mine);
    TRY(copy_mesh(&renderer->mesh, mesh, error));
    TRY(render_mesh_create(mine, mesh, linear, &renderer->gpu->limits, error));
    return make_base(renderer, error);
}

Result renderer_set_openness(Renderer *renderer, const float *open, Error *error)
{
    renderer->base.any = false;
    return render_mesh_set_openness(&renderer->base.mesh, open, renderer->mesh.vertex_count,
                                    &renderer->gpu->limits, error);
}

int renderer_channels(const Renderer *renderer)
{
    return renderer->options.background[3] < 1 ? 4 : 3;
}

static void set_state(const Renderer *renderer, const float background[4])
{
    const RendererOptions *options = &renderer->part;
    glViewport(0, 0, options->width * options->samples, options->height * options->samples);
    glDisable(GL_BLEND);
    glDisable(GL_CULL_FACE);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_SCISSOR_TEST);
    glDepthFunc(GL_LESS);
    glBindFramebuffer(GL_FRAMEBUFFER, renderer->target.image_frame);
    if (options->kind == IMAGE_FLOAT)
        glClearBufferfv(GL_COLOR, 0, background);
    else
        glClearBufferfv(GL_COLOR, 0, options->background);
}

static Result list_casters(Renderer *renderer, ShadowScene *scene, Error *error)
{
    const Drawing *drawing = &renderer->drawing;
    uint32_t count = 0;
    for (uint32_t i = 0; i < drawing->item_count; ++i) count += drawing->items[i].hair->batch_count;
    if (renderer->caster_room < count) {
        ShadowCaster *casters = realloc(renderer->casters, count * sizeof *casters);
        if (!casters) return error_set(error, RESULT_FAILED, "no memory for %u batches", count);
        renderer->casters = casters;
        renderer->caster_room = count;
    }
    for (uint32_t i = 0; i < drawing->item_count; ++i) {
        const RenderItem *item = &drawing->items[i];
        for (uint32_t b = 0; b < item->hair->batch_count; ++b)
            renderer->casters[scene->casters.count++] =
                (ShadowCaster){&item->hair->batches[b], drawing->looks[i]};
    }
    scene->casters.list = renderer->casters;
    return RESULT_OK;
}

// The mesh, where the head has carried it, among hair.
static LightMesh mesh_among_hair(const Renderer *renderer, const RenderFrame *frame)
{
    const Mesh *mesh = &renderer->mesh;
    LightMesh among = {.vertices = (const float(*)[3])mesh->position,
                       .triangles = (const uint32_t(*)[3])mesh->triangle,
                       .vertex_count = mesh->vertex_count,
                       .triangle_count = mesh->triangle_count};
    memcpy(among.rotation, frame->head_rotation, sizeof among.rotation);
    memcpy(among.translation, frame->head_translation, sizeof among.translation);
    return among;
}

// Shadows, then light among hair, and both to the looks.
static Result draw_light(Renderer *renderer, const HairScatterScene *scene, Error *error)
{
    Drawing *drawing = scene->drawing;
    bool scatters =
        renderer->options.shadow.kind == SHADOW_DOM && renderer->options.aov == AOV_NONE;
    if (scatters) TRY(hair_scatter_begin(&renderer->scatter, &renderer->shadow, scene, error));
    TRY(shadows_draw(&renderer->shadow, scene->shadow, renderer->timer, error));
    shadows_bind(&renderer->shadow);
    for (uint32_t i = 0; i < drawing->item_count; ++i) {
        Look *look = &drawing->looks[i];
        look->map_count = renderer->shadow.params.maps;
        if (renderer->shadow.mesh.texels.buffer && look->features & LOOK_SHADOW_BY_MESH)
            look->features |= LOOK_MESH_TEXELS;
        if (hair_shadow_lights(&renderer->shadow.hair, &look->lights, &look->batches)) {
            look->features |= LOOK_SHADOW_FOUND;
            if (renderer->shadow.hair.cpu.past_mesh)
                look->features &= ~(unsigned)(LOOK_SHADOW_BY_MESH | LOOK_MESH_TEXELS);
        }
    }
    activity_set("light among hair");
    return scatters ? hair_scatter_draw(&renderer->scatter, &renderer->shadow, scene,
                                        renderer->timer, error)
                    : RESULT_OK;
}

static Result draw_shadow(Renderer *renderer, const RenderFrame *frame, Error *error)
{
    Drawing *drawing = &renderer->drawing;
    ShadowScene shadow = {.lights = frame->lights,
                          .light_count = frame->light_count,
                          .mesh = {.mesh = &renderer->base.mesh},
                          .revision = frame->revision};
    if (renderer->options.shadow.kind == SHADOW_NONE) return RESULT_OK;
    memcpy(shadow.mesh.rotation, frame->head_rotation, sizeof shadow.mesh.rotation);
    memcpy(shadow.mesh.translation, frame->head_translation, sizeof shadow.mesh.translation);
    if (drawing->item_count) drawing_find_middle(drawing, drawing->items[0].hair, shadow.middle);
    TRY(list_casters(renderer, &shadow, error));
    LightMesh among = mesh_among_hair(renderer, frame);
    const HairScatterScene scene = {.shadow = &shadow,
                                    .view = frame->view,
                                    .drawing = drawing,
                                    .casters = shadow.casters,
                                    .mesh = among.triangle_count ? &among : NULL};
    return draw_light(renderer, &scene, error);
}

static Result add_base_to_quads(Renderer *renderer, Error *error)
{
    return quads_add_base(&renderer->quads, error);
}

static Result draw_quads(Renderer *renderer, Image *image, Error *error)
{
    (void)image;
    const CullBase base = {has_base(renderer) ? &renderer->target : NULL,
                           renderer->base.depth_version};
    return quads_draw(&renderer->quads, &renderer->drawing, &renderer->target, &base,
                      renderer->timer, &renderer->counts, error);
}

static Result settle_quads(Renderer *renderer, Error *error)
{
    if (!renderer->quads.unsettled) return RESULT_OK;
    // Others may have drawn since.
    if (renderer->options.shadow.kind != SHADOW_NONE) shadows_bind(&renderer->shadow);
    (has_base(renderer) ? glEnable : glDisable)(GL_DEPTH_TEST);
    glDepthMask(GL_FALSE);
    return quads_settle(&renderer->quads, &renderer->drawing, &renderer->target, has_base(renderer),
                        renderer->timer, &renderer->counts, error);
}

static Result take_quads(Renderer *renderer, int place, Image *image, Error *error)
{
    return quads_take(&renderer->target, place, image, error);
}

static void count_blocks(Renderer *renderer)
{
    const Blocks *blocks = &renderer->blocks;
    renderer->counts =
        (RendererCounts){.segments = blocks->segments,
                         .culled = blocks->culled,
                         .hidden = blocks->cull.hidden,
                         .fragments = blocks->touched,
                         .pool_bytes = blocks->raster.lists.pair_room * sizeof(uint64_t),
                         .bands = 1};
}

static Result project_items(Renderer *renderer, Error *error)
{
    const Drawing *drawing = &renderer->drawing;
    Result result = RESULT_OK;
    gpu_timer_begin(renderer->timer, "draw_project");
    for (uint32_t i = 0; i < drawing->item_count; ++i) {
        const Hair *hair = drawing->items[i].hair;
        for (uint32_t b = 0; b < hair->batch_count && result == RESULT_OK; ++b)
            result = blocks_add(&renderer->blocks, &hair->batches[b], &drawing->looks[i], error);
    }
    gpu_timer_end(renderer->timer);
    return result;
}

// The ribbons of all items.
static Result project(Renderer *renderer, Error *error)
{
    const Drawing *drawing = &renderer->drawing;
    const BlocksBase base = {
        .cull = {has_base(renderer) ? &renderer->target : NULL, renderer->base.depth_version},
        .version = renderer->base.version,
        .box = drawing->base_box,
        .depth = {drawing->draw.depth[0], drawing->draw.depth[1]}};
    Blocks *blocks = &renderer->blocks;
    uint64_t segments = drawing_count_segments(drawing);
    Result result = blocks_begin(blocks, segments, &base, error);
    if (result != RESULT_OK && blocks->most_slots > BLOCKS_MOST_SLOTS) {
        blocks->most_slots = BLOCKS_MOST_SLOTS; // a GPU without so much memory: piece by piece
        result = blocks_begin(blocks, segments, &base, error);
    }
    if (result != RESULT_OK) return result;
    return project_items(renderer, error);
}

static Result draw_blocks(Renderer *renderer, Image *image, Error *error)
{
    TRY(project(renderer, error));
    TRY(blocks_draw(&renderer->blocks, renderer->timer, image, error));
    count_blocks(renderer);
    return RESULT_OK;
}

static Result add_base_to_compute(Renderer *renderer, Error *error)
{
    return compute_add_base(&renderer->compute, error);
}

static void count_compute(Renderer *renderer, const ComputeCounts *counts)
{
    const ComputeBins *bins = &renderer->compute.bins;
    count_blocks(renderer);
    renderer->counts.fragments = counts->pairs;
    renderer->counts.pool_bytes = (uint64_t)(bins->pairs.size + bins->sorted.size);
    renderer->counts.redraws = counts->redraws;
    renderer->counts.bands = counts->bands;
}

static Result send_image(Renderer *renderer, bool again, Error *error)
{
    int place = again ? renderer->target.next ^ 1 : renderer->target.next;
    gpu_timer_begin(renderer->timer, "draw_read");
    Result result = render_target_send(&renderer->target, NULL, again, error);
    gpu_timer_end(renderer->timer);
    renderer->direct[place] = false;
    return result;
}

// Blocks draw what compute cannot, straight into the image.
static Result draw_directly(Renderer *renderer, bool again, Error *error)
{
    int place = again ? renderer->target.next ^ 1 : renderer->target.next;
    TRY(blocks_draw(&renderer->blocks, renderer->timer, renderer->begun, error));
    render_target_skip(&renderer->target, again);
    renderer->direct[place] = true;
    count_blocks(renderer);
    return RESULT_OK;
}

static Result draw_looking(Renderer *renderer, ComputeCounts counts, bool again, Error *error)
{
    Blocks *blocks = &renderer->blocks;
    bool drawn;
    TRY(compute_draw(&renderer->compute, blocks, &renderer->target, renderer->timer, &counts,
                     &drawn, error));
    if (!drawn) return draw_directly(renderer, again, error);
    if (!again) TRY(blocks_count(blocks, error));
    count_compute(renderer, &counts);
    return send_image(renderer, again, error);
}

static Result draw_compute(Renderer *renderer, Image *image, Error *error)
{
    Compute *compute = &renderer->compute;
    renderer->begun = image;
    compute->unsettled = false;
    TRY(project(renderer, error));
    if (renderer->blocks.stores) return draw_directly(renderer, false, error);
    if (!compute_trusts(compute)) return draw_looking(renderer, (ComputeCounts){0}, false, error);
    TRY(compute_begin(compute, &renderer->blocks, &renderer->target, renderer->timer, error));
    return send_image(renderer, false, error);
}

static Result settle_compute(Renderer *renderer, Error *error)
{
    ComputeCounts counts = {0};
    bool good, drawn;
    if (!renderer->compute.unsettled) return RESULT_OK;
    TRY(compute_settle(&renderer->compute, &renderer->blocks, &counts, &good, &drawn, error));
    if (good) count_compute(renderer, &counts);
    if (good) return RESULT_OK;
    return drawn ? draw_looking(renderer, counts, true, error)
                 : draw_directly(renderer, true, error);
}

static Result take_compute(Renderer *renderer, int place, Image *image, Error *error)
{
    uint32_t none;
    if (renderer->direct[place]) return RESULT_OK;
    return render_target_take(&renderer->target, place, image, &none, error);
}

static const RasterType RASTERS[] = {
    [RASTER_QUADS] = {create_quads, add_base_to_quads, draw_quads, settle_quads, take_quads},
    [RASTER_BLOCKS] = {create_blocks, NULL, draw_blocks, NULL, NULL},
    [RASTER_COMPUTE] = {create_compute, add_base_to_compute, draw_compute, settle_compute,
                        take_compute},
};

static Result draw_base(Renderer *renderer, Error *error)
{
    const Drawing *drawing = &renderer->drawing;
    const BaseScene scene = {.floor = &renderer->options.floor,
                             .shadow = &renderer->shadow,
                             .draw = &drawing->draw,
                             .mesh_box = drawing->mesh_box,
                             .box = drawing->base_box};
    return base_layer_draw(&renderer->base, &scene, &renderer->target, renderer->timer, error);
}

static Result draw_window(Renderer *renderer, Image *image, Error *error)
{
    drawing_upload(&renderer->drawing);
    set_state(renderer, renderer->drawing.draw.background);
    TRY(draw_base(renderer, error));
    return RASTERS[renderer->raster].draw(renderer, image, error);
}

static void add_counts(RendererCounts *sum, const RendererCounts *counts)
{
    sum->segments += counts->segments;
    sum->culled += counts->culled;
    sum->hidden += counts->hidden;
    sum->fragments += counts->fragments;
    sum->redraws += counts->redraws;
    sum->bands += counts->bands;
    if (counts->pool_bytes > sum->pool_bytes) sum->pool_bytes = counts->pool_bytes;
}

// What is late elsewhere is not here: the next tile has the same target.
static Result finish_tile(Renderer *renderer, int sent, Error *error)
{
    const RasterType *raster = &RASTERS[renderer->raster];
    if (raster->settle) TRY(raster->settle(renderer, error));
    return raster->take ? raster->take(renderer, sent, &renderer->tile, error) : RESULT_OK;
}

static Result draw_tiles(Renderer *renderer, Image *image, Error *error)
{
    const Tiles *tiles = &renderer->tiles;
    RendererCounts sum = {0};
    for (int i = 0; i < tiles_count(tiles); ++i) {
        int place[2], size[] = {tiles->width, tiles->height}, sent = renderer->target.next;
        tiles_place(tiles, i, place);
        drawing_set_window(&renderer->drawing, &renderer->options, &renderer->base.mesh, place,
                           size);
        renderer->counts = (RendererCounts){0};
        TRY(draw_window(renderer, &renderer->tile, error));
        TRY(finish_tile(renderer, sent, error));
        tiles_copy(tiles, i, &renderer->tile, image);
        add_counts(&sum, &renderer->counts);
    }
    renderer->counts = sum;
    return RESULT_OK;
}

// What no raster knows.
static void count_image(Renderer *renderer)
{
    renderer->counts.thinned = drawing_count_thinned(&renderer->drawing);
    renderer->counts.shadow_maps = renderer->shadow.maps_drawn;
}

Result renderer_begin(Renderer *renderer, const RenderFrame *frame, const RenderItem *items,
                      uint32_t item_count, Image *image, Error *error)
{
    assert(image->width == renderer->options.width && image->height == renderer->options.height);
    assert(image->channels == renderer_channels(renderer));
    TRY(drawing_begin(&renderer->drawing, &renderer->options, &renderer->base.mesh, frame, items,
                      item_count, error));
    renderer->counts = (RendererCounts){0};
    drawing_upload(&renderer->drawing);
    activity_set("shadows");
    TRY(draw_shadow(renderer, frame, error));
    activity_set("drawing");
    if (tiles_count(&renderer->tiles) == 1)
        TRY(draw_window(renderer, image, error));
    else
        TRY(draw_tiles(renderer, image, error));
    count_image(renderer);
    return gpu_check("drawing", error);
}

bool renderer_is_late(const Renderer *renderer)
{
    return RASTERS[renderer->raster].take && tiles_count(&renderer->tiles) == 1;
}

int renderer_place(const Renderer *renderer)
{
    return renderer->target.next;
}

Result renderer_settle(Renderer *renderer, Error *error)
{
    const RasterType *raster = &RASTERS[renderer->raster];
    if (!renderer_is_late(renderer) || !raster->settle) return RESULT_OK;
    TRY(raster->settle(renderer, error));
    count_image(renderer);
    return RESULT_OK;
}

Result renderer_take(Renderer *renderer, int place, Image *image, Error *error)
{
    const RasterType *raster = &RASTERS[renderer->raster];
    if (!renderer_is_late(renderer)) return RESULT_OK;
    TRY(raster->take(renderer, place, image, error));
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
