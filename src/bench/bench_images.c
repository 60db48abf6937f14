// SPDX-License-Identifier: MIT
#include "bench/bench_images.h"
#include "base/interrupt.h"
#include "bench/bench_image.h"

#include <math.h>
#include <string.h>

static const ImageScheme SCHEMES[] = {
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

// --- Rows.

// What a row is in the files.
typedef struct Line {
    char set[64], scheme[64], command[512];
    long strands, particles, width, height, layers, samples, segments, fragments;
    const char *raster, *oit, *shadow, *quality;
    ImageResult result;
} Line;

#define AT(member) offsetof(Line, member)
static const Column COLUMNS[] = {
    {"set", COLUMN_CHARS, AT(set), 19},
    {"scheme", COLUMN_CHARS, AT(scheme), 23},
    {"ms_min", COLUMN_REAL, AT(result.wall.minimum), 7},
    {"ms_median", COLUMN_REAL, AT(result.wall.median), 9},
    {"cpu_ms_min", COLUMN_REAL, AT(result.processor.minimum), 10},
    {"cpu_ms_median", COLUMN_REAL, AT(result.processor.median), 13},
    {"rms", COLUMN_REAL, AT(result.distance.rms), 6},
    {"covered", COLUMN_REAL, AT(result.distance.covered), 7},
    {"passes", COLUMN_CHARS, AT(result.spans), 1},
    {"strands", COLUMN_WHOLE, AT(strands), 0},
    {"particles", COLUMN_WHOLE, AT(particles), 0},
    {"width", COLUMN_WHOLE, AT(width), 0},
    {"height", COLUMN_WHOLE, AT(height), 0},
    {"raster", COLUMN_TEXT, AT(raster), 0},
    {"oit", COLUMN_TEXT, AT(oit), 0},
    {"layers", COLUMN_WHOLE, AT(layers), 0},
    {"samples", COLUMN_WHOLE, AT(samples), 0},
    {"shadow", COLUMN_TEXT, AT(shadow), 0},
    {"quality", COLUMN_TEXT, AT(quality), 0},
    {"segments", COLUMN_WHOLE, AT(segments), 0},
    {"fragments", COLUMN_WHOLE, AT(fragments), 0},
    {"reference_s", COLUMN_REAL, AT(result.reference_s), 0},
    {"command", COLUMN_CHARS, AT(command), 0},
};
enum { COLUMN_COUNT = sizeof COLUMNS / sizeof *COLUMNS };

static const char *word_of(const char *param, int value)
{
    return params_find(param)->choices[value];
}

// "quads, k = 8, 2 x 2, dom"; a preset by its word.
static void name_scheme(const ImageScheme *scheme, char *name, size_t size)
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

// The row's own command: the scheme's words that are not the defaults.
static void write_command(const ImageBench *bench, const ImageOptions *options, Line *line)
{
    const ImageScheme *scheme = &options->scheme;
    char layers[24] = "", samples[24] = "";
    if (scheme->layers) snprintf(layers, sizeof layers, " --layers %d", scheme->layers);
    if (scheme->samples) snprintf(samples, sizeof samples, " --samples %d", scheme->samples);
    snprintf(line->command, sizeof line->command,
             "tractrix-bench image --%s %s --raster %s --oit %s%s%s --shadow %s --quality %s "
             "--size %ldx%ld --frames %d",
             bench->hair.set ? "set" : "tfx", bench->hair.set ? bench->hair.set : bench->hair.file,
             word_of("raster", (int)scheme->raster), line->oit, layers, samples, line->shadow,
             line->quality, line->width, line->height, options->frames);
}

static void add_row(Table *table, const ImageBench *bench, const ImageOptions *options,
                    const ImageResult *result)
{
    const ImageScheme *scheme = &options->scheme;
    const int *size = bench->hair.scene.run.size;
    Line line = {.strands = bench->hair.strands.strand_count,
                 .particles = bench->hair.strands.vertex_count,
                 .width = size[0],
                 .height = size[1],
                 .layers = scheme->layers,
                 .samples = scheme->samples,
                 .segments = (long)result->counts.segments,
                 .fragments = (long)result->counts.fragments,
                 .raster = word_of("raster", (int)result->raster),
                 .oit = word_of("oit", (int)scheme->oit),
                 .shadow = word_of("shadow", (int)scheme->shadow),
                 .quality = word_of("quality", (int)scheme->quality),
                 .result = *result};
    snprintf(line.set, sizeof line.set, "%s", bench->hair.name);
    name_scheme(scheme, line.scheme, sizeof line.scheme);
    write_command(bench, options, &line);
    table_add(table, &line);
}

// --- The commands.

// The schemes in turn, for one set or file.
static Result add_images(Table *table, const ImageOptions *options, const ImageScheme *schemes,
                         size_t count, Error *error)
{
    ImageBench bench;
    ImageOptions mine = *options;
    Result result = image_bench_create(&bench, table->gpu, &mine, error);
    for (size_t i = 0; i < count && result == RESULT_OK; ++i) {
        ImageResult row;
        mine.scheme = schemes[i];
        result = interrupt_requested() ? error_set(error, RESULT_INTERRUPTED, "interrupted")
                                       : image_bench_measure(&bench, &mine, &row, error);
        if (result == RESULT_OK) add_row(table, &bench, &mine, &row);
    }
    image_bench_destroy(&bench);
    return result;
}

static ImageOptions read_options(const BenchOptions *arguments)
{
    ImageOptions options = arguments->image;
    if (arguments->size[0]) memcpy(options.size, arguments->size, sizeof options.size);
    return options;
}

Result images_run_one(const BenchOptions *arguments, const Gpu *gpu, Error *error)
{
    Table table;
    ImageOptions options = read_options(arguments);
    options.set = arguments->set, options.file = arguments->tfx;
    options.scheme.raster = arguments->raster;
    if (!options.set == !options.file)
        return error_set(error, RESULT_USAGE, "image: one of --set NAME and --tfx FILE is needed");
    Result result =
        table_open(&table, COLUMNS, COLUMN_COUNT, gpu, &arguments->output, stdout, error);
    if (result == RESULT_OK) result = add_images(&table, &options, &options.scheme, 1, error);
    return table_close(&table, result, error);
}

Result images_run(const BenchOptions *arguments, const Gpu *gpu, Error *error)
{
    Table table;
    ImageOptions options = read_options(arguments);
    Result result = bench_options_check_parts(arguments, SETS, error);
    if (result != RESULT_OK) return result;
    result = table_open(&table, COLUMNS, COLUMN_COUNT, gpu, &arguments->output, stdout, error);
    for (int i = 0; SETS[i] && result == RESULT_OK; ++i) {
        options.set = SETS[i];
        if (strcmp(options.set, "files") != 0 && bench_options_part(arguments, options.set))
            result = add_images(&table, &options, SCHEMES, SCHEME_COUNT, error);
    }
    options.set = NULL;
    bool files = bench_options_part(arguments, "files");
    for (int i = 0; i < arguments->file_count && files && result == RESULT_OK; ++i) {
        options.file = arguments->files[i];
        result = add_images(&table, &options, SCHEMES, SCHEME_COUNT, error);
    }
    return table_close(&table, result, error);
}
