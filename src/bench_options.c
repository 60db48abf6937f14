// SPDX-License-Identifier: MIT
#include "bench_options.h"
#include "params.h"
#include "suggest.h"

#include <getopt.h>
#include <stdlib.h>
#include <string.h>

enum {
    OPT_VECTORS = 256,
    OPT_SET,
    OPT_TFX,
    OPT_ALGO,
    OPT_VARIANT,
    OPT_STYLE,
    OPT_STEPS,
    OPT_WARM_UP,
    OPT_SIZE,
    OPT_RASTER,
    OPT_JSON,
    OPT_DEVICE,
    OPT_SOFTWARE,
    OPT_OSMESA,
    OPT_REFERENCE,
    OPT_RATES,
    OPT_OIT,
    OPT_LAYERS,
    OPT_FRAMES,
    OPT_NO_ERROR
};

static const struct {
    struct option option;
    const char *help;
} OPTIONS[] = {
    {{"vectors", required_argument, NULL, OPT_VECTORS}, "FILE.csv  test vectors"},
    {{"set", required_argument, NULL, OPT_SET},
     "NAME  1k16, 1k32, 10k16 or 10k32: the thesis's sets"},
    {{"tfx", required_argument, NULL, OPT_TFX}, "FILE  a hair file of any known kind"},
    {{"algo", required_argument, NULL, OPT_ALGO}, "NAME  solver (default split)"},
    {{"variant", required_argument, NULL, OPT_VARIANT},
     "NAME  form of the solver (default: its own choice)"},
    {{"style", required_argument, NULL, OPT_STYLE},
     "SHARE  of the style in the drawn strand, 0 to 1 (default 0.5)"},
    {{"reference", required_argument, NULL, OPT_REFERENCE},
     "DIR  accuracy: exact motions, NAME.csv with NAME.json (default tests/data/motion)"},
    {{"rates", required_argument, NULL, OPT_RATES},
     "LIST  accuracy: up to 8 numbers of steps a second (default 60,120,240)"},
    {{"steps", required_argument, NULL, OPT_STEPS},
     "N  measured steps, 1 to 1000000 (default 200)"},
    {{"warm-up", required_argument, NULL, OPT_WARM_UP},
     "N  steps before that, 0 to 1000000 (default 20)"},
    {{"size", required_argument, NULL, OPT_SIZE}, "WxH  draw pictures of this size as well (px)"},
    {{"raster", required_argument, NULL, OPT_RASTER},
     "WORD  how hair is drawn: auto, quads or blocks (default auto)"},
    {{"json", required_argument, NULL, OPT_JSON}, "FILE  write the result as JSON"},
    {{"oit", required_argument, NULL, OPT_OIT},
     "WORD  image, quads: abuffer or none (default auto: abuffer)"},
    {{"layers", required_argument, NULL, OPT_LAYERS},
     "K  image, quads: fragments of a pixel in order, 1 to 64 (default 0: 8)"},
    {{"frames", required_argument, NULL, OPT_FRAMES},
     "N  image: measured pictures, 1 to 1000000 (default 15)"},
    {{"no-error", no_argument, NULL, OPT_NO_ERROR}, " image: times only"},
    {{"device", required_argument, NULL, OPT_DEVICE}, "N  EGL device (default: the best one)"},
    {{"software", no_argument, NULL, OPT_SOFTWARE}, " use a CPU driver even where there is a GPU"},
    {{"osmesa", no_argument, NULL, OPT_OSMESA}, " use OSMesa instead of EGL"},
    {{"help", no_argument, NULL, 'h'}, " print this and stop"},
    {{"version", no_argument, NULL, 'V'}, " print the version and stop"},
};
enum { OPTION_COUNT = sizeof OPTIONS / sizeof *OPTIONS };

static Result read_int(const char *name, const char *text, long least, long most, int *value,
                       Error *error)
{
    char *end;
    long number = strtol(text, &end, 10);
    if (end == text || *end || number < least || number > most)
        return error_set(error, RESULT_USAGE, "--%s: expected %ld to %ld, got '%s'", name, least,
                         most, text);
    *value = (int)number;
    return RESULT_OK;
}

static Result read_share(const char *name, const char *text, double *value, Error *error)
{
    char *end;
    *value = strtod(text, &end);
    if (end != text && !*end && *value >= 0 && *value <= 1) return RESULT_OK;
    return error_set(error, RESULT_USAGE, "--%s: expected 0 to 1, got '%s'", name, text);
}

static Result read_rates(const char *text, AccuracyOptions *options, Error *error)
{
    const char *at = text;
    char *end = (char *)text;
    for (options->rate_count = 0; options->rate_count < ACCURACY_MOST_RATES; at = end + 1) {
        double rate = strtod(at, &end);
        if (end == at || !(rate >= 1 && rate <= 1e6)) break;
        options->rates[options->rate_count++] = rate;
        if (!*end) return RESULT_OK;
        if (*end != ',') break;
    }
    return error_set(
        error, RESULT_USAGE,
        "--rates: expected up to %d numbers from 1 to 1000000 with commas between them, "
        "got '%s'",
        ACCURACY_MOST_RATES, text);
}

static Result read_raster(const char *text, Raster *raster, Error *error)
{
    RunParams run = {0};
    Result result = param_parse(param_find("raster"), &run, text, error);
    *raster = (Raster)run.raster;
    return result;
}

static Result read_oit(const char *text, Oit *oit, Error *error)
{
    RunParams run = {0};
    Result result = param_parse(param_find("oit"), &run, text, error);
    *oit = (Oit)run.oit;
    return result;
}

static Result read_size(const char *text, int size[2], Error *error)
{
    int end = 0;
    if (sscanf(text, "%5dx%5d%n", &size[0], &size[1], &end) == 2 && !text[end] && size[0] > 0 &&
        size[1] > 0 && size[0] <= 16384 && size[1] <= 16384)
        return RESULT_OK;
    return error_set(error, RESULT_USAGE, "--size: expected WxH, each 1 to 16384, got '%s'", text);
}

static Result take_option(BenchOptions *options, int option, const char *text, Error *error)
{
    SpeedOptions *speed = &options->speed;
    switch (option) {
    case OPT_VECTORS:
        options->vectors = text;
        return RESULT_OK;
    case OPT_SET:
        speed->set = text;
        return RESULT_OK;
    case OPT_TFX:
        speed->file = text;
        return RESULT_OK;
    case OPT_ALGO:
        speed->algo = options->accuracy.algo = text;
        return RESULT_OK;
    case OPT_VARIANT:
        speed->variant = options->accuracy.variant = text;
        return RESULT_OK;
    case OPT_REFERENCE:
        options->accuracy.reference = text;
        return RESULT_OK;
    case OPT_RATES:
        return read_rates(text, &options->accuracy, error);
    case OPT_JSON:
        options->json = text;
        return RESULT_OK;
    case OPT_SOFTWARE:
        options->gpu.software = true;
        return RESULT_OK;
    case OPT_OSMESA:
        options->gpu.backend = GPU_BACKEND_OSMESA;
        return RESULT_OK;
    case OPT_NO_ERROR:
        options->image.no_error = true;
        return RESULT_OK;
    case OPT_OIT:
        return read_oit(text, &options->image.scheme.oit, error);
    case OPT_LAYERS:
        return read_int("layers", text, 0, 64, &options->image.scheme.layers, error);
    case OPT_FRAMES:
        return read_int("frames", text, 1, 1000000, &options->image.frames, error);
    case OPT_STEPS:
        return read_int("steps", text, 1, 1000000, &speed->steps, error);
    case OPT_WARM_UP:
        return read_int("warm-up", text, 0, 1000000, &speed->warm_up, error);
    case OPT_DEVICE:
        return read_int("device", text, 0, 1000, &options->gpu.device, error);
    case OPT_SIZE:
        return read_size(text, speed->size, error);
    case OPT_RASTER:
        return read_raster(text, &speed->raster, error);
    case OPT_STYLE:
        return read_share("style", text, &speed->style, error);
    default:
        return error_set(error, RESULT_USAGE, "option %d", option);
    }
}

static Result refuse_option(char **argv, Error *error)
{
    const char *names[OPTION_COUNT], *word = argv[optind - 1];
    for (size_t i = 0; i < OPTION_COUNT; ++i) names[i] = OPTIONS[i].option.name;
    return error_set(error, RESULT_USAGE,
                     "%s: no such option, or its value is missing; did you mean --%s?", word,
                     suggest_nearest(word + strspn(word, "-"), names, OPTION_COUNT));
}

Result bench_options_read(BenchOptions *options, int argc, char **argv, Error *error)
{
    struct option known[OPTION_COUNT + 1] = {{0}};
    for (size_t i = 0; i < OPTION_COUNT; ++i) known[i] = OPTIONS[i].option;
    *options = (BenchOptions){.speed = speed_options_default(),
                              .image = image_options_default(),
                              .accuracy = accuracy_options_default(),
                              .gpu = {.device = -1}};
    opterr = 0;
    for (int option; (option = getopt_long(argc, argv, "hV", known, NULL)) != -1;) {
        options->help = option == 'h', options->version = option == 'V';
        if (options->help || options->version) return RESULT_OK;
        Result result = option == '?' ? refuse_option(argv, error)
                                      : take_option(options, option, optarg, error);
        if (result != RESULT_OK) return result;
    }
    options->files = argv + optind;
    options->file_count = argc - optind;
    return RESULT_OK;
}

void bench_options_list(FILE *out)
{
    for (size_t i = 0; i < OPTION_COUNT; ++i)
        fprintf(out, "  --%s %s\n", OPTIONS[i].option.name, OPTIONS[i].help);
}
