// SPDX-License-Identifier: MIT
#include "base/clock.h"
#include "base/interrupt.h"
#include "bench/bench_commands.h"
#include "draw/renderer.h"
#include "formats/strands_read.h"
#include "gen/strands_make.h"
#include "reference/shadow_reference.h"
#include "scene/outline.h"
#include "scene/scene.h"
#include "strands/paint.h"
#include "strands/strands_resample.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const BenchScheme SCHEMES[] = {
    {.raster = RASTER_BLOCKS},
    {.raster = RASTER_BLOCKS, .samples = 2},
    {.raster = RASTER_BLOCKS, .samples = 4},
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
enum { SCHEME_COUNT = sizeof SCHEMES / sizeof *SCHEMES };
static const char *const SETS[] = {"straight", "curls", "fur", "files", NULL};

// Hair in front of a camera that frames it, and its exact images, which are drawn when they are
// first needed.
typedef struct Stage {
    const BenchOptions *options;
    const Gpu *gpu;
    const char *set, *file; // one of the two is NULL
    Scene scene;            // one section with default parameters
    Strands strands;
    Hair hair;
    float radius; // m: radius of a fibre
    View view;
    struct Exact {
        Image image;    // no pixels until it is needed
        double seconds; // time to draw it
    } exact[2][2];      // [with shadows][smooth]
} Stage;

// How the hair is drawn. The strings belong to the scene.
typedef struct Manner {
    RunParams run;
    SectionParams material;
} Manner;

// ms: wall time of drawing and reading back. cpu_ms: processor time of all threads for the same,
// which depends less on other load of the machine. `rms`: levels of 255 over the pixels that differ
// from the background in either image; `covered`: the share of these pixels. `passes`: the least ms
// of each pass, measured with a wait after each. `reference_s`: seconds for the exact image, NaN
// without one.
// clang-format off
#define ROW(X)                                                                                     \
    X(CHARS, set, 19) X(CHARS, scheme, 23) X(REAL, ms_min, 7) X(REAL, ms_median, 9)                \
    X(REAL, cpu_ms_min, 10) X(REAL, cpu_ms_median, 13) X(REAL, rms, 6) X(REAL, covered, 7)         \
    X(CHARS, passes, 1) X(WHOLE, strands, 0) X(WHOLE, particles, 0) X(WHOLE, width, 0)             \
    X(WHOLE, height, 0) X(TEXT, raster, 0) X(TEXT, oit, 0) X(WHOLE, layers, 0)                     \
    X(WHOLE, samples, 0) X(TEXT, shadow, 0) X(TEXT, quality, 0) X(WHOLE, segments, 0)              \
    X(WHOLE, fragments, 0) X(REAL, reference_s, 0) X(CHARS, command, 0)
// clang-format on

typedef struct Row {
    ROW(TABLE_FIELD)
} Row;
static const Column COLUMNS[] = {ROW(TABLE_COLUMN)};

// --- The stage.

static Result read_hair(const Stage *stage, Strands *strands, Error *error)
{
    static const struct {
        const char *name;
        StrandsStyle style;
        uint32_t count, vertices;
    } sets[] = {{"straight", STRANDS_STYLE_STRAIGHT, 10000, 32},
                {"curls", STRANDS_STYLE_CURLS, 10000, 32},
                {"curls100k", STRANDS_STYLE_CURLS, 100000, 32},
                {"fur", STRANDS_STYLE_FUR, 37747, 8}};
    if (!stage->set)
        return strands_read(strands, stage->file, &(StrandsReadOptions){0}, NULL, error);
    for (size_t i = 0; i < sizeof sets / sizeof *sets; ++i) {
        if (strcmp(stage->set, sets[i].name) != 0) continue;
        StrandsRecipe recipe = strands_make_recipe(sets[i].style);
        recipe.count = sets[i].count, recipe.vertices = sets[i].vertices;
        return strands_make(strands, &recipe, error);
    }
    return strands_make_set(strands, stage->set, 1, error);
}

// The stage must be destroyed even if this fails.
static Result stage_create(Stage *stage, const BenchOptions *options, const Gpu *gpu,
                           const char *set, const char *file, Error *error)
{
    static const int usual[2] = {1280, 720};
    SectionParams params = {0};
    Framing framing;
    *stage = (Stage){.options = options, .gpu = gpu, .set = set, .file = file};
    TRY(scene_create_as(&stage->scene, &(Presets){.look = "plain"}, error));
    Result result = params_create_section(&params, error);
    params.followers = (AutoInt){.value = 0};
    THEN(result, scene_add_section(&stage->scene, set ? set : file, &params, error));
    params_destroy_section(&params);
    THEN(result, read_hair(stage, &stage->strands, error));
    THEN(result, hair_create(&stage->hair, &stage->strands, 0, &gpu->limits, error));
    TRY(result);
    stage->radius = paint_auto_radius(&stage->strands, 0);
    memcpy(stage->scene.run.size, options->size[0] ? options->size : usual, sizeof usual);
    outline_frame(&framing, &stage->scene, &stage->strands, NULL);
    camera_view(&stage->view, &stage->scene, &framing, 0);
    return RESULT_OK;
}

static void stage_destroy(Stage *stage)
{
    for (int i = 0; i < 4; ++i) image_destroy(&stage->exact[i / 2][i % 2].image);
    hair_destroy(&stage->hair);
    strands_destroy(&stage->strands);
    scene_destroy(&stage->scene);
}

static const char *word_of(const char *param, int value)
{
    return params_find(param)->choices[value];
}

static Result find_manner(const Stage *stage, const BenchScheme *scheme, Manner *manner,
                          Error *error)
{
    *manner = (Manner){stage->scene.run, stage->scene.sections[0].params};
    const Presets presets = {"plain", word_of("quality", (int)scheme->quality)};
    TRY(scene_apply_presets(&presets, SCOPE_RUN, &manner->run, error));
    TRY(scene_apply_presets(&presets, SCOPE_SECTION, &manner->material, error));
    manner->run.raster = scheme->raster;
    if (scheme->oit != OIT_AUTO) manner->run.oit = scheme->oit;
    if (scheme->layers) manner->run.oit_layers = scheme->layers;
    if (scheme->samples) manner->run.samples = scheme->samples;
    if (scheme->shadow != SHADOW_NONE) manner->run.shadow = scheme->shadow;
    return RESULT_OK;
}

// --- The exact image.

// The share of each light that reaches each vertex: [light_count][vertex_count]. Free `left`.
static Result find_left(const ReferenceScene *scene, const float middle[3], float **left,
                        Error *error)
{
    uint32_t count = scene->items[0].strands->vertex_count;
    *left = malloc((size_t)scene->light_count * count * sizeof **left);
    if (!*left) return error_set(error, RESULT_FAILED, "no memory for %u vertices' light", count);
    for (uint32_t i = 0; i < scene->light_count; ++i) {
        float *of_light = *left + (size_t)i * count;
        ShadowReference shadow;
        for (uint32_t v = 0; v < count; ++v) of_light[v] = 1;
        if (!scene->lights[i].shadow) continue;
        TRY(shadow_reference_create(&shadow, scene, &scene->lights[i], middle, error));
        shadow_reference_fill(&shadow, &scene->items[0], of_light);
        shadow_reference_destroy(&shadow);
    }
    return RESULT_OK;
}

static Result draw_exact(const Stage *stage, const Manner *manner, const Strands *strands,
                         Image *image, Error *error)
{
    float *left = NULL, middle[3];
    const RunParams *run = &stage->scene.run;
    ReferenceItem item = {
        .strands = strands, .material = &manner->material, .radius = stage->radius};
    ReferenceScene scene = {.view = &stage->view,
                            .lights = stage->scene.lights,
                            .light_count = stage->scene.light_count,
                            .items = &item,
                            .item_count = 1,
                            .seed = run->seed};
    memcpy(scene.background, run->background, sizeof scene.background);
    for (int k = 0; k < 3; ++k) middle[k] = 0.5f * (stage->hair.low[k] + stage->hair.high[k]);
    Result result =
        manner->run.shadow != SHADOW_NONE ? find_left(&scene, middle, &left, error) : RESULT_OK;
    item.left = left;
    THEN(result, image_create(image, run->size[0], run->size[1], 3, error));
    THEN(result, image_reference_draw(image, &scene, REFERENCE_SIDE, error));
    free(left);
    return result;
}

// Returns the exact image for a manner, which takes many seconds to draw the first time. Smooth
// strands are drawn through extra vertices on their curves. The exact image has all strands, also
// those that the manner leaves out.
static Result find_exact(Stage *stage, const Manner *manner, const struct Exact **found,
                         Error *error)
{
    uint32_t parts = (uint32_t)manner->material.smooth;
    struct Exact *exact = &stage->exact[manner->run.shadow != SHADOW_NONE][parts > 1];
    *found = exact;
    if (exact->image.pixels) return RESULT_OK;
    Strands strands = {0};
    double begin = clock_ms();
    TRY(read_hair(stage, &strands, error));
    Result result = RESULT_OK;
    if (parts > 1) {
        const ResampleOptions resample = {.count = parts * (strands_size(&strands, 0) - 1) + 1,
                                          .spline = true};
        result = strands_resample(&strands, &resample, error);
    }
    THEN(result, draw_exact(stage, manner, &strands, &exact->image, error));
    strands_destroy(&strands);
    exact->seconds = (clock_ms() - begin) / 1000;
    return result;
}

// Compares the pixels that differ from the background in either image.
static void compare(const Image *exact, const float background[3], const Image *image, Row *row)
{
    uint8_t behind[3];
    size_t count = (size_t)image->width * (size_t)image->height, covered = 0;
    double sum = 0;
    for (int k = 0; k < 3; ++k) behind[k] = (uint8_t)lrintf(255 * background[k]);
    for (size_t i = 0; i < count; ++i) {
        const uint8_t *p = image->pixels + 3 * i, *q = exact->pixels + 3 * i;
        if (memcmp(p, behind, 3) == 0 && memcmp(q, behind, 3) == 0) continue;
        ++covered;
        for (int k = 0; k < 3; ++k) sum += (p[k] - q[k]) * (p[k] - q[k]) / 3.0;
    }
    row->rms = sqrt(sum / (double)(covered ? covered : 1));
    row->covered = (double)covered / (double)count;
}

// --- Drawing.

enum { WARM_UP = 2, PASS_FRAMES = 4 };

// Draws some more images with a wait after each pass, and keeps the least time of each pass.
static Result time_passes(Renderer *renderer, const RenderFrame *frame, const RenderItem *item,
                          Image *image, Row *row, Error *error)
{
    GpuTimer *timer = renderer->timer;
    double least[TIMER_MAX_LABELS] = {0}, before[TIMER_MAX_LABELS] = {0};
    timer->enabled = true;
    for (int i = 0; i < PASS_FRAMES; ++i) {
        TRY(renderer_draw(renderer, frame, item, 1, image, error));
        gpu_timer_collect(timer);
        for (int k = 0; k < timer->count; ++k) {
            double ms = timer->labels[k].total_ms - before[k];
            before[k] = timer->labels[k].total_ms;
            least[k] = i ? fmin(least[k], ms) : ms;
        }
    }
    size_t at = 0;
    for (int k = 0; k < timer->count && at < sizeof row->passes; ++k)
        at += (size_t)snprintf(row->passes + at, sizeof row->passes - at, "%s%s %.1f",
                               k ? ", " : "", timer->labels[k].name, least[k]);
    return RESULT_OK;
}

static Result draw_frames(const Stage *stage, const Manner *manner, Renderer *renderer,
                          double *wall, double *processor, Image *image, Row *row, Error *error)
{
    const RenderItem item = {
        .hair = &stage->hair, .material = &manner->material, .radius = stage->radius};
    const RenderFrame frame = {.view = &stage->view,
                               .lights = stage->scene.lights,
                               .light_count = stage->scene.light_count,
                               .head_rotation = {0, 0, 0, 1}};
    int frames = stage->options->frames;
    for (int i = -WARM_UP; i < frames; ++i) {
        glFinish();
        double begin = clock_ms(), begin_processor = clock_processor_ms();
        TRY(renderer_draw(renderer, &frame, &item, 1, image, error));
        if (i < 0) continue;
        wall[i] = clock_ms() - begin;
        processor[i] = clock_processor_ms() - begin_processor;
    }
    Times by_clock = table_times(wall, frames), by_processor = table_times(processor, frames);
    row->ms_min = by_clock.minimum, row->ms_median = by_clock.median;
    row->cpu_ms_min = by_processor.minimum, row->cpu_ms_median = by_processor.median;
    row->segments = (long)renderer->counts.segments;
    row->fragments = (long)renderer->counts.fragments;
    return time_passes(renderer, &frame, &item, image, row, error);
}

// Options for images of the stage's size on an opaque background.
static RendererOptions renderer_options(const Stage *stage, const RunParams *run)
{
    RendererOptions options = renderer_options_of(run);
    options.width = stage->scene.run.size[0];
    options.height = stage->scene.run.size[1];
    options.background[3] = 1;
    return options;
}

static Result measure(Stage *stage, const BenchScheme *scheme, Row *row, Error *error)
{
    Renderer renderer;
    GpuTimer timer;
    Image image = {0};
    Manner manner;
    const struct Exact *exact;
    size_t frames = (size_t)stage->options->frames;
    TRY(find_manner(stage, scheme, &manner, error));
    const RendererOptions how = renderer_options(stage, &manner.run);
    double *samples = calloc(2 * frames, sizeof *samples);
    if (!samples) return error_set(error, RESULT_FAILED, "no memory for samples");
    gpu_timer_create(&timer, false, stage->gpu->software);
    Result result = renderer_create(&renderer, stage->gpu, &timer, &how, error);
    if (result == RESULT_OK) row->raster = word_of("raster", (int)renderer.options.raster);
    THEN(result, image_create(&image, how.width, how.height, 3, error));
    THEN(result,
         draw_frames(stage, &manner, &renderer, samples, samples + frames, &image, row, error));
    renderer_destroy(&renderer);
    gpu_timer_destroy(&timer);
    free(samples);
    row->rms = row->covered = row->reference_s = NAN;
    if (!stage->options->no_error) {
        THEN(result, find_exact(stage, &manner, &exact, error));
        if (result == RESULT_OK) {
            compare(&exact->image, manner.run.background, &image, row);
            row->reference_s = exact->seconds;
        }
    }
    image_destroy(&image);
    return result;
}

// --- Rows.

// Writes the name of a scheme, such as "quads, k = 8, 2 x 2, dom"; for a quality preset its name.
static void name_scheme(const BenchScheme *scheme, char *name, size_t size)
{
    char layers[24] = "", samples[32] = "";
    bool quads = scheme->raster == RASTER_QUADS || scheme->oit != OIT_AUTO || scheme->layers;
    if (scheme->oit == OIT_NONE)
        snprintf(layers, sizeof layers, ", none");
    else if (quads)
        snprintf(layers, sizeof layers, ", k = %d", scheme->layers ? scheme->layers : 8);
    if (scheme->samples > 1)
        snprintf(samples, sizeof samples, ", %d x %d", scheme->samples, scheme->samples);
    const char *first = scheme->quality != QUALITY_NORMAL ? word_of("quality", (int)scheme->quality)
                                                          : word_of("raster", (int)scheme->raster);
    snprintf(name, size, "%s%s%s%s%s", first, layers, samples,
             scheme->shadow != SHADOW_NONE ? ", " : "",
             scheme->shadow != SHADOW_NONE ? word_of("shadow", (int)scheme->shadow) : "");
}

// Writes the command that repeats the row. It leaves out settings that have their defaults.
static void write_command(const Stage *stage, const BenchScheme *scheme, Row *row)
{
    char layers[24] = "", samples[24] = "";
    if (scheme->layers) snprintf(layers, sizeof layers, " --layers %d", scheme->layers);
    if (scheme->samples) snprintf(samples, sizeof samples, " --samples %d", scheme->samples);
    snprintf(row->command, sizeof row->command,
             "tractrix-bench image --%s %s --raster %s --oit %s%s%s --shadow %s --quality %s "
             "--size %ldx%ld --frames %d",
             stage->set ? "set" : "tfx", stage->set ? stage->set : stage->file,
             word_of("raster", (int)scheme->raster), row->oit, layers, samples, row->shadow,
             row->quality, row->width, row->height, stage->options->frames);
}

static Result add_row(Table *table, Stage *stage, const BenchScheme *scheme, Error *error)
{
    const char *name = stage->set ? stage->set : stage->file, *slash = strrchr(name, '/');
    Row row = {.layers = scheme->layers, .samples = scheme->samples};
    row.strands = stage->strands.strand_count, row.particles = stage->strands.vertex_count;
    row.width = stage->scene.run.size[0], row.height = stage->scene.run.size[1];
    row.oit = word_of("oit", (int)scheme->oit);
    row.shadow = word_of("shadow", (int)scheme->shadow);
    row.quality = word_of("quality", (int)scheme->quality);
    if (interrupt_requested()) return error_set(error, RESULT_INTERRUPTED, "interrupted");
    TRY(measure(stage, scheme, &row, error));
    snprintf(row.set, sizeof row.set, "%s", slash ? slash + 1 : name);
    name_scheme(scheme, row.scheme, sizeof row.scheme);
    write_command(stage, scheme, &row);
    table_add(table, &row);
    return RESULT_OK;
}

// Adds a row for each scheme on one set or file.
static Result add_rows(Table *table, const BenchOptions *options, const char *set, const char *file,
                       const BenchScheme *schemes, int count, Error *error)
{
    Stage stage;
    Result result = stage_create(&stage, options, table->gpu, set, file, error);
    for (int i = 0; i < count; ++i) THEN(result, add_row(table, &stage, &schemes[i], error));
    stage_destroy(&stage);
    return result;
}

Result images_run_one(const BenchOptions *options, const Gpu *gpu, Error *error)
{
    Table table;
    TRY(bench_options_some_frames(options, error));
    if (!options->set == !options->tfx)
        return error_set(error, RESULT_USAGE, "image: one of --set NAME and --tfx FILE is needed");
    Result result = table_open(&table, TABLE_COLUMNS, gpu, &options->output, stdout, error);
    THEN(result, add_rows(&table, options, options->set, options->tfx, &options->scheme, 1, error));
    return table_close(&table, result, error);
}

Result images_run(const BenchOptions *options, const Gpu *gpu, Error *error)
{
    Table table;
    TRY(bench_options_some_frames(options, error));
    TRY(bench_options_check_parts(options, SETS, error));
    Result result = table_open(&table, TABLE_COLUMNS, gpu, &options->output, stdout, error);
    for (int i = 0; SETS[i]; ++i)
        if (strcmp(SETS[i], "files") != 0 && bench_options_part(options, SETS[i]))
            THEN(result, add_rows(&table, options, SETS[i], NULL, SCHEMES, SCHEME_COUNT, error));
    for (int i = 0; i < options->file_count && bench_options_part(options, "files"); ++i)
        THEN(result,
             add_rows(&table, options, NULL, options->files[i], SCHEMES, SCHEME_COUNT, error));
    return table_close(&table, result, error);
}
