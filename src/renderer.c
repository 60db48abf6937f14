// SPDX-License-Identifier: MIT
#include "renderer.h"

#include "render_uniforms.h"
#include "tone.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { OIT_LAYERS = 8 };

// Light on the mesh that comes from everywhere.
static const float MESH_AMBIENT = 0.15f;

// What all bands of one picture share.
typedef struct Picture {
    DrawParams draw; // with the values of the band that is being drawn
    const RenderItem *items;
    uint32_t item_count;
    const Look *looks; // of the items
    int mesh_box[4];
} Picture;

// A way from hair to pixels.
typedef struct RasterType {
    Result (*create)(Renderer *renderer, Error *error);
    Result (*add_mesh)(Renderer *renderer, Error *error);
    Result (*draw)(Renderer *renderer, Picture *picture, Image *image, Error *error);
} RasterType;
static const RasterType RASTERS[3];

static bool needs_quads(const RendererOptions *options)
{
    return options->kind != IMAGE_8 || options->aov != AOV_NONE;
}

static int display_of(const RendererOptions *options)
{
    bool light = options->kind == IMAGE_FLOAT || options->aov != AOV_NONE;
    return light ? TONE_LIGHT : (int)options->tone;
}

static Result create_quads(Renderer *renderer, Error *error)
{
    const RendererOptions *options = &renderer->options;
    const GpuLimits *limits = &renderer->gpu->limits;
    int layers = options->oit == OIT_NONE  ? (options->aov == AOV_DEPTH)
                 : options->oit_layers > 0 ? options->oit_layers
                                           : OIT_LAYERS;
    bool nearest = options->aov > AOV_COVERAGE;
    Result result = render_hair_create(&renderer->hair, nearest, error);
    if (result == RESULT_OK)
        result = render_abuffer_create(&renderer->abuffer, limits, options->width, layers,
                                       display_of(options), options->aov == AOV_DEPTH,
                                       renderer->gpu->software, options->pool_bytes, error);
    if (result == RESULT_OK)
        renderer->band_rows = render_abuffer_most_rows(&renderer->abuffer, options->height);
    return result;
}

static Result create_blocks(Renderer *renderer, Error *error)
{
    const RendererOptions *options = &renderer->options;
    return render_blocks_create(&renderer->blocks, &renderer->gpu->limits, options->width,
                                options->height, options->background, options->tone,
                                options->pool_bytes, error);
}

Result renderer_create(Renderer *renderer, const Gpu *gpu, GpuTimer *timer,
                       const RendererOptions *options, Error *error)
{
    *renderer = (Renderer){.options = *options, .gpu = gpu, .timer = timer};
    if (options->aov != AOV_NONE) { // on black, without light
        memcpy(renderer->options.background, (float[4]){0, 0, 0, 1}, 4 * sizeof(float));
        renderer->options.shadow.kind = SHADOW_NONE;
    }
    renderer->raster = needs_quads(options)             ? RASTER_QUADS
                       : options->raster != RASTER_AUTO ? options->raster
                       : gpu->software && options->oit == OIT_AUTO && options->oit_layers == 0
                           ? RASTER_BLOCKS
                           : RASTER_QUADS;
    Result result = render_target_create(&renderer->target, &gpu->limits, options->width,
                                         options->height, options->kind, error);
    if (result == RESULT_OK) result = RASTERS[renderer->raster].create(renderer, error);
    if (result == RESULT_OK && renderer->options.shadow.kind != SHADOW_NONE)
        result = render_shadow_create(&renderer->shadow, &gpu->limits, &options->shadow, error);
    if (result != RESULT_OK) renderer_destroy(renderer);
    return result;
}

void renderer_destroy(Renderer *renderer)
{
    render_target_destroy(&renderer->target);
    render_hair_destroy(&renderer->hair);
    render_abuffer_destroy(&renderer->abuffer);
    render_blocks_destroy(&renderer->blocks);
    render_mesh_destroy(&renderer->mesh);
    render_shadow_destroy(&renderer->shadow);
    free(renderer->casters);
    scatter_tables_destroy(&renderer->scatter);
    free(renderer->looks);
    gpu_buffer_destroy(&renderer->draw_uniforms);
    *renderer = (Renderer){0};
}

Result renderer_set_mesh(Renderer *renderer, const Mesh *mesh, const float color[3], Error *error)
{
    float linear[3];
    linear_from_srgb_color(color, linear);
    render_mesh_destroy(&renderer->mesh);
    Result result = render_mesh_create(&renderer->mesh, mesh, linear, renderer->options.shadow.kind,
                                       &renderer->gpu->limits, error);
    if (result == RESULT_OK && renderer->mesh.triangle_count)
        result = render_target_add_mesh(&renderer->target, error);
    if (result == RESULT_OK && renderer->mesh.triangle_count)
        result = RASTERS[renderer->raster].add_mesh(renderer, error);
    return result;
}

int renderer_channels(const Renderer *renderer)
{
    return renderer->options.background[3] < 1 ? 4 : 3;
}

// The picture without the band's values.
static void fill_draw_params(const Renderer *renderer, const RenderFrame *frame, DrawParams *draw)
{
    const RendererOptions *options = &renderer->options;
    memset(draw, 0, sizeof *draw);
    draw_params_set_view(draw, frame->view, options->width, options->height);
    float light = exp2f(options->exposure);
    draw_params_set_lights(draw, frame->lights, frame->light_count);
    for (int k = 0; k < 3; ++k) {
        draw->sky[k] = light * (frame->ambient ? linear_from_srgb(frame->ambient->sky[k]) : 1);
        draw->ground[k] =
            light * (frame->ambient ? linear_from_srgb(frame->ambient->ground[k]) : 1);
        for (uint32_t i = 0; i < frame->light_count; ++i) draw->light_color[i][k] *= light;
    }
    memcpy(draw->depth_range, options->depth_range, sizeof options->depth_range);
    linear_from_srgb_color(options->background, draw->background);
    for (int k = 0; k < 3; ++k)
        draw->background[k] =
            options->background[3] * (float)tone_unmap(options->tone, (double)draw->background[k]);
    draw->background[3] = options->background[3];
    memcpy(draw->head_rotation, frame->head_rotation, sizeof draw->head_rotation);
    memcpy(draw->head_translation, frame->head_translation, sizeof frame->head_translation);
    if (options->aov == AOV_NONE)
        memcpy(draw->mesh_color, renderer->mesh.color, sizeof renderer->mesh.color);
    draw->mesh_color[3] = MESH_AMBIENT;
    draw->seed = options->seed;
}

// Screen box of the mesh (px; empty without one): what must be resolved where there is no hair.
static void find_mesh_box(const Renderer *renderer, DrawParams *draw, int box[4])
{
    const RenderMesh *mesh = &renderer->mesh;
    const int far = 1 << 20;
    box[0] = box[1] = far, box[2] = box[3] = -far;
    for (int corner = 0; corner < 8 && mesh->triangle_count; ++corner) {
        vec4 clip;
        vec3 x;
        for (int k = 0; k < 3; ++k) x[k] = (corner >> k & 1 ? mesh->high : mesh->low)[k];
        glm_quat_rotatev(draw->head_rotation, x, x);
        glm_vec3_add(x, draw->head_translation, x);
        glm_mat4_mulv(draw->clip_from_world, (vec4){x[0], x[1], x[2], 1}, clip);
        if (clip[3] < draw->near_distance) { // crosses the eye's plane: anywhere
            box[0] = box[1] = 0, box[2] = box[3] = far;
            return;
        }
        for (int k = 0; k < 2; ++k) {
            float size = k ? draw->height : draw->width, px = (clip[k] / clip[3] + 1) * size / 2;
            px = fmaxf(fminf(px, (float)far - 2), 2 - (float)far);
            box[k] = (int)fminf((float)box[k], floorf(px) - 1);
            box[k + 2] = (int)fmaxf((float)box[k + 2], ceilf(px) + 1);
        }
    }
}

// The band's lists; measured, but not resolved yet.
static Result draw_band(Renderer *renderer, Picture *picture, int row, int rows, Error *error)
{
    Result result = render_abuffer_begin(&renderer->abuffer, rows, picture->mesh_box, error);
    DrawParams *draw = &picture->draw;
    draw->band[1] = (uint32_t)row;
    draw->band[2] = (uint32_t)(row + rows);
    draw->band[3] = (uint32_t)render_abuffer_shard_nodes(&renderer->abuffer);
    draw->shards = (uint32_t)renderer->abuffer.shards;
    gpu_uniforms_set(&renderer->draw_uniforms, BIND_DRAW, draw, sizeof *draw);
    glBindFramebuffer(GL_FRAMEBUFFER, renderer->target.hair_frame);
    glScissor(0, row, renderer->options.width, rows);
    for (uint32_t i = 0; i < picture->item_count; ++i) {
        const Hair *hair = picture->items[i].hair;
        for (uint32_t b = 0; b < hair->batch_count && result == RESULT_OK; ++b)
            result = render_hair_draw(&renderer->hair, &hair->batches[b], &picture->looks[i],
                                      &renderer->gpu->limits, renderer->timer, error);
    }
    return result;
}

// Rows that fill the pool well if hair is as dense in them as in a band of `rows` with this use:
// some room is left, since a band that does not fit is drawn again. Not many more than before,
// lest one sparse band speaks for all the rest.
static int rows_that_fit(const Renderer *renderer, const ABufferUse *use, int rows)
{
    double capacity = render_abuffer_shard_nodes(&renderer->abuffer);
    double share = fmin(0.85 * capacity / fmax(use->fullest, 1), 1.5);
    int most = render_abuffer_most_rows(&renderer->abuffer, renderer->options.height);
    return (int)fmax(1, fmin(rows * share, most));
}

// After a band that did not fit: a larger pool or, where there can be none, fewer rows.
static Result make_it_fit(Renderer *renderer, const ABufferUse *use, int *rows, Error *error)
{
    bool grown;
    Result result = render_abuffer_grow(&renderer->abuffer, use, &grown, error);
    if (result != RESULT_OK || grown) return result;
    if (*rows == 1)
        return error_set(error, RESULT_FAILED,
                         "one row of the picture has %llu hair fragments, more than an A-buffer of "
                         "%lld bytes holds",
                         (unsigned long long)use->fragments,
                         (long long)renderer->abuffer.nodes.size);
    *rows = rows_that_fit(renderer, use, *rows);
    return RESULT_OK;
}

static void resolve_band(Renderer *renderer, const ABufferUse *use)
{
    RendererCounts *counts = &renderer->counts;
    gpu_timer_begin(renderer->timer, "draw_resolve");
    render_abuffer_resolve(&renderer->abuffer, &renderer->target,
                           renderer->mesh.triangle_count > 0);
    gpu_timer_end(renderer->timer);
    counts->fragments += use->fragments;
    counts->segments += use->segments;
    counts->culled += use->culled;
    ++counts->bands;
}

static Result draw_bands(Renderer *renderer, Picture *picture, Error *error)
{
    int height = renderer->options.height, rows = renderer->band_rows;
    for (int row = 0; row < height;) {
        ABufferUse use;
        if (rows > height - row) rows = height - row;
        Result result = draw_band(renderer, picture, row, rows, error);
        if (result != RESULT_OK) return result;
        render_abuffer_measure(&renderer->abuffer, &use);
        if (render_abuffer_holds(&renderer->abuffer, &use)) {
            resolve_band(renderer, &use);
            row += rows;
            rows = rows_that_fit(renderer, &use, rows);
            continue;
        }
        ++renderer->counts.redraws;
        result = make_it_fit(renderer, &use, &rows, error);
        if (result != RESULT_OK) return result;
        if (row == 0) renderer->band_rows = rows;
    }
    return RESULT_OK;
}

static void set_state(const Renderer *renderer, const float background[4])
{
    const RendererOptions *options = &renderer->options;
    glViewport(0, 0, options->width, options->height);
    glDisable(GL_BLEND);
    glDisable(GL_CULL_FACE);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_SCISSOR_TEST);
    glDepthFunc(GL_LESS);
    glBindFramebuffer(GL_FRAMEBUFFER, renderer->target.picture_frame);
    if (options->kind == IMAGE_FLOAT)
        glClearBufferfv(GL_COLOR, 0, background);
    else
        glClearBufferfv(GL_COLOR, 0, options->background);
}

// Whether the lights ask for more than directions and one ambient colour.
static bool lights_are_simple(const RenderFrame *frame)
{
    for (uint32_t i = 0; i < frame->light_count; ++i)
        if (frame->lights[i].kind != LIGHT_DIRECTIONAL) return false;
    const Ambient *ambient = frame->ambient;
    return !ambient || memcmp(ambient->sky, ambient->ground, sizeof ambient->sky) == 0;
}

// The middle of hair's style, carried by the head: m, world.
static void find_middle(const Picture *picture, const Hair *hair, vec3 middle)
{
    versor turn = {0};
    memcpy(turn, picture->draw.head_rotation, sizeof turn);
    for (int k = 0; k < 3; ++k) middle[k] = 0.5f * (hair->low[k] + hair->high[k]);
    glm_quat_rotatev(turn, middle, middle);
    for (int k = 0; k < 3; ++k) middle[k] += picture->draw.head_translation[k];
}

static bool uses_lod(const LodOptions *lod)
{
    return lod->end > lod->start || lod->width > 0;
}

// Share of an item's strands that is drawn.
static float find_share(const LodOptions *lod, const Picture *picture, const RenderItem *item)
{
    const DrawParams *draw = &picture->draw;
    vec3 middle = {0}, eye = {draw->eye[0], draw->eye[1], draw->eye[2]};
    find_middle(picture, item->hair, middle);
    float distance = fmaxf(glm_vec3_distance(middle, eye), draw->near_distance), share = 1;
    if (lod->end > lod->start)
        share -= (1 - lod->least) *
                 fminf(fmaxf((distance - lod->start) / (lod->end - lod->start), 0), 1);
    if (lod->width > 0)
        share = fminf(share, 2 * item->radius * draw->focal / (distance * lod->width));
    return fmaxf(share, lod->least);
}

static unsigned shadow_features(const Renderer *renderer)
{
    unsigned by_mesh = renderer->mesh.triangle_count ? LOOK_SHADOW_BY_MESH : 0;
    switch (renderer->options.shadow.kind) {
    case SHADOW_APPROX:
        return LOOK_SHADOW_APPROX | by_mesh;
    case SHADOW_DOM:
        return LOOK_SHADOW_DOM | by_mesh;
    default:
        return 0;
    }
}

static Result make_looks(Renderer *renderer, Picture *picture, const RenderFrame *frame,
                         Error *error)
{
    if (renderer->look_room < picture->item_count) {
        Look *looks = realloc(renderer->looks, picture->item_count * sizeof *looks);
        if (!looks)
            return error_set(error, RESULT_FAILED, "no memory for %u sections",
                             picture->item_count);
        renderer->looks = looks;
        renderer->look_room = picture->item_count;
    }
    picture->looks = renderer->looks;
    static const unsigned aovs[] = {0, LOOK_WHITE, LOOK_WHITE, LOOK_TANGENT, LOOK_STRAND}; // by Aov
    unsigned lights = (lights_are_simple(frame) ? 0 : LOOK_LIGHTS) | shadow_features(renderer),
             aov = aovs[renderer->options.aov];
    for (uint32_t i = 0; i < picture->item_count; ++i) {
        const RenderItem *item = &picture->items[i];
        Look *look = &renderer->looks[i];
        *look = (Look){.material = material_params(item->material, item->radius),
                       .features = aov ? aov : lights,
                       .share = 1};
        if (uses_lod(&renderer->options.lod))
            look->share = find_share(&renderer->options.lod, picture, item);
        look->material.radius /= look->share;
        if (item->material->smooth > 1) look->features |= LOOK_SMOOTH;
        if (item->hair->alike) look->material.color_variation = look->material.warmth_variation = 0;
        if (aov || item->material->shading != SHADING_MARSCHNER) continue;
        look->features |= LOOK_MARSCHNER;
        if (item->material->lobes == LOBES_GAUSS) look->features |= LOOK_GAUSS;
        Result result = scatter_tables_find(&renderer->scatter, item->material->refraction,
                                            glm_rad(item->material->azimuthal_roughness),
                                            &look->scatter, error);
        if (result != RESULT_OK) return result;
    }
    return RESULT_OK;
}

static Result list_casters(Renderer *renderer, const Picture *picture, ShadowScene *scene,
                           Error *error)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < picture->item_count; ++i) count += picture->items[i].hair->batch_count;
    if (renderer->caster_room < count) {
        ShadowCaster *casters = realloc(renderer->casters, count * sizeof *casters);
        if (!casters) return error_set(error, RESULT_FAILED, "no memory for %u batches", count);
        renderer->casters = casters;
        renderer->caster_room = count;
    }
    for (uint32_t i = 0; i < picture->item_count; ++i) {
        const RenderItem *item = &picture->items[i];
        for (uint32_t b = 0; b < item->hair->batch_count; ++b)
            renderer->casters[scene->caster_count++] =
                (ShadowCaster){&item->hair->batches[b], item->radius, item->material->tip_ratio,
                               item->material->shadow_opacity};
    }
    scene->casters = renderer->casters;
    return RESULT_OK;
}

static Result draw_shadow(Renderer *renderer, const RenderFrame *frame, const Picture *picture,
                          Error *error)
{
    ShadowScene scene = {.lights = frame->lights,
                         .light_count = frame->light_count,
                         .mesh = &renderer->mesh,
                         .revision = frame->revision};
    if (renderer->options.shadow.kind == SHADOW_NONE) return RESULT_OK;
    memcpy(scene.head_rotation, frame->head_rotation, sizeof scene.head_rotation);
    memcpy(scene.head_translation, frame->head_translation, sizeof scene.head_translation);
    if (picture->item_count) find_middle(picture, picture->items[0].hair, scene.middle);
    Result result = list_casters(renderer, picture, &scene, error);
    if (result == RESULT_OK)
        result = render_shadow_draw(&renderer->shadow, &scene, renderer->timer, error);
    if (result == RESULT_OK) render_shadow_bind(&renderer->shadow);
    return result;
}

static void draw_mesh(Renderer *renderer, const DrawParams *draw)
{
    if (!renderer->mesh.triangle_count) return;
    gpu_timer_begin(renderer->timer, "draw_mesh");
    render_mesh_draw(&renderer->mesh, &renderer->target, draw->background);
    gpu_timer_end(renderer->timer);
}

static Result add_mesh_to_quads(Renderer *renderer, Error *error)
{
    return render_abuffer_add_mesh(&renderer->abuffer, error);
}

static Result draw_quads(Renderer *renderer, Picture *picture, Image *image, Error *error)
{
    find_mesh_box(renderer, &picture->draw, picture->mesh_box);
    glEnable(GL_SCISSOR_TEST);
    Result result = draw_bands(renderer, picture, error);
    glDisable(GL_SCISSOR_TEST);
    if (result != RESULT_OK) return result;
    gpu_timer_begin(renderer->timer, "draw_read");
    render_target_read(&renderer->target, image);
    bool short_of_turns = render_abuffer_fell_short(&renderer->abuffer);
    gpu_timer_end(renderer->timer);
    if (short_of_turns)
        return error_set(error, RESULT_FAILED,
                         "a pixel has more than %d hair fragments, more than this driver's loops "
                         "can visit",
                         ABUFFER_MOST_TURNS);
    renderer->counts.pool_bytes = (uint64_t)renderer->abuffer.nodes.size;
    return RESULT_OK;
}

static Result add_mesh_to_blocks(Renderer *renderer, Error *error)
{
    return render_blocks_add_mesh(&renderer->blocks, error);
}

static void count_blocks(Renderer *renderer)
{
    const RenderBlocks *blocks = &renderer->blocks;
    renderer->counts = (RendererCounts){.segments = blocks->segments,
                                        .culled = blocks->culled,
                                        .fragments = blocks->nodes,
                                        .pool_bytes = (uint64_t)blocks->links.size,
                                        .redraws = blocks->redraws,
                                        .bands = blocks->bands};
}

// The quads take over for the rest of the run.
static Result draw_quads_instead(Renderer *renderer, Picture *picture, Image *image, Error *error)
{
    renderer->raster = RASTER_QUADS;
    Result result = create_quads(renderer, error);
    if (result == RESULT_OK && renderer->mesh.triangle_count)
        result = add_mesh_to_quads(renderer, error);
    return result == RESULT_OK ? draw_quads(renderer, picture, image, error) : result;
}

static uint64_t count_segments(const Picture *picture)
{
    uint64_t count = 0;
    for (uint32_t i = 0; i < picture->item_count; ++i)
        count +=
            picture->items[i].hair->segment_count * (uint64_t)picture->items[i].material->smooth;
    return count;
}

static Result project_items(Renderer *renderer, const Picture *picture, Error *error)
{
    Result result = RESULT_OK;
    gpu_timer_begin(renderer->timer, "draw_project");
    for (uint32_t i = 0; i < picture->item_count; ++i) {
        const Hair *hair = picture->items[i].hair;
        for (uint32_t b = 0; b < hair->batch_count && result == RESULT_OK; ++b)
            result =
                render_blocks_add(&renderer->blocks, &hair->batches[b], &picture->looks[i], error);
    }
    gpu_timer_end(renderer->timer);
    return result;
}

// To the picture; an empty box stays empty.
static void clip_box(int box[4], int width, int height)
{
    for (int k = 0; k < 4; ++k) {
        int size = k % 2 ? height : width;
        box[k] = box[k] < 0      ? (k < 2 ? 0 : -TILE_ACROSS * BLOCK_WIDTH)
                 : box[k] < size ? box[k]
                                 : size;
    }
}

static Result draw_blocks(Renderer *renderer, Picture *picture, Image *image, Error *error)
{
    RenderBlocks *blocks = &renderer->blocks;
    uint64_t segments = count_segments(picture);
    if (!render_blocks_can_hold(&renderer->gpu->limits, segments))
        return draw_quads_instead(renderer, picture, image, error);
    Result result = render_blocks_begin(blocks, segments, error);
    if (result != RESULT_OK) return result;
    result = project_items(renderer, picture, error);
    if (result != RESULT_OK) return result;
    find_mesh_box(renderer, &picture->draw, picture->mesh_box);
    clip_box(picture->mesh_box, renderer->options.width, renderer->options.height);
    result = render_blocks_draw(blocks, &renderer->target, renderer->mesh.triangle_count > 0,
                                picture->mesh_box, renderer->timer, error);
    if (result != RESULT_OK) return result;
    if (render_blocks_fell_short(blocks))
        return draw_quads_instead(renderer, picture, image, error);
    gpu_timer_begin(renderer->timer, "draw_read");
    render_blocks_read(blocks, image);
    gpu_timer_end(renderer->timer);
    count_blocks(renderer);
    return RESULT_OK;
}

static const RasterType RASTERS[] = {
    [RASTER_QUADS] = {create_quads, add_mesh_to_quads, draw_quads},
    [RASTER_BLOCKS] = {create_blocks, add_mesh_to_blocks, draw_blocks},
};

static uint64_t count_thinned(const Renderer *renderer, const Picture *picture)
{
    uint64_t count = 0;
    for (uint32_t i = 0; i < picture->item_count; ++i)
        for (uint32_t b = 0; b < picture->items[i].hair->batch_count; ++b) {
            const HairBatch *batch = &picture->items[i].hair->batches[b];
            count += batch->strand_count - look_material(&renderer->looks[i], batch).drawn_strands;
        }
    return count;
}

Result renderer_draw(Renderer *renderer, const RenderFrame *frame, const RenderItem *items,
                     uint32_t item_count, Image *image, Error *error)
{
    assert(image->width == renderer->options.width && image->height == renderer->options.height);
    assert(image->channels == renderer_channels(renderer));
    Picture picture = {.items = items, .item_count = item_count};
    const DrawParams *draw = &picture.draw;
    fill_draw_params(renderer, frame, &picture.draw);
    Result result = make_looks(renderer, &picture, frame, error);
    if (result != RESULT_OK) return result;
    renderer->counts = (RendererCounts){0};
    gpu_uniforms_set(&renderer->draw_uniforms, BIND_DRAW, draw, sizeof *draw);
    result = draw_shadow(renderer, frame, &picture, error);
    if (result != RESULT_OK) return result;
    set_state(renderer, draw->background);
    draw_mesh(renderer, draw);
    result = RASTERS[renderer->raster].draw(renderer, &picture, image, error);
    if (result != RESULT_OK) return result;
    renderer->counts.thinned = count_thinned(renderer, &picture);
    renderer->counts.shadow_maps = renderer->shadow.maps_drawn;
    return gpu_check("drawing", error);
}
