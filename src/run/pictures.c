// SPDX-License-Identifier: MIT
#include "run/pictures.h"
#include "base/target.h"
#include "draw/hair_paint.h"
#include "scene/camera.h"
#include "strands/paint.h"

#include <stdlib.h>
#include <string.h>

static Result paint_section(Pictures *pictures, uint32_t i, Error *error)
{
    SimulationSection *section = &pictures->simulation->sections[i];
    const Strands *strands = &pictures->assets->strands[i];
    const GpuLimits *limits = &pictures->gpu->limits;
    Paint paint;
    Result result = paint_create(&paint, strands, &pictures->scene->sections[i].params, error);
    if (result == RESULT_OK) result = hair_paint(&section->hair, strands, &paint, limits, error);
    if (result == RESULT_OK && section->follow.per_guide)
        result = hair_paint(&section->follow.hair, strands, &paint, limits, error);
    paint_destroy(&paint);
    return result == RESULT_USAGE
               ? error_prefix(error, result, "%s: ", pictures->scene->sections[i].file)
               : result;
}

static Result create_items(Pictures *pictures, Error *error)
{
    pictures->items =
        calloc(2 * (size_t)pictures->scene->section_count + 1, sizeof *pictures->items);
    if (!pictures->items)
        return error_set(error, RESULT_FAILED, "no memory for %u sections",
                         pictures->scene->section_count);
    for (uint32_t i = 0; i < pictures->scene->section_count; ++i) {
        const SimulationSection *section = &pictures->simulation->sections[i];
        const SectionParams *params = &pictures->scene->sections[i].params;
        if (params->hidden) continue;
        float radius =
            paint_radius(params, &pictures->assets->strands[i], section->follow.per_guide);
        Result result = paint_section(pictures, i, error);
        if (result != RESULT_OK) return result;
        pictures->items[pictures->item_count++] = (RenderItem){&section->hair, params, radius};
        if (section->follow.per_guide)
            pictures->items[pictures->item_count++] =
                (RenderItem){&section->follow.hair, params, radius};
    }
    return RESULT_OK;
}

// Floats tell the depth in metres; PNG files from what the camera sees nearest to what is farthest,
// as the first picture has it.
static void set_depth_range(const Pictures *pictures, RendererOptions *options)
{
    View view;
    if (options->aov != AOV_DEPTH || options->kind == IMAGE_FLOAT) return;
    camera_view(&view, pictures->scene, pictures->framing, pictures->scene->run.first);
    options->depth_range[0] = view.near_distance;
    options->depth_range[1] = view.far_distance;
    if (!pictures->scene->run.quiet)
        fprintf(stderr, "depth: white is %.6g m before the eye, black %.6g m\n",
                (double)view.near_distance, (double)view.far_distance);
}

static Result describe_pictures(const Pictures *pictures, RendererOptions *options, Error *error)
{
    const RunParams *run = &pictures->scene->run;
    Target target;
    Result result = target_parse(&target, run->output, error);
    *options = (RendererOptions){
        .raster = (Raster)run->raster,
        .oit = (Oit)run->oit,
        .oit_layers = run->oit_layers,
        .width = run->size[0],
        .height = run->size[1],
        .exposure = run->exposure,
        .tone = (Tone)run->tone_map,
        .kind = run->depth == DEPTH_16 ? IMAGE_16 : IMAGE_8,
        .aov = (Aov)run->aov,
        .samples = run->samples,
        .seed = run->seed,
        .floor = floor_find(pictures->scene, pictures->framing),
        .lod = {run->lod_start, run->lod_end, run->lod_min, run->lod_width},
        .shadow = {
            .kind = (Shadow)run->shadow, .side = run->shadow_size, .spacing = run->shadow_spacing}};
    memcpy(options->background, run->background, sizeof options->background);
    if (result != RESULT_OK) return result;
    if (target.floats) options->kind = IMAGE_FLOAT;
    set_depth_range(pictures, options);
    target_destroy(&target);
    return RESULT_OK;
}

static Result open_renderer(Pictures *pictures, GpuTimer *timer, Error *error)
{
    const Assets *assets = pictures->assets;
    RendererOptions options;
    Result result = describe_pictures(pictures, &options, error);
    if (result == RESULT_OK)
        result = renderer_create(&pictures->renderer, pictures->gpu, timer, &options, error);
    if (result == RESULT_OK && assets->has_mesh)
        result = renderer_set_mesh(&pictures->renderer, &assets->mesh,
                                   pictures->scene->run.mesh_color, error);
    if (result == RESULT_OK) result = create_items(pictures, error);
    return result;
}

static Result open_output(Pictures *pictures, int frame_count, Error *error)
{
    const RunParams *run = &pictures->scene->run;
    const OutputOptions options = {
        .target = run->output,
        .width = run->size[0],
        .height = run->size[1],
        .channels = renderer_channels(&pictures->renderer),
        .kind = pictures->renderer.options.kind,
        .fps = (double)run->fps / run->every,
        .frame_count = frame_count,
        .columns = run->contact_sheet[0],
        .rows = run->contact_sheet[1],
    };
    return output_create(&pictures->output, &options, error);
}

Result pictures_create(Pictures *pictures, const Scene *scene, const Assets *assets,
                       Simulation *simulation, const Framing *framing, const Gpu *gpu,
                       GpuTimer *timer, int frame_count, Error *error)
{
    *pictures = (Pictures){
        .scene = scene, .assets = assets, .simulation = simulation, .framing = framing, .gpu = gpu};
    Result result = open_renderer(pictures, timer, error);
    return result == RESULT_OK ? open_output(pictures, frame_count, error) : result;
}

void pictures_destroy(Pictures *pictures)
{
    output_destroy(pictures->output);
    renderer_destroy(&pictures->renderer);
    free(pictures->items);
    *pictures = (Pictures){0};
}
