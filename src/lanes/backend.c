// SPDX-License-Identifier: MIT
#include "draw/backend.h"

#include "lanes/lanes.h"

#include <stdlib.h>
#include <string.h>

static void forget_room(Lanes *lanes)
{
    for (uint32_t i = 0; i < lanes->room; ++i) tint_table_destroy(&lanes->batches[i].tints);
    free(lanes->batches);
    free(lanes->hair);
    free(lanes->casters);
    lanes->batches = NULL, lanes->hair = NULL, lanes->casters = NULL;
    lanes->room = 0;
}

static void destroy(void *state)
{
    Lanes *lanes = state;
    if (!lanes) return;
    lane_shadow_destroy(&lanes->shadow);
    lane_scatter_destroy(&lanes->scatter);
    lane_base_destroy(&lanes->base);
    hidden_destroy(&lanes->hidden);
    shadow_points_destroy(&lanes->points);
    projection_destroy(&lanes->projection);
    shades_destroy(&lanes->shades);
    raster_destroy(&lanes->raster);
    forget_room(lanes);
    free(lanes);
}

static Result create(void **state, const BackendOptions *set, Error *error)
{
    const RendererOptions *options = set->options;
    Lanes *lanes = calloc(1, sizeof *lanes);
    if (!lanes) return error_set(error, RESULT_FAILED, "no memory to draw hair");
    *lanes = (Lanes){.set = *set, .options = options, .scatters = scatter_options(options)};
    Result result = raster_create(&lanes->raster, options->width * options->samples,
                                  options->height * options->samples, error);
    if (options->shadow.kind != SHADOW_NONE)
        THEN(result, lane_shadow_create(&lanes->shadow, &options->shadow, error));
    if (result == RESULT_OK)
        *state = lanes;
    else
        destroy(lanes);
    return result;
}

// Does nothing: the mesh is rasterised in each frame anyway.
static Result set_mesh(void *state, const DrawnMesh *mesh, Error *error)
{
    (void)state, (void)mesh, (void)error;
    return RESULT_OK;
}

// --- Hair.

static Result make_room(Lanes *lanes, uint32_t count, Error *error)
{
    if (lanes->room >= count) return RESULT_OK;
    forget_room(lanes);
    lanes->batches = calloc(count, sizeof *lanes->batches);
    lanes->hair = calloc(count, sizeof *lanes->hair);
    lanes->casters = calloc(count, sizeof *lanes->casters);
    lanes->room = lanes->batches && lanes->hair && lanes->casters ? count : 0;
    return lanes->room ? RESULT_OK
                       : error_set(error, RESULT_FAILED, "no memory for %u batches", count);
}

static LaneModel model_of(const Look *look)
{
    switch (look->features / LOOK_SHADED) {
    case LOOK_WHITE / LOOK_SHADED:
        return LANE_WHITE;
    case LOOK_TANGENT / LOOK_SHADED:
        return LANE_TANGENT;
    case LOOK_STRAND / LOOK_SHADED:
        return LANE_STRAND;
    default:
        return !(look->features & LOOK_MARSCHNER) ? LANE_KAJIYA
               : look->features & LOOK_GAUSS      ? LANE_GAUSS
                                                  : LANE_MARSCHNER;
    }
}

// If a section's strands differ only in brightness, makes a table for its colour (tint_table.h).
static Result open_look(LaneBatch *batch, const DrawnHair *drawn, Error *error)
{
    const MaterialParams *m = &drawn->material;
    batch->look = (LaneLook){.model = model_of(drawn->look), .table = drawn->look->table.values};
    bool lit = batch->look.model == LANE_MARSCHNER || batch->look.model == LANE_GAUSS;
    if (!lit || drawn->paint || m->warmth_variation != 0) return RESULT_OK;
    TRY(tint_table_make(&batch->tints, drawn->look->table, m->color, m->color_variation, error));
    batch->look.tints = &batch->tints;
    return RESULT_OK;
}

static Result open_hair(Lanes *lanes, const BackendFrame *frame, Error *error)
{
    LaneHairs *hairs = &lanes->hairs;
    TRY(make_room(lanes, frame->hair_count, error));
    *hairs = (LaneHairs){.list = lanes->hair, .count = frame->hair_count};
    for (uint32_t i = 0; i < frame->hair_count; ++i) {
        const DrawnHair *drawn = &frame->hair[i];
        lanes->casters[i] = (MappedCaster){
            .position = drawn->position, .paint = drawn->paint, .material = drawn->material};
        TRY(open_look(&lanes->batches[i], drawn, error));
    }
    shadow_points_find(&lanes->points, lanes->casters, hairs->count, parallel_threads());
    for (uint32_t i = 0; i < frame->hair_count; ++i) {
        LaneHair *hair = &lanes->hair[i];
        *hair = (LaneHair){.caster = lanes->casters[i],
                           .ids = frame->hair[i].ids,
                           .look = &lanes->batches[i].look,
                           .points = (uint32_t)mapped_caster_points(&lanes->casters[i]),
                           .first_tile = hairs->tiles,
                           .first_point = hairs->points};
        hair->tiles = ((size_t)hair->caster.material.drawn_strands + STRAND_TILE - 1) / STRAND_TILE;
        hairs->tiles += hair->tiles;
        hairs->points += hair->tiles * STRAND_TILE * hair->points;
    }
    if (hairs->points >= UINT32_MAX)
        return error_set(error, RESULT_FAILED,
                         "%zu points of hair: at most %u can be drawn at once", hairs->points,
                         UINT32_MAX - 1);
    return RESULT_OK;
}

// --- Light.

static PlacedMesh placed_mesh(const BackendFrame *frame)
{
    const DrawnMesh *drawn = frame->mesh;
    PlacedMesh mesh = {.position = (const float(*)[3])drawn->mesh.position,
                       .normal = (const float(*)[3])drawn->mesh.normal,
                       .open = (const float(*)[2])drawn->open,
                       .tint = (const float(*)[3])drawn->tint,
                       .triangle = (const uint32_t(*)[3])drawn->mesh.triangle,
                       .vertex_count = drawn->mesh.vertex_count,
                       .triangle_count = drawn->mesh.triangle_count};
    memcpy(mesh.rotation, frame->frame->head_rotation, sizeof mesh.rotation);
    memcpy(mesh.translation, frame->frame->head_translation, sizeof mesh.translation);
    return mesh;
}

static Result draw_shadow(Lanes *lanes, const BackendFrame *frame, Error *error)
{
    PlacedMesh mesh = placed_mesh(frame);
    LaneShadowScene scene = {.lights = frame->frame->lights,
                             .light_count = frame->frame->light_count,
                             .casters = {lanes->casters, frame->hair_count},
                             .mesh = mesh.triangle_count ? &mesh : NULL,
                             .mesh_version = frame->mesh->version,
                             .revision = frame->frame->revision};
    memcpy(scene.mesh_low, frame->mesh->low, sizeof scene.mesh_low);
    memcpy(scene.mesh_high, frame->mesh->high, sizeof scene.mesh_high);
    memcpy(scene.middle, frame->middle, sizeof scene.middle);
    return lane_shadow_draw(&lanes->shadow, &scene, error);
}

static Result shadow(void *state, const BackendFrame *frame, Error *error)
{
    Lanes *lanes = state;
    const BackendTimer *timer = &lanes->set.timer;
    Result result = open_hair(lanes, frame, error);
    lanes->light = (LaneLight){.draw = &frame->drawing->draw};
    if (result != RESULT_OK || lanes->options->shadow.kind == SHADOW_NONE) return result;
    timer->begin(timer->timer, "draw_shadow");
    result = draw_shadow(lanes, frame, error);
    timer->end(timer->timer);
    lanes->light.shadow = &lanes->shadow;
    return result;
}

static Result scatter(void *state, const BackendFrame *frame, Error *error)
{
    Lanes *lanes = state;
    const BackendTimer *timer = &lanes->set.timer;
    bool shown = false;
    if (!lanes->light.shadow) return RESULT_OK;
    timer->begin(timer->timer, "draw_scatter");
    Result result = lane_scatter_draw(&lanes->scatter, &lanes->scatters, frame, lanes->casters,
                                      &lanes->shadow, &shown, error);
    timer->end(timer->timer);
    lanes->light.grid = shown ? &lanes->scatter.grid : NULL;
    for (uint32_t i = 0; i < frame->hair_count && shown; ++i)
        lanes->batches[i].look.kind = lanes->scatter.hair[i].kind;
    return result;
}

// --- A window.

static bool has_base(const Lanes *lanes, const BackendFrame *frame)
{
    return frame->mesh->mesh.triangle_count > 0 || lanes->options->floor.kind != FLOOR_NONE ||
           lanes->options->backdrop;
}

static Result draw_base(Lanes *lanes, const BackendFrame *frame, Error *error)
{
    const Drawing *drawing = frame->drawing;
    const LaneBaseScene scene = {.mesh = placed_mesh(frame),
                                 .mesh_version = frame->mesh->version,
                                 .shading = lanes->options->mesh_shading,
                                 .floor = &lanes->options->floor,
                                 .shadow = lanes->light.shadow,
                                 .grid = lanes->light.grid,
                                 .draw = &drawing->draw,
                                 .backdrop = lanes->options->backdrop ? &drawing->backdrop : NULL,
                                 .samples = lanes->options->samples,
                                 .mesh_box = drawing->mesh_box,
                                 .box = drawing->base_box};
    return lane_base_draw(&lanes->base, &scene, error);
}

static Result project(Lanes *lanes, const BackendFrame *frame, Error *error)
{
    const DrawParams *draw = &frame->drawing->draw;
    const float depth[2] = {draw->depth[0], draw->depth[1]};
    bool hides = has_base(lanes, frame) && !lanes->draws_hidden;
    if (hides && lanes->hidden.version != lanes->base.depth_version) {
        TRY(hidden_find(&lanes->hidden, &lanes->base.shown, depth, (int)draw->width,
                        (int)draw->height, error));
        lanes->hidden.version = lanes->base.depth_version;
    }
    TRY(shades_begin(&lanes->shades, lanes->hairs.points + 1, error));
    return projection_find(&lanes->projection, &lanes->hairs, draw, hides ? &lanes->hidden : NULL,
                           lanes->options->ribbon_length, lanes->raster.bins.part_room, error);
}

static Result shade(void *state, const BackendFrame *frame, Error *error)
{
    Lanes *lanes = state;
    const BackendTimer *timer = &lanes->set.timer;
    Result result = RESULT_OK;
    if (has_base(lanes, frame)) {
        timer->begin(timer->timer, "draw_mesh");
        result = draw_base(lanes, frame, error);
        timer->end(timer->timer);
    }
    timer->begin(timer->timer, "draw_project");
    THEN(result, project(lanes, frame, error));
    timer->end(timer->timer);
    return result;
}

static PixelStyle style_of(const RendererOptions *options, const DrawParams *draw)
{
    PixelStyle style = {.samples = options->samples,
                        .tone = drawing_display(options),
                        .shows_depth = options->aov == AOV_DEPTH,
                        .depth_range = {options->depth_range[0], options->depth_range[1]},
                        .depth = {draw->depth[0], draw->depth[1]}};
    drawing_background(options, style.background);
    drawing_backing(options, style.backing);
    return style;
}

static Result composite(void *state, const BackendFrame *frame, Image *image, Error *error)
{
    Lanes *lanes = state;
    const BackendTimer *timer = &lanes->set.timer;
    const DrawParams *draw = &frame->drawing->draw;
    const RasterScene scene = {.ribbons = {lanes->projection.points,
                                           {&lanes->hairs, &lanes->light, &lanes->shades},
                                           lanes->options->least_seen},
                               .base = has_base(lanes, frame) ? &lanes->base.shown : NULL,
                               .style = style_of(lanes->options, draw),
                               .nearest = lanes->options->aov > AOV_COVERAGE,
                               .image = image};
    timer->begin(timer->timer, "draw_bin");
    Result result = raster_bin(&lanes->raster, &lanes->projection, error);
    timer->end(timer->timer);
    timer->begin(timer->timer, "draw_composite");
    if (result == RESULT_OK) raster_draw(&lanes->raster, &scene);
    timer->end(timer->timer);
    return result;
}

static void count(const void *state, RendererCounts *counts)
{
    const Lanes *lanes = state;
    const Projection *projection = &lanes->projection;
    const Bins *bins = &lanes->raster.bins;
    *counts = (RendererCounts){.fragments = bins->begins[bins_count(bins)],
                               .pool_bytes = bins->pair_room * sizeof *bins->pairs,
                               .shadow_maps = (uint32_t)lanes->shadow.maps_drawn,
                               .bands = 1};
    for (int part = 0; part < projection->parts; ++part) {
        counts->segments += projection->item_count[part];
        counts->culled += projection->culled[part];
        counts->hidden += projection->hidden[part];
    }
}

const DrawBackend DRAW_LANES = {
    .reads_hair = true,
    .create = create,
    .destroy = destroy,
    .set_mesh = set_mesh,
    .shadow = shadow,
    .scatter = scatter,
    .shade = shade,
    .composite = composite,
    .count = count,
};
