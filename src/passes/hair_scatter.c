// SPDX-License-Identifier: MIT
#include "passes/hair_scatter.h"

#include "draw/scatter.h"

#include <stdlib.h>
#include <string.h>

void hair_scatter_create(HairScatter *scatter, const GpuLimits *limits,
                         const ScatterOptions *options)
{
    *scatter = (HairScatter){
        .options = *options, .limits = limits, .passes = {.programs = {.limits = limits}}};
}

static void forget_room(HairScatter *scatter)
{
    for (uint32_t i = 0; i < scatter->room; ++i) gpu_buffer_destroy(&scatter->seen[i].seen);
    free(scatter->hair);
    free(scatter->seen);
    scatter->hair = NULL, scatter->seen = NULL;
    scatter->room = 0;
}

void hair_scatter_destroy(HairScatter *scatter)
{
    forget_room(scatter);
    light_passes_destroy(&scatter->passes);
    light_blocks_destroy(&scatter->blocks);
    fibre_kinds_destroy(&scatter->kinds);
    *scatter = (HairScatter){0};
}

static Result make_room(HairScatter *scatter, uint32_t count, Error *error)
{
    if (scatter->room >= count) return RESULT_OK;
    forget_room(scatter);
    scatter->hair = calloc(count, sizeof *scatter->hair);
    scatter->seen = calloc(count, sizeof *scatter->seen);
    scatter->room = scatter->hair && scatter->seen ? count : 0;
    return scatter->room ? RESULT_OK
                         : error_set(error, RESULT_FAILED, "no memory for %u batches", count);
}

enum { SEEN_BYTES = 3 * sizeof(float) }; // a point's linear RGB

static Result reserve_seen(HairScatter *scatter, uint32_t i, const HairBatch *batch, size_t points,
                           Error *error)
{
    GpuBuffer *seen = &scatter->seen[i].seen;
    scatter->seen[i].batch = batch;
    if (seen->size == SEEN_BYTES * (int64_t)points) return RESULT_OK;
    scatter->any = false;
    gpu_buffer_destroy(seen);
    return gpu_buffer_create(seen, scatter->limits, "light among hair",
                             SEEN_BYTES * (int64_t)points, NULL, GL_RGB32F, error);
}

static Result open_hair(HairScatter *scatter, const DrawnHair *drawn, uint32_t i, Error *error)
{
    GridHair *hair = &scatter->hair[i];
    size_t points = (size_t)hair_slots(drawn->batch) * look_points(drawn->look, drawn->batch);
    *hair = (GridHair){.caster = {.material = drawn->material}};
    TRY(fibre_kinds_find(&scatter->kinds, drawn->look, &hair->kind, error));
    return drawn->look->features & LOOK_MARSCHNER
               ? reserve_seen(scatter, i, drawn->batch, points, error)
               : RESULT_OK;
}

static bool kinds_changed(const HairScatter *scatter, const BackendFrame *frame)
{
    for (uint32_t i = 0; i < frame->hair_count; ++i)
        if (!fibre_kinds_know(&scatter->kinds, frame->hair[i].look)) return true;
    return false;
}

static Result find_light(HairScatter *scatter, const BackendFrame *frame, ShadowCasters casters,
                         const Shadows *shadows, Error *error)
{
    const DrawParams *draw = &frame->drawing->whole;
    if (kinds_changed(scatter, frame)) {
        fibre_kinds_destroy(&scatter->kinds);
        scatter->any = false;
    }
    scatter->count = frame->hair_count;
    for (uint32_t i = 0; i < scatter->count; ++i)
        TRY(open_hair(scatter, &frame->hair[i], i, error));
    GridScene grid = scatter_scene(&scatter->options, frame, &shadows->params);
    grid.hair = scatter->hair, grid.hair_count = scatter->count;
    grid.kinds = scatter->kinds.lobes, grid.kind_count = scatter->kinds.count;
    scatter->blocks.mesh = scatter_mesh(frame);
    if (scatter->blocks.mesh.triangle_count) grid.blocks = &scatter->blocks;
    bool solved = scatter->any && scatter->shadow_version == shadows->version &&
                  scatter_same_lights(&scatter->drawn, draw);
    scatter->any = false;
    if (!solved) TRY(light_passes_solve(&scatter->passes, &grid, casters, error));
    TRY(light_passes_gather(&scatter->passes, &grid, casters, scatter->seen, error));
    scatter->any = true;
    scatter->shadow_version = shadows->version;
    scatter->drawn = *draw;
    memcpy(scatter->to_eye, grid.to_eye, sizeof scatter->to_eye);
    return RESULT_OK;
}

// Whether the light that was gathered for the last image is valid for this one.
static bool is_seen(const HairScatter *scatter, const Shadows *shadows, const BackendFrame *frame)
{
    const DrawParams *draw = &frame->drawing->whole;
    for (int k = 0; k < 3; ++k)
        if (scatter->to_eye[k] != frame->frame->view->view[k][2]) return false;
    return scatter->any && scatter->shadow_version == shadows->version &&
           scatter->count == frame->hair_count && scatter_same_lights(&scatter->drawn, draw) &&
           memcmp(scatter->drawn.eye, draw->eye, sizeof draw->eye) == 0 &&
           !kinds_changed(scatter, frame);
}

Result hair_scatter_begin(HairScatter *scatter, const BackendFrame *frame, ShadowCasters casters,
                          Error *error)
{
    const GridScene grid = {.draw = &frame->drawing->whole,
                            .step = scatter_step(&scatter->options, frame)};
    if (!scatter_is_wanted(&scatter->options, frame)) return RESULT_OK;
    return light_passes_begin(&scatter->passes, &grid, casters, error);
}

Result hair_scatter_draw(HairScatter *scatter, const BackendFrame *frame, ShadowCasters casters,
                         const Shadows *shadows, Error *error)
{
    if (!scatter_is_wanted(&scatter->options, frame)) return RESULT_OK;
    if (!is_seen(scatter, shadows, frame)) {
        TRY(make_room(scatter, frame->hair_count, error));
        TRY(find_light(scatter, frame, casters, shadows, error));
    }
    for (uint32_t i = 0; i < frame->drawing->item_count; ++i) {
        Look *look = &frame->drawing->looks[i];
        if (!(look->features & LOOK_MARSCHNER)) continue;
        look->features |= LOOK_SCATTERED;
        look->scattered = scatter->seen;
        look->batches = frame->hair_count;
    }
    return RESULT_OK;
}

const LightPasses *hair_scatter_on_skin(const HairScatter *scatter, const BackendFrame *frame)
{
    bool shown = scatter->any && scatter_is_wanted(&scatter->options, frame);
    return shown && scatter->passes.filled && scatter->passes.lights_skin ? &scatter->passes : NULL;
}
