// SPDX-License-Identifier: MIT
#include "bench/bench_image.h"
#include "base/clock.h"
#include "scene/scene_quality.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WARM_UP = 2, PASS_FRAMES = 4 };

ImageOptions image_options_default(void)
{
    return (ImageOptions){.size = {1280, 720}, .frames = 15};
}

Result image_bench_create(ImageBench *bench, const Gpu *gpu, const ImageOptions *options,
                          Error *error)
{
    *bench = (ImageBench){.gpu = gpu};
    return image_hair_create(&bench->hair, gpu, options->set, options->file, options->size, error);
}

void image_bench_destroy(ImageBench *bench)
{
    image_exact_destroy(&bench->exact);
    image_hair_destroy(&bench->hair);
}

static Result find_manner(const ImageBench *bench, const ImageScheme *scheme, ImageManner *manner,
                          Error *error)
{
    *manner = (ImageManner){bench->hair.scene.run, bench->hair.scene.sections[0].params};
    Result result = quality_apply(scheme->quality, SCOPE_RUN, &manner->run, error);
    if (result == RESULT_OK)
        result = quality_apply(scheme->quality, SCOPE_SECTION, &manner->material, error);
    manner->run.raster = scheme->raster;
    if (scheme->oit != OIT_AUTO) manner->run.oit = scheme->oit;
    if (scheme->layers) manner->run.oit_layers = scheme->layers;
    if (scheme->samples) manner->run.samples = scheme->samples;
    if (scheme->shadow != SHADOW_NONE) manner->run.shadow = scheme->shadow;
    return result;
}

// Some more pictures with waits between the passes, to tell what each costs at least.
static Result time_passes(Renderer *renderer, const RenderFrame *frame, const RenderItem *item,
                          Image *image, ImageResult *result, Error *error)
{
    GpuTimer *timer = renderer->timer;
    double least[TIMER_MAX_LABELS] = {0}, before[TIMER_MAX_LABELS] = {0};
    Result outcome = RESULT_OK;
    timer->enabled = true;
    for (int i = 0; i < PASS_FRAMES && outcome == RESULT_OK; ++i) {
        outcome = renderer_draw(renderer, frame, item, 1, image, error);
        gpu_timer_collect(timer);
        for (int k = 0; k < timer->count; ++k) {
            double ms = timer->labels[k].total_ms - before[k];
            before[k] = timer->labels[k].total_ms;
            least[k] = i ? fmin(least[k], ms) : ms;
        }
    }
    timer->enabled = false;
    size_t at = 0;
    for (int k = 0; k < timer->count && at < sizeof result->spans; ++k)
        at += (size_t)snprintf(result->spans + at, sizeof result->spans - at, "%s%s %.1f",
                               k ? ", " : "", timer->labels[k].name, least[k]);
    return outcome;
}

static Result draw_frames(ImageBench *bench, const ImageManner *manner, Renderer *renderer,
                          int frames, Image *image, ImageResult *result, Error *error)
{
    const RenderItem item = {&bench->hair.hair, &manner->material, bench->hair.radius};
    const RenderFrame frame = {.view = &bench->hair.view,
                               .lights = bench->hair.scene.lights,
                               .light_count = bench->hair.scene.light_count,
                               .head_rotation = {0, 0, 0, 1}};
    Result outcome = RESULT_OK;
    double *wall = calloc((size_t)frames, sizeof *wall),
           *processor = calloc((size_t)frames, sizeof *processor);
    if (!wall || !processor) outcome = error_set(error, RESULT_FAILED, "no memory for samples");
    for (int i = -WARM_UP; i < frames && outcome == RESULT_OK; ++i) {
        glFinish();
        double begin = clock_ms(), begin_processor = clock_processor_ms();
        outcome = renderer_draw(renderer, &frame, &item, 1, image, error);
        if (i < 0) continue;
        wall[i] = clock_ms() - begin;
        processor[i] = clock_processor_ms() - begin_processor;
    }
    if (outcome == RESULT_OK) {
        result->wall = table_times(wall, frames);
        result->processor = table_times(processor, frames);
    }
    free(wall);
    free(processor);
    result->counts = renderer->counts;
    return outcome == RESULT_OK ? time_passes(renderer, &frame, &item, image, result, error)
                                : outcome;
}

static RendererOptions renderer_options(const ImageBench *bench, const RunParams *run)
{
    RendererOptions options = {
        .raster = (Raster)run->raster,
        .oit = (Oit)run->oit,
        .oit_layers = run->oit_layers,
        .width = bench->hair.scene.run.size[0],
        .height = bench->hair.scene.run.size[1],
        .samples = run->samples,
        .seed = run->seed,
        .lod = {run->lod_start, run->lod_end, run->lod_min, run->lod_width},
        .shadow = {(Shadow)run->shadow, run->shadow_size, run->shadow_spacing}};
    memcpy(options.background, run->background, sizeof options.background);
    options.background[3] = 1;
    return options;
}

Result image_bench_measure(ImageBench *bench, const ImageOptions *options, ImageResult *result,
                           Error *error)
{
    Renderer renderer;
    GpuTimer timer;
    Image image = {0};
    ImageManner manner;
    const ImageExactPicture *exact;
    *result = (ImageResult){.distance = {NAN, NAN}, .reference_s = NAN};
    Result outcome = find_manner(bench, &options->scheme, &manner, error);
    if (outcome != RESULT_OK) return outcome;
    const RendererOptions how = renderer_options(bench, &manner.run);
    gpu_timer_create(&timer, false, bench->gpu->software);
    outcome = renderer_create(&renderer, bench->gpu, &timer, &how, error);
    result->raster = renderer.raster;
    if (outcome == RESULT_OK)
        outcome = image_create(&image, bench->hair.scene.run.size[0], bench->hair.scene.run.size[1],
                               3, error);
    if (outcome == RESULT_OK)
        outcome = draw_frames(bench, &manner, &renderer, options->frames, &image, result, error);
    renderer_destroy(&renderer);
    gpu_timer_destroy(&timer);
    if (outcome == RESULT_OK && !options->no_error) {
        outcome = image_exact_find(&bench->exact, &bench->hair, &manner, &exact, error);
        if (outcome == RESULT_OK) {
            result->distance = image_exact_compare(exact, manner.run.background, &image);
            result->reference_s = exact->seconds;
        }
    }
    image_destroy(&image);
    return outcome;
}
