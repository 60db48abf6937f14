// SPDX-License-Identifier: MIT
#include "draw/backend.h"

#include "gpu/gpu_uniforms.h"
#include "passes/passes.h"

#include "draw/scatter.h"

#include <stdlib.h>
#include <string.h>

static bool is_quads(const Passes *passes)
{
    return passes->options->raster == RASTER_QUADS;
}

static bool has_base(const Passes *passes)
{
    return base_layer_is_needed(&passes->base, &passes->options->floor);
}

// Creates what drawing mesh and floor needs, if the frame has any.
static Result make_base(Passes *passes, Error *error)
{
    if (!has_base(passes)) return RESULT_OK;
    TRY(render_target_add_base(&passes->target, error));
    return is_quads(passes) ? quads_add_base(&passes->quads, error)
                            : compute_add_base(&passes->compute, error);
}

static Result create_rasters(Passes *passes, Error *error)
{
    const Gpu *gpu = passes->gpu;
    if (is_quads(passes)) return quads_create(&passes->quads, gpu, passes->options, error);
    TRY(ribbons_create(&passes->ribbons, &gpu->limits, error));
    return compute_create(&passes->compute, gpu, passes->options, error);
}

static void destroy(void *state)
{
    Passes *passes = state;
    if (!passes) return;
    render_target_destroy(&passes->target);
    quads_destroy(&passes->quads);
    ribbons_destroy(&passes->ribbons);
    compute_destroy(&passes->compute);
    base_layer_destroy(&passes->base);
    shadows_destroy(&passes->shadow);
    hair_scatter_destroy(&passes->scatter);
    free(passes->casters);
    free(passes);
}

static Result create(void **state, const BackendOptions *set, Error *error)
{
    const RendererOptions *options = set->options;
    Passes *passes = calloc(1, sizeof *passes);
    if (!passes) return error_set(error, RESULT_FAILED, "no memory to draw hair");
    *passes = (Passes){.set = *set, .options = options, .gpu = set->gpu};
    passes->base.shading = options->mesh_shading;
    passes->base.backdrop = options->backdrop ? options->samples : 0;
    Result result = render_target_create(&passes->target, options->width, options->height,
                                         options->samples, options->kind, error);
    THEN(result, create_rasters(passes, error));
    THEN(result, make_base(passes, error));
    if (options->shadow.kind != SHADOW_NONE)
        shadows_create(&passes->shadow, &passes->gpu->limits, &options->shadow);
    ScatterOptions scatter = scatter_options(options);
    hair_scatter_create(&passes->scatter, &passes->gpu->limits, &scatter);
    if (result == RESULT_OK)
        *state = passes;
    else
        destroy(passes);
    return result;
}

static Result set_mesh(void *state, const DrawnMesh *mesh, Error *error)
{
    Passes *passes = state;
    RenderMesh *mine = &passes->base.mesh;
    passes->base.any = false;
    shadows_forget_mesh(&passes->shadow);
    render_mesh_destroy(mine);
    TRY(render_mesh_create(mine, &mesh->mesh, &passes->gpu->limits, error));
    if (mesh->open)
        TRY(render_mesh_set_openness(mine, (const float(*)[2])mesh->open, mesh->mesh.vertex_count,
                                     &passes->gpu->limits, error));
    if (mesh->tint)
        TRY(render_mesh_set_tint(mine, (const float(*)[3])mesh->tint, mesh->mesh.vertex_count,
                                 &passes->gpu->limits, error));
    return make_base(passes, error);
}

static void move_mesh(void *state, const DrawnMesh *mesh)
{
    Passes *passes = state;
    passes->base.any = false;
    shadows_forget_mesh(&passes->shadow);
    render_mesh_move(&passes->base.mesh, &mesh->mesh);
}

// --- Light.

static Result list_casters(Passes *passes, const BackendFrame *frame, ShadowCasters *casters,
                           Error *error)
{
    if (passes->caster_room < frame->hair_count) {
        ShadowCaster *room = realloc(passes->casters, frame->hair_count * sizeof *room);
        if (!room)
            return error_set(error, RESULT_FAILED, "no memory for %u batches", frame->hair_count);
        passes->casters = room;
        passes->caster_room = frame->hair_count;
    }
    for (uint32_t i = 0; i < frame->hair_count; ++i)
        passes->casters[i] = (ShadowCaster){frame->hair[i].batch, frame->hair[i].look};
    *casters = (ShadowCasters){passes->casters, frame->hair_count};
    return RESULT_OK;
}

static ShadowScene make_shadow_scene(const Passes *passes, const BackendFrame *frame,
                                     ShadowCasters casters)
{
    const RenderFrame *of = frame->frame;
    ShadowScene scene = {.lights = of->lights,
                         .light_count = of->light_count,
                         .casters = casters,
                         .mesh = {.mesh = &passes->base.mesh},
                         .revision = of->revision};
    memcpy(scene.mesh.rotation, of->head_rotation, sizeof scene.mesh.rotation);
    memcpy(scene.mesh.translation, of->head_translation, sizeof scene.mesh.translation);
    memcpy(scene.middle, frame->middle, sizeof scene.middle);
    return scene;
}

static Result shadow(void *state, const BackendFrame *frame, Error *error)
{
    Passes *passes = state;
    ShadowCasters casters;
    drawing_upload(frame->drawing);
    if (passes->options->shadow.kind == SHADOW_NONE) return RESULT_OK;
    TRY(list_casters(passes, frame, &casters, error));
    const ShadowScene scene = make_shadow_scene(passes, frame, casters);
    if (!shadows_show(&passes->shadow, &scene))
        TRY(hair_scatter_begin(&passes->scatter, frame, casters, error));
    TRY(shadows_draw(&passes->shadow, &scene, passes->set.timer.timer, error));
    shadows_bind(&passes->shadow);
    for (uint32_t i = 0; i < frame->drawing->item_count; ++i)
        frame->drawing->looks[i].map_count = passes->shadow.params.maps;
    return RESULT_OK;
}

static Result scatter(void *state, const BackendFrame *frame, Error *error)
{
    Passes *passes = state;
    ShadowCasters casters;
    if (passes->options->shadow.kind != SHADOW_DOM) return RESULT_OK;
    TRY(list_casters(passes, frame, &casters, error));
    gpu_timer_begin(passes->set.timer.timer, "draw_scatter");
    Result result = hair_scatter_draw(&passes->scatter, frame, casters, &passes->shadow, error);
    gpu_timer_end(passes->set.timer.timer);
    return result;
}

// --- A window.

static void set_state(const Passes *passes, const float background[4])
{
    const RendererOptions *options = passes->options;
    glViewport(0, 0, options->width * options->samples, options->height * options->samples);
    glDisable(GL_BLEND);
    glDisable(GL_CULL_FACE);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_SCISSOR_TEST);
    glDepthFunc(GL_LESS);
    glBindFramebuffer(GL_FRAMEBUFFER, passes->target.image_frame);
    glClearBufferfv(GL_COLOR, 0, options->kind == IMAGE_FLOAT ? background : options->background);
}

static CullBase cull_base(const Passes *passes)
{
    return (CullBase){has_base(passes) ? &passes->target : NULL, passes->base.depth_version};
}

// Projects all hair to ribbons.
static Result project(Passes *passes, const BackendFrame *frame, Error *error)
{
    const RibbonsBase base = {cull_base(passes), frame->drawing->base_box};
    Result result =
        ribbons_begin(&passes->ribbons, drawing_count_segments(frame->drawing), &base, error);
    for (uint32_t i = 0; i < frame->hair_count && result == RESULT_OK; ++i)
        result = ribbons_add(&passes->ribbons, frame->hair[i].batch, frame->hair[i].look, error);
    return result;
}

static Result shade(void *state, const BackendFrame *frame, Error *error)
{
    Passes *passes = state;
    const Drawing *drawing = frame->drawing;
    const BaseScene scene = {.floor = &passes->options->floor,
                             .shadow = &passes->shadow,
                             .light = hair_scatter_on_skin(&passes->scatter, frame),
                             .draw = &drawing->draw,
                             .backdrop = &drawing->backdrop,
                             .limits = &passes->gpu->limits,
                             .mesh_box = drawing->mesh_box,
                             .box = drawing->base_box};
    GpuTimer *timer = passes->set.timer.timer;
    drawing_upload(frame->drawing);
    set_state(passes, drawing->draw.background);
    TRY(base_layer_draw(&passes->base, &scene, &passes->target, timer, error));
    if (is_quads(passes)) return RESULT_OK; // quads project each band when it is drawn
    gpu_timer_begin(timer, "draw_project");
    Result result = project(passes, frame, error);
    gpu_timer_end(timer);
    return result;
}

// --- compute.

static void count_compute(Passes *passes, const ComputeCounts *counts)
{
    const Ribbons *ribbons = &passes->ribbons;
    const ComputeBins *bins = &passes->compute.bins;
    passes->counts =
        (RendererCounts){.segments = ribbons->segments,
                         .culled = ribbons->culled,
                         .hidden = ribbons->cull.hidden,
                         .fragments = counts->pairs,
                         .pool_bytes = (uint64_t)(bins->pairs.size + bins->sorted.size),
                         .redraws = counts->redraws,
                         .bands = counts->bands};
}

static Result send_image(Passes *passes, bool again, Error *error)
{
    gpu_timer_begin(passes->set.timer.timer, "draw_read");
    Result result = render_target_send(&passes->target, NULL, again, error);
    gpu_timer_end(passes->set.timer.timer);
    return result;
}

static Result draw_looking(Passes *passes, ComputeCounts counts, bool again, Error *error)
{
    TRY(compute_draw(&passes->compute, &passes->ribbons, &passes->target, passes->set.timer.timer,
                     &counts, error));
    if (!again) TRY(ribbons_count(&passes->ribbons, error));
    count_compute(passes, &counts);
    return send_image(passes, again, error);
}

static Result composite_compute(Passes *passes, Error *error)
{
    Compute *compute = &passes->compute;
    compute->unsettled = false;
    if (!compute_trusts(compute)) return draw_looking(passes, (ComputeCounts){0}, false, error);
    TRY(compute_begin(compute, &passes->ribbons, &passes->target, passes->set.timer.timer, error));
    return send_image(passes, false, error);
}

static Result settle_compute(Passes *passes, Error *error)
{
    ComputeCounts counts = {0};
    bool good;
    if (!passes->compute.unsettled) return RESULT_OK;
    TRY(compute_settle(&passes->compute, &passes->ribbons, &counts, &good, error));
    if (!good) return draw_looking(passes, counts, true, error);
    count_compute(passes, &counts);
    return RESULT_OK;
}

// --- quads.

static Result settle_quads(Passes *passes, const BackendFrame *frame, Error *error)
{
    if (!passes->quads.unsettled) return RESULT_OK;
    // Other renderers may have drawn since, so set the state again.
    if (passes->options->shadow.kind != SHADOW_NONE) shadows_bind(&passes->shadow);
    (has_base(passes) ? glEnable : glDisable)(GL_DEPTH_TEST);
    glDepthMask(GL_FALSE);
    return quads_settle(&passes->quads, frame->drawing, &passes->target, has_base(passes),
                        passes->set.timer.timer, &passes->counts, error);
}

// --- Both rasterisers.

static Result composite(void *state, const BackendFrame *frame, Image *image, Error *error)
{
    Passes *passes = state;
    (void)image;
    passes->counts = (RendererCounts){0};
    if (!is_quads(passes)) return composite_compute(passes, error);
    const CullBase base = cull_base(passes);
    return quads_draw(&passes->quads, frame->drawing, &passes->target, &base,
                      passes->set.timer.timer, &passes->counts, error);
}

static Result settle(void *state, const BackendFrame *frame, Error *error)
{
    Passes *passes = state;
    return is_quads(passes) ? settle_quads(passes, frame, error) : settle_compute(passes, error);
}

static Result take(void *state, int place, Image *image, Error *error)
{
    Passes *passes = state;
    uint32_t none;
    return is_quads(passes) ? quads_take(&passes->target, place, image, error)
                            : render_target_take(&passes->target, place, image, &none, error);
}

static int place(const void *state)
{
    const Passes *passes = state;
    return passes->target.next;
}

static void count(const void *state, RendererCounts *counts)
{
    const Passes *passes = state;
    *counts = passes->counts;
    counts->shadow_maps = passes->shadow.maps_drawn;
}

const DrawBackend DRAW_PASSES = {
    .create = create,
    .destroy = destroy,
    .set_mesh = set_mesh,
    .move_mesh = move_mesh,
    .shadow = shadow,
    .scatter = scatter,
    .shade = shade,
    .composite = composite,
    .count = count,
    .settle = settle,
    .take = take,
    .place = place,
};
