// SPDX-License-Identifier: MIT
#include "base/clock.h"
#include "bench/bench_commands.h"
#include "bench/light_case.h"
#include "bench/light_stage.h"
#include "bench/light_traced.h"
#include "image/pfm.h"
#include "image/png.h"
#include "run/caption.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// A way to compute light in hair: flags of tractrix-render, the table of the path tracer that has
// the same bounces, and the bounds that the docs state. Bounds apply to each channel: to a case's
// mean over the tracer's mean, to its rel (light_case.h), and to the mean rel of all cases. NaN: no
// bound.
typedef struct Way {
    const char *name, *flags;
    LightTable table;
    bool extra; // measured only if it is named, or with --way all
    double mean_least, mean_most, rel_most, all_rel_most;
    int orders; // not 0: drawn by light_traced.h, which follows this many
} Way;

// The path tracer's strands are smooth curves through the vertices, as with --smooth.
#define CURVES  "--smooth 3 --shadow-size 512 "
#define UNBOUND LIGHT_ALL, true, NAN, NAN, NAN, NAN, 0
static const Way WAYS[] = {
    {"none", CURVES "--scatter none", LIGHT_ONE, false, 0.93, 1.08, 0.16, NAN, 0},
    {"grid", CURVES "--scatter grid", LIGHT_ALL, false, 0.92, 1.12, 0.16, 0.10, 0},
    {"draft", "--quality draft", UNBOUND},
    {"normal", "--quality normal", UNBOUND},
    {"final", "--quality final", UNBOUND},
    {"cells 8", CURVES "--scatter grid --scatter-cells 8", UNBOUND},
    {"cells 12", CURVES "--scatter grid --scatter-cells 12", UNBOUND},
    {"cells 16", CURVES "--scatter grid --scatter-cells 16", UNBOUND},
    {"cells 24", CURVES "--scatter grid --scatter-cells 24", UNBOUND},
    {"cells 48", CURVES "--scatter grid --scatter-cells 48", UNBOUND},
    {"map 128", CURVES "--scatter grid --shadow-size 128", UNBOUND},
    {"map 256", CURVES "--scatter grid --shadow-size 256", UNBOUND},
    {"map 1024", CURVES "--scatter grid --shadow-size 1024", UNBOUND},
    {"straight", CURVES "--scatter grid --smooth 1", UNBOUND},
    {"traced one", "", LIGHT_ONE, true, NAN, NAN, NAN, NAN, 1},
    {"traced", "", LIGHT_ALL, true, NAN, NAN, NAN, NAN, TRACED_ORDERS},
};
enum { WAY_COUNT = sizeof WAYS / sizeof *WAYS };

// `mean_*`: the mean over the tracer's mean; `rel_*`: the RMS difference of blocks over the RMS of
// the tracer's blocks; `coverage`: over the tracer's. `moving_ms_*`: an image of moving hair, for
// which light is computed again; `still_ms_*`: an image of hair at rest. `repeat`: the RMS
// difference of the last image from the first, over the RMS of the first.
// clang-format off
#define ROW(X)                                                                                     \
    X(CHARS, scene, 18) X(TEXT, way, 9) X(TEXT, bounces, 7)                                        \
    X(REAL, mean_r, 7) X(REAL, mean_g, 7) X(REAL, mean_b, 7)                                       \
    X(REAL, rel_r, 7) X(REAL, rel_g, 7) X(REAL, rel_b, 7) X(REAL, coverage, 8)                     \
    X(REAL, moving_ms_min, 13) X(REAL, moving_ms_median, 0)                                        \
    X(REAL, still_ms_min, 12) X(REAL, still_ms_median, 0)                                          \
    X(CHARS, bounds, 16) X(TEXT, verdict, 7)                                                       \
    X(REAL, mean_least, 0) X(REAL, mean_most, 0) X(REAL, rel_most, 0) X(REAL, repeat, 0)           \
    X(TEXT, raster, 0) X(WHOLE, width, 0) X(WHOLE, height, 0) X(WHOLE, strands, 0)                 \
    X(TEXT, flags, 0) X(CHARS, command, 0)
// clang-format on

typedef struct Row {
    ROW(TABLE_FIELD)
} Row;
static const Column COLUMNS[] = {ROW(TABLE_COLUMN)};

// Sums over the cases of one way.
typedef struct Sum {
    Row row; // its numbers are sums
    int cases;
} Sum;

typedef struct LightRun {
    const BenchOptions *options;
    const Gpu *gpu;
    Table table;
    LightCases cases;
    Sum sums[WAY_COUNT];
    ImageSheet sheet; // for --picture
} LightRun;

// --- Drawing a case.

// Opens a case's scene with three sets of flags; later flags override earlier ones.
static Result open_stage(LightStage *stage, const Gpu *gpu, const LightCase *lit,
                         const char *const flags[3], Error *error)
{
    TRY(light_stage_create(stage, gpu, lit->scene, flags, error));
    const int *size = stage->scene.run.size;
    if (size[0] == lit->columns * LIGHT_BLOCK_PX && size[1] == lit->rows * LIGHT_BLOCK_PX)
        return RESULT_OK;
    return error_set(
        error, RESULT_BAD_INPUT,
        "%s: %d x %d blocks of %d pixels: expected blocks for images of %dx%d, the size in %s",
        lit->table, lit->columns, lit->rows, LIGHT_BLOCK_PX, size[0], size[1], lit->scene);
}

static Result time_frames(LightStage *stage, bool moved, int frames, Times *times, Error *error)
{
    double *samples = calloc((size_t)frames + 1, sizeof *samples);
    if (!samples) return error_set(error, RESULT_FAILED, "no memory for %d samples", frames);
    Result result = RESULT_OK;
    for (int i = -(frames > 0); i < frames && result == RESULT_OK; ++i) {
        glFinish();
        double begin = clock_ms();
        result = light_stage_draw(stage, moved, error);
        if (i >= 0) samples[i] = clock_ms() - begin;
    }
    *times = table_times(samples, frames);
    free(samples);
    return result;
}

// --- Figures.

static double difference(const Image *image, const float *first)
{
    const float *now = (const float *)(const void *)image->pixels;
    double off = 0, all = 0;
    for (size_t i = 0; i < image_size(image) / sizeof *now; ++i) {
        double a = (double)first[i], b = (double)now[i];
        off += (b - a) * (b - a), all += a * a;
    }
    return sqrt(off / all);
}

static void compare(const LightCase *lit, const Way *way, const Image *image, Row *row)
{
    LightError off = light_case_compare(lit, way->table, image);
    row->mean_r = off.mean[0], row->mean_g = off.mean[1], row->mean_b = off.mean[2];
    row->rel_r = off.rel[0], row->rel_g = off.rel[1], row->rel_b = off.rel[2];
}

// Compares our own path tracer's image.
static Result measure_traced(LightStage *stage, const LightCase *lit, const Way *way, int frames,
                             Row *row, Error *error)
{
    TRY(light_traced_draw(stage, &stage->image, way->orders, TRACED_PATHS * frames, error));
    compare(lit, way, &stage->image, row);
    row->moving_ms_min = row->moving_ms_median = row->still_ms_min = row->still_ms_median = NAN;
    return RESULT_OK;
}

// Compares the first image, which is the image that a run of one frame writes. Then measures times,
// which are NaN if FRAMES is 0.
static Result measure(LightStage *stage, const LightCase *lit, const Way *way, int frames, Row *row,
                      Error *error)
{
    Times moving, still;
    TRY(light_stage_draw(stage, true, error));
    compare(lit, way, &stage->image, row);
    float *first = malloc(image_size(&stage->image));
    if (!first) return error_set(error, RESULT_FAILED, "no memory for an image");
    memcpy(first, stage->image.pixels, image_size(&stage->image));
    Result result = time_frames(stage, true, frames, &moving, error);
    THEN(result, time_frames(stage, false, frames, &still, error));
    if (result == RESULT_OK) {
        row->moving_ms_min = moving.minimum, row->moving_ms_median = moving.median;
        row->still_ms_min = still.minimum, row->still_ms_median = still.median;
        if (frames > 0) row->repeat = difference(&stage->image, first);
    }
    memcpy(stage->image.pixels, first, image_size(&stage->image));
    free(first);
    return result;
}

static const char *raster_word(const BenchOptions *options)
{
    return params_find("raster")->choices[options->scheme.raster];
}

// The coverage over the tracer's coverage. It is the same for all ways.
static Result find_coverage(LightRun *run, const LightCase *lit, double *coverage, Error *error)
{
    char raster[64];
    LightStage stage;
    const char *own = run->options->render ? run->options->render : "";
    snprintf(raster, sizeof raster, "--aov coverage --raster %s", raster_word(run->options));
    Result result = open_stage(&stage, run->gpu, lit, (const char *[]){raster, own, ""}, error);
    THEN(result, light_stage_draw(&stage, true, error));
    if (result == RESULT_OK)
        *coverage = light_case_compare(lit, LIGHT_COVERAGE, &stage.image).mean[0];
    light_stage_destroy(&stage);
    return result;
}

// --- Bounds.

// The worse of two verdicts: "broken" before "holds" before "".
static const char *worse(const char *a, const char *b)
{
    return strcmp(a, "broken") == 0 || !*b ? a : b;
}

static const char *check_row(Table *table, const Way *way, const Row *row)
{
    const double mean[] = {row->mean_r, row->mean_g, row->mean_b};
    const double rel[] = {row->rel_r, row->rel_g, row->rel_b};
    const char *verdict = "";
    for (int k = 0; k < 3; ++k) {
        if (!isnan(way->mean_most))
            verdict = worse(verdict, table_check_within(table, mean[k], way->mean_least,
                                                        way->mean_most, "%s, %s, mean of %c",
                                                        row->scene, row->way, "rgb"[k]));
        verdict = worse(verdict, table_check(table, rel[k], way->rel_most, "%s, %s, rel of %c",
                                             row->scene, row->way, "rgb"[k]));
    }
    return verdict;
}

static void say_bounds(Row *row, const Way *way)
{
    row->mean_least = way->mean_least, row->mean_most = way->mean_most;
    row->rel_most = way->rel_most;
    if (isnan(way->mean_most)) return;
    int at =
        snprintf(row->bounds, sizeof row->bounds, "%.2f..%.2f", way->mean_least, way->mean_most);
    if (!isnan(way->rel_most))
        snprintf(row->bounds + at, sizeof row->bounds - (size_t)at, ", %.2f", way->rel_most);
}

// --- Rows.

static Row row_of(const LightRun *run, const char *scene, const Way *way)
{
    const BenchOptions *options = run->options;
    const char *own = options->render;
    Row row = {.way = way->name, .verdict = "", .flags = way->flags, .repeat = NAN};
    row.bounces = way->table == LIGHT_ONE ? "one" : "all";
    row.raster = raster_word(options);
    row.mean_least = row.mean_most = row.rel_most = NAN;
    snprintf(row.scene, sizeof row.scene, "%s", scene);
    snprintf(row.command, sizeof row.command,
             "tractrix-bench light%s%s --case %s --way %s --raster %s%s%s%s --frames %d",
             options->reference ? " --reference " : "",
             options->reference ? options->reference : "", scene, way->name, row.raster,
             own ? " --render='" : "", own ? own : "", own ? "'" : "", options->frames);
    return row;
}

static void add_to_sum(Sum *sum, const Row *row)
{
    if (sum->cases++ == 0) {
        sum->row = *row;
        return;
    }
    for (size_t i = 0; i < sizeof COLUMNS / sizeof *COLUMNS; ++i) {
        if (COLUMNS[i].kind != COLUMN_REAL) continue;
        double *all = (double *)(void *)((char *)&sum->row + COLUMNS[i].place);
        *all += *(const double *)(const void *)((const char *)row + COLUMNS[i].place);
    }
}

// Adds the means over the cases. The bound of the mean rel is checked if all cases of a folder were
// measured.
static void add_mean(LightRun *run, int w)
{
    const Way *way = &WAYS[w];
    Sum *sum = &run->sums[w];
    if (sum->cases == 0) return;
    Row row = row_of(run, "mean", way);
    for (size_t i = 0; i < sizeof COLUMNS / sizeof *COLUMNS; ++i)
        if (COLUMNS[i].kind == COLUMN_REAL)
            *(double *)(void *)((char *)&row + COLUMNS[i].place) =
                *(double *)(void *)((char *)&sum->row + COLUMNS[i].place) / sum->cases;
    row.mean_least = row.mean_most = row.rel_most = NAN;
    row.width = sum->row.width, row.height = sum->row.height;
    *row.command = 0;
    if (!run->options->case_name && !isnan(way->all_rel_most)) {
        const Way all = {.mean_least = NAN, .mean_most = NAN, .rel_most = way->all_rel_most};
        row.rel_most = way->all_rel_most;
        snprintf(row.bounds, sizeof row.bounds, "rel %.2f", way->all_rel_most);
        row.verdict = check_row(&run->table, &all, &row);
    }
    table_add(&run->table, &row);
}

// --- The sheet of --picture. Each case has a row: the image of --before, each way, the path
// tracer; all at one exposure.

// In %: PICTURE_SHARE of the blocks with hair stay below PICTURE_LEVEL of white.
enum { PICTURE_LEVEL = 80, PICTURE_SHARE = 98 };

static int compare_numbers(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// The exposure factor that maps the tracer's bright blocks to PICTURE_LEVEL.
static Result find_exposure(const LightCase *lit, double *exposure, Error *error)
{
    int count = 0, all = lit->columns * lit->rows;
    double *light = malloc((size_t)all * sizeof *light);
    if (!light) return error_set(error, RESULT_FAILED, "no memory for %d blocks", all);
    for (int i = 0; i < all; ++i) {
        const double *rgb = lit->blocks[LIGHT_ALL][i];
        if (lit->blocks[LIGHT_COVERAGE][i][0] > 0.5)
            light[count++] = fmax(rgb[0], fmax(rgb[1], rgb[2]));
    }
    qsort(light, (size_t)count, sizeof *light, compare_numbers);
    double bright = count ? light[(count - 1) * PICTURE_SHARE / 100] : 0;
    *exposure = bright > 0 ? PICTURE_LEVEL / 100.0 / bright : 1;
    free(light);
    return RESULT_OK;
}

// Converts light times exposure to an sRGB image with a caption.
static Result expose(const Image *light, double exposure, const char *name, Image *shown,
                     Error *error)
{
    const float *from = (const float *)(const void *)light->pixels;
    TRY(image_create(shown, light->width, light->height, 3, error));
    for (size_t i = 0; i < (size_t)light->width * (size_t)light->height; ++i)
        for (size_t k = 0; k < 3; ++k) {
            double value = exposure * (double)from[i * (size_t)light->channels + k];
            shown->pixels[3 * i + k] = (uint8_t)lrint(255 * image_srgb_from_linear(value));
        }
    caption_draw(shown, name);
    return RESULT_OK;
}

static Result add_tile(LightRun *run, const LightCase *lit, const Image *light, const char *name,
                       Error *error)
{
    double exposure = 1;
    Image shown = {0};
    if (!run->options->picture) return RESULT_OK;
    const Image *tile = &run->sheet.image;
    if (light->width != tile->width / run->sheet.columns ||
        light->height != tile->height / run->sheet.rows)
        return error_set(error, RESULT_BAD_INPUT,
                         "--picture: %s is %dx%d: expected the same size for all cases and images",
                         lit->name, light->width, light->height);
    TRY(find_exposure(lit, &exposure, error));
    Result result = expose(light, exposure, name, &shown, error);
    if (result == RESULT_OK) image_sheet_add(&run->sheet, &shown);
    image_destroy(&shown);
    return result;
}

// The tracer's light at a point, interpolated bilinearly between the centres of blocks.
static double between(const LightCase *lit, LightTable table, double x, double y, int channel)
{
    double sum = 0;
    for (int corner = 0; corner < 4; ++corner) {
        double column = floor(x) + corner % 2, row = floor(y) + corner / 2;
        double weight = (1 - fabs(x - column)) * (1 - fabs(y - row));
        column = fmin(fmax(column, 0), lit->columns - 1), row = fmin(fmax(row, 0), lit->rows - 1);
        sum += weight * lit->blocks[table][(int)row * lit->columns + (int)column][channel];
    }
    return sum;
}

static Result add_traced(LightRun *run, const LightCase *lit, LightTable table, Error *error)
{
    Image light = {0};
    if (!run->options->picture) return RESULT_OK;
    TRY(image_create_kind(&light, lit->columns * LIGHT_BLOCK_PX, lit->rows * LIGHT_BLOCK_PX, 3,
                          IMAGE_FLOAT, error));
    float *pixels = (float *)(void *)light.pixels;
    for (int i = 0; i < light.width * light.height; ++i)
        for (int k = 0; k < 3; ++k)
            pixels[3 * i + k] =
                (float)between(lit, table, (i % light.width + 0.5) / LIGHT_BLOCK_PX - 0.5,
                               (i / light.width + 0.5) / LIGHT_BLOCK_PX - 0.5, k);
    Result result = add_tile(run, lit, &light, "path tracer, blocks", error);
    image_destroy(&light);
    return result;
}

static Result add_before(LightRun *run, const LightCase *lit, Error *error)
{
    char path[4096];
    Bytes file = {0};
    Image light = {0};
    if (!run->options->before) return RESULT_OK;
    snprintf(path, sizeof path, "%s/%s.pfm", run->options->before, lit->name);
    TRY(bytes_read_file(&file, path, error));
    Result result = pfm_decode(&light, &file, path, error);
    THEN(result, add_tile(run, lit, &light, "before", error));
    image_destroy(&light);
    bytes_destroy(&file);
    return result;
}

// --- All cases.

// Whether to measure a way: it is named, or --way all (without those by our path tracer, which take
// minutes), or without --way it has bounds.
static bool is_wanted(const BenchOptions *options, const Way *way)
{
    if (!options->ways) return !way->extra;
    return (bench_options_lists(options->ways, "all") && !way->orders) ||
           bench_options_lists(options->ways, way->name);
}

static Result check_ways(const BenchOptions *options, Error *error)
{
    const char *names[WAY_COUNT + 2] = {"all"};
    for (int w = 0; w < WAY_COUNT; ++w) names[w + 1] = WAYS[w].name;
    TRY(bench_options_check_list("--way", options->ways, names, error));
    for (int w = 0; w < WAY_COUNT; ++w)
        if (WAYS[w].orders && is_wanted(options, &WAYS[w]))
            TRY(bench_options_some_frames(options, error));
    return RESULT_OK;
}

static Result open_sheet(LightRun *run, Error *error)
{
    const LightCase *first = &run->cases.list[0];
    const Image tile = {.width = first->columns * LIGHT_BLOCK_PX,
                        .height = first->rows * LIGHT_BLOCK_PX,
                        .channels = 3};
    int columns = 1 + (run->options->before != NULL);
    for (int w = 0; w < WAY_COUNT; ++w) columns += is_wanted(run->options, &WAYS[w]);
    if (!run->options->picture)
        return run->options->before
                   ? error_set(error, RESULT_USAGE,
                               "--before: has no effect: expected --picture with it")
                   : RESULT_OK;
    return image_sheet_create(&run->sheet, columns, (int)run->cases.count, &tile, error);
}

static Result run_way(LightRun *run, const LightCase *lit, int w, double coverage, Error *error)
{
    const Way *way = &WAYS[w];
    const char *own = run->options->render ? run->options->render : "";
    char raster[32];
    LightStage stage;
    Row row = row_of(run, lit->name, way);
    snprintf(raster, sizeof raster, "--raster %s", row.raster);
    Result result =
        open_stage(&stage, run->gpu, lit, (const char *[]){way->flags, raster, own}, error);
    THEN(result, (way->orders ? measure_traced : measure)(&stage, lit, way, run->options->frames,
                                                          &row, error));
    if (result == RESULT_OK) {
        row.coverage = coverage;
        row.width = stage.image.width, row.height = stage.image.height;
        row.raster = params_find("raster")->choices[stage.images.renderer.options.raster];
        for (uint32_t i = 0; i < stage.scene.section_count; ++i)
            row.strands += stage.assets.strands[i].strand_count;
        say_bounds(&row, way);
        row.verdict = check_row(&run->table, way, &row);
        table_add(&run->table, &row);
        add_to_sum(&run->sums[w], &row);
        result = add_tile(run, lit, &stage.image, way->name, error);
    }
    light_stage_destroy(&stage);
    return result;
}

static Result run_case(LightRun *run, const LightCase *lit, Error *error)
{
    double coverage = NAN;
    LightTable last = LIGHT_ALL;
    TRY(find_coverage(run, lit, &coverage, error));
    TRY(add_before(run, lit, error));
    for (int w = 0; w < WAY_COUNT; ++w) {
        if (!is_wanted(run->options, &WAYS[w])) continue;
        TRY(run_way(run, lit, w, coverage, error));
        last = WAYS[w].table;
    }
    return add_traced(run, lit, last, error);
}

static Result run_cases(LightRun *run, Error *error)
{
    const BenchOptions *options = run->options;
    TRY(check_ways(options, error));
    TRY(light_cases_read(&run->cases, options->reference ? options->reference : "tests/data/light",
                         options->case_name, error));
    TRY(open_sheet(run, error));
    for (size_t i = 0; i < run->cases.count; ++i) TRY(run_case(run, &run->cases.list[i], error));
    for (int w = 0; w < WAY_COUNT; ++w) add_mean(run, w);
    return options->picture ? png_write(options->picture, &run->sheet.image, error) : RESULT_OK;
}

Result light_run(const BenchOptions *options, const Gpu *gpu, Error *error)
{
    LightRun run = {.options = options, .gpu = gpu};
    Result result = table_open(&run.table, TABLE_COLUMNS, gpu, &options->output, stdout, error);
    THEN(result, run_cases(&run, error));
    image_sheet_destroy(&run.sheet);
    light_cases_destroy(&run.cases);
    return table_close(&run.table, result, error);
}
