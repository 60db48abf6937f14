// SPDX-License-Identifier: MIT
// tractrix-bench: accuracy of the tractrix on test vectors, speed of solvers and drawing, check of
// all shaders.
#include "bench_accuracy.h"
#include "bench_image.h"
#include "bench_scenes.h"
#include "bench_shaders.h"
#include "bench_speed.h"
#include "interrupt.h"
#include "json_write.h"
#include "solver.h"
#include "suggest.h"
#include "vectors.h"

#include "version.h"

#include <getopt.h>
#include <stdlib.h>
#include <string.h>

typedef struct Arguments {
    SpeedOptions speed;
    AccuracyOptions accuracy;
    ImageOptions image; // but for what speed has
    GpuOptions gpu;
    const char *vectors, *json;
    char **files; // what is no option
    int file_count;
} Arguments;

typedef Result (*Command)(const Arguments *arguments, const Gpu *gpu, Error *error);

static Result check_vectors(const Arguments *arguments, const Gpu *gpu, bool chains, Error *error)
{
    if (!arguments->vectors) return error_set(error, RESULT_USAGE, "--vectors FILE.csv is needed");
    VectorsReport report = {0};
    Result result = (chains ? vectors_check_chains
                            : vectors_check_steps)(&report, gpu, arguments->vectors, error);
    if (result != RESULT_OK) return result;
    double mark = chains ? VECTORS_CHAIN_MARK : VECTORS_STEP_MARK;
    const char *unit = chains ? "sens32" : "floor32";
    vectors_print(&report, unit, mark, stdout);
    if (report.failed == 0) return RESULT_OK;
    return error_set(error, RESULT_FAILED, "%zu of %zu rows are above %g %s", report.failed,
                     report.rows, mark, unit);
}

static Result run_step(const Arguments *arguments, const Gpu *gpu, Error *error)
{
    return check_vectors(arguments, gpu, false, error);
}

static Result run_chain(const Arguments *arguments, const Gpu *gpu, Error *error)
{
    return check_vectors(arguments, gpu, true, error);
}

static Result run_speed(const Arguments *arguments, const Gpu *gpu, Error *error)
{
    const SpeedOptions *options = &arguments->speed;
    if (!options->set == !options->file)
        return error_set(error, RESULT_USAGE, "speed: one of --set NAME and --tfx FILE is needed");
    SpeedResult row;
    Result result = speed_measure(&row, gpu, options, error);
    if (result != RESULT_OK) return result;
    speed_print_head(stdout);
    speed_print(&row, options, stdout);
    if (!arguments->json) return RESULT_OK;
    json_t *value = speed_to_json(&row, options, gpu);
    result = json_write_file(value, arguments->json, error);
    json_decref(value);
    return result;
}

// A row of the table. Drawing does not depend on the solver, so only the first one of a set draws.
static Result add_row(const Arguments *arguments, const Gpu *gpu, const char *set, const char *file,
                      const SolverType *type, json_t *rows, Error *error)
{
    SpeedOptions options = arguments->speed;
    SpeedResult row;
    options.set = set, options.file = file, options.algo = type->name;
    if (type != SOLVER_TYPES[0]) options.size[0] = options.size[1] = 0;
    if (interrupt_requested()) return error_set(error, RESULT_INTERRUPTED, "interrupted");
    Result result = speed_measure(&row, gpu, &options, error);
    if (result != RESULT_OK) return result;
    speed_print(&row, &options, stdout);
    fflush(stdout);
    json_array_append_new(rows, speed_to_json(&row, &options, gpu));
    return RESULT_OK;
}

// The thesis's sets and the files that are named, with every solver that steps.
static Result run_all(const Arguments *arguments, const Gpu *gpu, Error *error)
{
    static const char *const sets[] = {"1k16", "1k32", "10k16", "10k32"};
    int set_count = (int)(sizeof sets / sizeof *sets);
    json_t *rows = json_array();
    Result result = RESULT_OK;
    speed_print_head(stdout);
    for (int i = 0; i < set_count + arguments->file_count; ++i)
        for (const SolverType *const *type = SOLVER_TYPES; *type && result == RESULT_OK; ++type)
            if ((*type)->calls->step)
                result = add_row(arguments, gpu, i < set_count ? sets[i] : NULL,
                                 i < set_count ? NULL : arguments->files[i - set_count], *type,
                                 rows, error);
    if (result == RESULT_OK && arguments->json)
        result = json_write_file(rows, arguments->json, error);
    json_decref(rows);
    return result;
}

static Result run_scenes(const Arguments *arguments, const Gpu *gpu, Error *error)
{
    json_t *rows = json_array();
    Result result = scenes_measure(gpu, &arguments->speed, stdout, rows, error);
    if (result == RESULT_OK && arguments->json)
        result = json_write_file(rows, arguments->json, error);
    json_decref(rows);
    return result;
}

static Result run_accuracy(const Arguments *arguments, const Gpu *gpu, Error *error)
{
    Error unwritten;
    json_t *rows = arguments->json ? json_array() : NULL;
    Result result = accuracy_run(gpu, &arguments->accuracy, stdout, rows, error);
    if (rows && (result == RESULT_OK || result == RESULT_FAILED) &&
        json_write_file(rows, arguments->json, &unwritten) != RESULT_OK)
        result = error_set(error, RESULT_FAILED, "%s", unwritten.text);
    json_decref(rows);
    return result;
}

static Result add_image(ImageBench *bench, const ImageOptions *options, json_t *rows, Error *error)
{
    ImageResult row;
    Result result = image_bench_measure(bench, options, &row, error);
    if (result != RESULT_OK) return result;
    image_print(bench, options, &row, stdout);
    fflush(stdout);
    json_array_append_new(rows, image_to_json(bench, options, &row));
    return RESULT_OK;
}

static Result run_image(const Arguments *arguments, const Gpu *gpu, Error *error)
{
    const SpeedOptions *speed = &arguments->speed;
    ImageOptions options = arguments->image;
    options.set = speed->set, options.file = speed->file;
    options.scheme.raster = speed->raster;
    if (speed->size[0]) memcpy(options.size, speed->size, sizeof options.size);
    if (!options.set == !options.file)
        return error_set(error, RESULT_USAGE, "image: one of --set NAME and --tfx FILE is needed");
    Result result;
    ImageBench *bench = image_bench_create(gpu, &options, &result, error);
    if (!bench) return result;
    json_t *rows = json_array();
    image_print_head(stdout);
    result = add_image(bench, &options, rows, error);
    if (result == RESULT_OK && arguments->json)
        result = json_write_file(rows, arguments->json, error);
    json_decref(rows);
    image_bench_destroy(bench);
    return result;
}

// All schemes for one set.
static Result add_images(const ImageOptions *options, const Gpu *gpu, json_t *rows, Error *error)
{
    Result result;
    ImageOptions mine = *options;
    ImageBench *bench = image_bench_create(gpu, &mine, &result, error);
    for (size_t i = 0; i < IMAGE_SCHEME_COUNT && result == RESULT_OK; ++i) {
        mine.scheme = IMAGE_SCHEMES[i];
        result = interrupt_requested() ? error_set(error, RESULT_INTERRUPTED, "interrupted")
                                       : add_image(bench, &mine, rows, error);
    }
    image_bench_destroy(bench);
    return result;
}

static Result run_images(const Arguments *arguments, const Gpu *gpu, Error *error)
{
    ImageOptions options = arguments->image;
    if (arguments->speed.size[0]) memcpy(options.size, arguments->speed.size, sizeof options.size);
    json_t *rows = json_array();
    Result result = RESULT_OK;
    image_print_head(stdout);
    for (int i = 0; IMAGE_SETS[i] && result == RESULT_OK; ++i) {
        options.set = IMAGE_SETS[i];
        result = add_images(&options, gpu, rows, error);
    }
    options.set = NULL;
    for (int i = 0; i < arguments->file_count && result == RESULT_OK; ++i) {
        options.file = arguments->files[i];
        result = add_images(&options, gpu, rows, error);
    }
    if (result == RESULT_OK && arguments->json)
        result = json_write_file(rows, arguments->json, error);
    json_decref(rows);
    return result;
}

static Result run_shaders(const Arguments *arguments, const Gpu *gpu, Error *error)
{
    (void)arguments;
    return bench_shaders(gpu, stdout, error);
}

static const struct {
    const char *name;
    Command run;
    const char *help;
} COMMANDS[] = {
    {"step", run_step, "tractrix steps of --vectors FILE.csv against their exact results"},
    {"chain", run_chain,
     "chain pulls of --vectors FILE.csv (FILE_cases.csv beside it) against theirs"},
    {"speed", run_speed, "a solver's step on --set NAME or --tfx FILE, and drawing with --size"},
    {"scenes", run_scenes,
     "frames with followers, asleep, and of two sections: --set NAME (default 10k16), --algo"},
    {"accuracy", run_accuracy,
     "solvers' errors against exact motions, by the time step; status 1 if a bound is broken"},
    {"all", run_all, "a table: all sets, and the hair files named, with every solver"},
    {"image", run_image,
     "drawing --set NAME or --tfx FILE: its time, and its error against the exact picture"},
    {"images", run_images, "the same for every scheme, sets of hair and the files named"},
    {"shaders", run_shaders, "compiles every shader variant with warnings as errors"},
};
enum { COMMAND_COUNT = sizeof COMMANDS / sizeof *COMMANDS };

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

static void print_help(void)
{
    printf("usage: tractrix-bench COMMAND [OPTION...] [HAIR_FILE...]\n\nCommands:\n");
    for (size_t i = 0; i < COMMAND_COUNT; ++i)
        printf("  %-8s %s\n", COMMANDS[i].name, COMMANDS[i].help);
    printf("\nOptions:\n");
    for (size_t i = 0; i < OPTION_COUNT; ++i)
        printf("  --%s %s\n", OPTIONS[i].option.name, OPTIONS[i].help);
    printf("\nTimes are wall-clock milliseconds, median and minimum, after a warm-up.\n"
           "Exit status: 0 done, 1 failure or a row above its pass mark, 2 usage, 3 bad input "
           "file, 4 no usable GL.\n");
}

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

static Result take_option(Arguments *arguments, int option, const char *text, Error *error)
{
    SpeedOptions *speed = &arguments->speed;
    switch (option) {
    case OPT_VECTORS:
        arguments->vectors = text;
        return RESULT_OK;
    case OPT_SET:
        speed->set = text;
        return RESULT_OK;
    case OPT_TFX:
        speed->file = text;
        return RESULT_OK;
    case OPT_ALGO:
        speed->algo = arguments->accuracy.algo = text;
        return RESULT_OK;
    case OPT_VARIANT:
        speed->variant = arguments->accuracy.variant = text;
        return RESULT_OK;
    case OPT_REFERENCE:
        arguments->accuracy.reference = text;
        return RESULT_OK;
    case OPT_RATES:
        return read_rates(text, &arguments->accuracy, error);
    case OPT_JSON:
        arguments->json = text;
        return RESULT_OK;
    case OPT_SOFTWARE:
        arguments->gpu.software = true;
        return RESULT_OK;
    case OPT_OSMESA:
        arguments->gpu.backend = GPU_BACKEND_OSMESA;
        return RESULT_OK;
    case OPT_NO_ERROR:
        arguments->image.no_error = true;
        return RESULT_OK;
    case OPT_OIT:
        return read_oit(text, &arguments->image.scheme.oit, error);
    case OPT_LAYERS:
        return read_int("layers", text, 0, 64, &arguments->image.scheme.layers, error);
    case OPT_FRAMES:
        return read_int("frames", text, 1, 1000000, &arguments->image.frames, error);
    case OPT_STEPS:
        return read_int("steps", text, 1, 1000000, &speed->steps, error);
    case OPT_WARM_UP:
        return read_int("warm-up", text, 0, 1000000, &speed->warm_up, error);
    case OPT_DEVICE:
        return read_int("device", text, 0, 1000, &arguments->gpu.device, error);
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

static Result read_arguments(Arguments *arguments, int argc, char **argv, bool *stop, Error *error)
{
    struct option options[OPTION_COUNT + 1] = {{0}};
    for (size_t i = 0; i < OPTION_COUNT; ++i) options[i] = OPTIONS[i].option;
    *arguments = (Arguments){.speed = speed_options_default(),
                             .image = image_options_default(),
                             .accuracy = accuracy_options_default(),
                             .gpu = {.device = -1}};
    opterr = 0;
    for (int option; (option = getopt_long(argc, argv, "hV", options, NULL)) != -1;) {
        if (option == 'h' || option == 'V') {
            if (option == 'h')
                print_help();
            else
                printf("tractrix-bench %s (%s)\n", TRACTRIX_VERSION, TRACTRIX_COMMIT);
            *stop = true;
            return RESULT_OK;
        }
        Result result = option == '?' ? refuse_option(argv, error)
                                      : take_option(arguments, option, optarg, error);
        if (result != RESULT_OK) return result;
    }
    arguments->files = argv + optind;
    arguments->file_count = argc - optind;
    return RESULT_OK;
}

static Result find_command(const char *word, size_t *command, Error *error)
{
    const char *names[COMMAND_COUNT];
    for (size_t i = 0; i < COMMAND_COUNT; ++i) {
        names[i] = COMMANDS[i].name;
        *command = i;
        if (strcmp(names[i], word) == 0) return RESULT_OK;
    }
    return error_set(error, RESULT_USAGE, "no command '%s'; did you mean '%s'?", word,
                     suggest_nearest(word, names, COMMAND_COUNT));
}

static Result run(int argc, char **argv, Error *error)
{
    Arguments arguments;
    size_t command = 0;
    Gpu gpu;
    bool stop = false;
    Result result = read_arguments(&arguments, argc, argv, &stop, error);
    if (result != RESULT_OK || stop) return result;
    if (arguments.file_count == 0) return error_set(error, RESULT_USAGE, "no command; see --help");
    result = find_command(*arguments.files++, &command, error);
    --arguments.file_count;
    if (result != RESULT_OK) return result;
    result = gpu_create(&gpu, &arguments.gpu, error);
    if (result != RESULT_OK) return result;
    fprintf(stderr, "%s, OpenGL %s (%s)\n", gpu.renderer, gpu.version, gpu.path);
    result = COMMANDS[command].run(&arguments, &gpu, error);
    gpu_destroy(&gpu);
    return result;
}

int main(int argc, char **argv)
{
    Error error = {{0}};
    interrupt_install();
    Result result = run(argc, argv, &error);
    if (result == RESULT_OK && (fflush(stdout) != 0 || ferror(stdout)))
        result = error_set(&error, RESULT_FAILED, "cannot write to standard output");
    if (result != RESULT_OK)
        fprintf(stderr, "%s%s\n", result == RESULT_BAD_INPUT ? "" : "tractrix-bench: ", error.text);
    return result;
}
