// SPDX-License-Identifier: MIT
#include "bench_image.h"
#include "fibre.h"
#include "image_reference.h"
#include "scene_quality.h"
#include "shadow_reference.h"
#include "stats.h"
#include "strands_make.h"
#include "strands_read.h"
#include "strands_resample.h"

#include "version.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WARM_UP = 3, PASS_FRAMES = 8 };

// An exact picture; without pixels until it is needed.
typedef struct Reference {
    Image image;
    double seconds; // that it took
} Reference;

struct ImageBench {
    const Gpu *gpu;
    char name[64];
    int size[2];
    Scene scene;
    Strands strands;
    Hair hair;
    float radius;
    View view;
    Reference references[2][2]; // without and with shadows, straight and smooth
};

// How a scheme draws: parameters are those of the scene, which owns their texts.
typedef struct Manner {
    RunParams run;
    SectionParams material;
} Manner;

ImageOptions image_options_default(void)
{
    return (ImageOptions){.size = {1280, 720}, .frames = 15};
}

const ImageScheme IMAGE_SCHEMES[] = {
    {.raster = RASTER_BLOCKS},
    {.raster = RASTER_BLOCKS, .samples = 2},
    {.raster = RASTER_QUADS, .oit = OIT_NONE},
    {.raster = RASTER_QUADS, .layers = 1},
    {.raster = RASTER_QUADS, .layers = 4},
    {.raster = RASTER_QUADS, .layers = 8},
    {.raster = RASTER_QUADS, .layers = 16},
    {.raster = RASTER_QUADS, .layers = 32},
    {.raster = RASTER_QUADS, .layers = 16, .samples = 2},
    {.raster = RASTER_BLOCKS, .shadow = SHADOW_APPROX},
    {.raster = RASTER_BLOCKS, .shadow = SHADOW_DOM},
    {.raster = RASTER_BLOCKS, .samples = 2, .shadow = SHADOW_DOM},
    {.raster = RASTER_QUADS, .layers = 8, .shadow = SHADOW_DOM},
    {.quality = QUALITY_DRAFT},
    {.quality = QUALITY_FINAL},
};
const size_t IMAGE_SCHEME_COUNT = sizeof IMAGE_SCHEMES / sizeof *IMAGE_SCHEMES;
const char *const IMAGE_SETS[] = {"straight", "curls", "fur", "files", NULL};

// The recipes of the sets that look like hair.
static bool find_recipe(const char *name, StrandsRecipe *recipe)
{
    static const struct {
        const char *name;
        StrandsStyle style;
        uint32_t count, vertices;
    } sets[] = {{"straight", STRANDS_STYLE_STRAIGHT, 10000, 32},
                {"curls", STRANDS_STYLE_CURLS, 10000, 32},
                {"curls100k", STRANDS_STYLE_CURLS, 100000, 32},
                {"fur", STRANDS_STYLE_FUR, 37747, 8}};
    for (size_t i = 0; i < sizeof sets / sizeof *sets; ++i) {
        if (strcmp(name, sets[i].name) != 0) continue;
        *recipe = strands_recipe_default(sets[i].style);
        recipe->count = sets[i].count;
        recipe->vertices = sets[i].vertices;
        return true;
    }
    return false;
}

static Result read_strands(Strands *strands, const ImageOptions *options, Error *error)
{
    StrandsRecipe recipe;
    if (!options->set)
        return strands_read(strands, options->file, &(StrandsReadOptions){0}, NULL, error);
    if (find_recipe(options->set, &recipe)) return strands_make(strands, &recipe, error);
    return strands_make_set(strands, options->set, 1, error);
}

static Result fill(ImageBench *bench, const ImageOptions *options, Error *error)
{
    const char *name = options->set ? options->set : options->file, *slash = strrchr(name, '/');
    SectionParams params = {0};
    Framing framing;
    snprintf(bench->name, sizeof bench->name, "%s", slash ? slash + 1 : name);
    Result result = scene_create(&bench->scene, error);
    if (result == RESULT_OK) result = section_params_create(&params, error);
    if (result == RESULT_OK) result = scene_add_section(&bench->scene, name, &params, error);
    section_params_destroy(&params);
    if (result == RESULT_OK) result = read_strands(&bench->strands, options, error);
    if (result == RESULT_OK)
        result = hair_create(&bench->hair, &bench->strands, 0, &bench->gpu->limits, error);
    if (result != RESULT_OK) return result;
    bench->radius = fibre_auto_radius(&bench->strands, 0);
    memcpy(bench->scene.run.size, bench->size, sizeof bench->size);
    framing_compute(&framing, &bench->scene, &bench->strands, NULL);
    camera_view(&bench->view, &bench->scene, &framing, 0);
    return RESULT_OK;
}

ImageBench *image_bench_create(const Gpu *gpu, const ImageOptions *options, Result *result,
                               Error *error)
{
    ImageBench *bench = calloc(1, sizeof *bench);
    *result = bench ? RESULT_OK : error_set(error, RESULT_FAILED, "no memory for a benchmark");
    if (!bench) return NULL;
    bench->gpu = gpu;
    memcpy(bench->size, options->size, sizeof bench->size);
    *result = fill(bench, options, error);
    if (*result == RESULT_OK) return bench;
    image_bench_destroy(bench);
    return NULL;
}

void image_bench_destroy(ImageBench *bench)
{
    if (!bench) return;
    hair_destroy(&bench->hair);
    strands_destroy(&bench->strands);
    scene_destroy(&bench->scene);
    for (int i = 0; i < 4; ++i) image_destroy(&bench->references[i / 2][i % 2].image);
    free(bench);
}

static Result find_manner(const ImageBench *bench, const ImageScheme *scheme, Manner *manner,
                          Error *error)
{
    *manner = (Manner){bench->scene.run, bench->scene.sections[0].params};
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

// The share of each light that reaches the vertices: [light_count][vertex_count], the caller's.
static Result find_left(const ReferenceScene *scene, const float middle[3], float **left,
                        Error *error)
{
    uint32_t count = scene->items[0].strands->vertex_count;
    *left = malloc((size_t)scene->light_count * count * sizeof **left);
    if (!*left) return error_set(error, RESULT_FAILED, "no memory for %u vertices' light", count);
    for (uint32_t i = 0; i < scene->light_count; ++i) {
        float *of_light = *left + (size_t)i * count;
        for (uint32_t v = 0; v < count; ++v) of_light[v] = 1;
        if (!scene->lights[i].shadow) continue;
        ShadowReference shadow;
        Result result = shadow_reference_create(&shadow, scene, &scene->lights[i], middle, error);
        if (result != RESULT_OK) return result;
        shadow_reference_fill(&shadow, &scene->items[0], of_light);
        shadow_reference_destroy(&shadow);
    }
    return RESULT_OK;
}

static Result draw_reference(const ImageBench *bench, const Manner *manner, const Strands *strands,
                             Image *image, Error *error)
{
    float *left = NULL, middle[3];
    ReferenceItem item = {
        .strands = strands, .material = &manner->material, .radius = bench->radius};
    ReferenceScene scene = {.view = &bench->view,
                            .lights = bench->scene.lights,
                            .light_count = bench->scene.light_count,
                            .items = &item,
                            .item_count = 1,
                            .seed = bench->scene.run.seed};
    memcpy(scene.background, bench->scene.run.background, sizeof scene.background);
    for (int k = 0; k < 3; ++k) middle[k] = 0.5f * (bench->hair.low[k] + bench->hair.high[k]);
    Result result =
        manner->run.shadow != SHADOW_NONE ? find_left(&scene, middle, &left, error) : RESULT_OK;
    item.left = left;
    if (result == RESULT_OK) result = image_create(image, bench->size[0], bench->size[1], 3, error);
    if (result == RESULT_OK) result = image_reference_draw(image, &scene, REFERENCE_SIDE, error);
    free(left);
    return result;
}

// Strands with the points of their smooth curves as vertices, if the manner is such.
static Result smooth_strands(const Manner *manner, Strands *strands, Error *error)
{
    uint32_t parts = (uint32_t)manner->material.smooth;
    if (parts == 1) return RESULT_OK;
    const ResampleOptions resample = {.count = parts * (strands_size(strands, 0) - 1) + 1,
                                      .spline = true};
    return strands_resample(strands, &resample, error);
}

static Result find_reference(ImageBench *bench, const ImageOptions *options, const Manner *manner,
                             const Reference **found, Error *error)
{
    bool shadow = manner->run.shadow != SHADOW_NONE, smooth = manner->material.smooth > 1;
    Reference *reference = &bench->references[shadow][smooth];
    *found = reference;
    if (reference->image.pixels) return RESULT_OK;
    Strands strands = {0};
    double begin = stats_clock_ms();
    Result result = read_strands(&strands, options, error);
    if (result == RESULT_OK) result = smooth_strands(manner, &strands, error);
    if (result == RESULT_OK)
        result = draw_reference(bench, manner, &strands, &reference->image, error);
    strands_destroy(&strands);
    reference->seconds = (stats_clock_ms() - begin) / 1000;
    return result;
}

// Over the pixels that differ from the background in either picture.
static void compare(const ImageBench *bench, const Reference *reference, const Image *image,
                    ImageResult *result)
{
    uint8_t background[3];
    size_t count = (size_t)image->width * (size_t)image->height, covered = 0;
    double sum = 0;
    for (int k = 0; k < 3; ++k)
        background[k] = (uint8_t)lrintf(255 * bench->scene.run.background[k]);
    for (size_t i = 0; i < count; ++i) {
        const uint8_t *p = image->pixels + 3 * i, *q = reference->image.pixels + 3 * i;
        if (memcmp(p, background, 3) == 0 && memcmp(q, background, 3) == 0) continue;
        ++covered;
        for (int k = 0; k < 3; ++k) sum += (p[k] - q[k]) * (p[k] - q[k]) / 3.0;
    }
    result->rms = sqrt(sum / (double)(covered ? covered : 1));
    result->covered = (double)covered / (double)count;
    result->reference_s = reference->seconds;
}

static int compare_times(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
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

static Result draw_frames(ImageBench *bench, const Manner *manner, Renderer *renderer, int frames,
                          Image *image, ImageResult *result, Error *error)
{
    const RenderItem item = {&bench->hair, &manner->material, bench->radius};
    const RenderFrame frame = {.view = &bench->view,
                               .lights = bench->scene.lights,
                               .light_count = bench->scene.light_count,
                               .head_rotation = {0, 0, 0, 1}};
    Result outcome = RESULT_OK;
    double *samples = calloc((size_t)frames, sizeof *samples);
    if (!samples) return error_set(error, RESULT_FAILED, "no memory for %d samples", frames);
    for (int i = -WARM_UP; i < frames && outcome == RESULT_OK; ++i) {
        glFinish();
        double begin = stats_clock_ms();
        outcome = renderer_draw(renderer, &frame, &item, 1, image, error);
        if (i >= 0) samples[i] = stats_clock_ms() - begin;
    }
    qsort(samples, (size_t)frames, sizeof *samples, compare_times);
    result->median_ms = samples[frames / 2];
    result->min_ms = samples[0];
    result->counts = renderer->counts;
    free(samples);
    return outcome == RESULT_OK ? time_passes(renderer, &frame, &item, image, result, error)
                                : outcome;
}

static RendererOptions renderer_options(const ImageBench *bench, const RunParams *run)
{
    RendererOptions options = {
        .raster = (Raster)run->raster,
        .oit = (Oit)run->oit,
        .oit_layers = run->oit_layers,
        .width = bench->size[0],
        .height = bench->size[1],
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
    Manner manner;
    const Reference *reference;
    *result = (ImageResult){.rms = -1};
    Result outcome = find_manner(bench, &options->scheme, &manner, error);
    if (outcome != RESULT_OK) return outcome;
    const RendererOptions how = renderer_options(bench, &manner.run);
    gpu_timer_create(&timer, false, bench->gpu->software);
    outcome = renderer_create(&renderer, bench->gpu, &timer, &how, error);
    result->raster = renderer.raster;
    if (outcome == RESULT_OK)
        outcome = image_create(&image, bench->size[0], bench->size[1], 3, error);
    if (outcome == RESULT_OK)
        outcome = draw_frames(bench, &manner, &renderer, options->frames, &image, result, error);
    renderer_destroy(&renderer);
    gpu_timer_destroy(&timer);
    if (outcome == RESULT_OK && !options->no_error) {
        outcome = find_reference(bench, options, &manner, &reference, error);
        if (outcome == RESULT_OK) compare(bench, reference, &image, result);
    }
    image_destroy(&image);
    return outcome;
}

static const char *word_of(const char *param, int value)
{
    return param_find(param)->choices[value];
}

// "quads, k = 8, 2 x 2, dom"; a preset by its word.
static void name_scheme(const ImageScheme *scheme, char *name, size_t size)
{
    char layers[24] = "";
    bool quads = scheme->raster == RASTER_QUADS || scheme->oit != OIT_AUTO || scheme->layers;
    if (scheme->oit == OIT_NONE)
        snprintf(layers, sizeof layers, ", none");
    else if (quads)
        snprintf(layers, sizeof layers, ", k = %d", scheme->layers ? scheme->layers : 8);
    const char *first = scheme->quality != QUALITY_NORMAL ? word_of("quality", (int)scheme->quality)
                                                          : word_of("raster", (int)scheme->raster);
    snprintf(name, size, "%s%s%s%s%s", first, layers, scheme->samples == 2 ? ", 2 x 2" : "",
             scheme->shadow != SHADOW_NONE ? ", " : "",
             scheme->shadow != SHADOW_NONE ? word_of("shadow", (int)scheme->shadow) : "");
}

json_t *image_to_json(const ImageBench *bench, const ImageOptions *options,
                      const ImageResult *result)
{
    const RendererCounts *counts = &result->counts;
    const ImageScheme *scheme = &options->scheme;
    char name[64];
    name_scheme(scheme, name, sizeof name);
    json_t *row = json_pack(
        "{s:s, s:I, s:I, s:[i,i], s:s, s:s, s:s, s:i, s:i, s:s, s:s, s:f, s:f, s:f, s:I, s:I, s:s, "
        "s:s, s:s, s:s, s:s}",
        "set", bench->name, "strands", (json_int_t)bench->strands.strand_count, "particles",
        (json_int_t)bench->strands.vertex_count, "size", bench->size[0], bench->size[1], "scheme",
        name, "raster", word_of("raster", (int)result->raster), "oit",
        word_of("oit", (int)scheme->oit), "layers", scheme->layers, "samples", scheme->samples,
        "shadow", word_of("shadow", (int)scheme->shadow), "quality",
        word_of("quality", (int)scheme->quality), "median_ms", result->median_ms, "min_ms",
        result->min_ms, "covered", result->covered, "segments", (json_int_t)counts->segments,
        "fragments", (json_int_t)counts->fragments, "passes", result->spans, "renderer",
        bench->gpu->renderer, "gl_version", bench->gpu->version, "version", TRACTRIX_VERSION,
        "commit", TRACTRIX_COMMIT);
    if (row && result->rms >= 0) {
        json_object_set_new(row, "rms", json_real(result->rms));
        json_object_set_new(row, "reference_s", json_real(result->reference_s));
    }
    return row;
}

void image_print_head(FILE *stream)
{
    fprintf(stream, "%-22s %-26s %9s %9s %7s %8s  %s\n", "set", "scheme", "draw ms", "(min)", "RMS",
            "covered", "passes, ms");
}

void image_print(const ImageBench *bench, const ImageOptions *options, const ImageResult *result,
                 FILE *stream)
{
    char name[64];
    name_scheme(&options->scheme, name, sizeof name);
    fprintf(stream, "%-22s %-26s %9.2f %9.2f ", bench->name, name, result->median_ms,
            result->min_ms);
    if (result->rms >= 0)
        fprintf(stream, "%7.2f %7.1f%%", result->rms, 100 * result->covered);
    else
        fprintf(stream, "%7s %8s", "-", "-");
    fprintf(stream, "  %s\n", result->spans);
}
