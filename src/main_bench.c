// SPDX-License-Identifier: MIT
// tractrix-bench: accuracy of the tractrix on test vectors, speed of solvers and drawing, check of
// all shaders.
#include "bench_accuracy.h"
#include "bench_image.h"
#include "bench_options.h"
#include "bench_scenes.h"
#include "bench_shaders.h"
#include "bench_speed.h"
#include "interrupt.h"
#include "json_write.h"
#include "solver.h"
#include "suggest.h"
#include "vectors.h"

#include "version.h"

#include <string.h>

typedef Result (*Command)(const BenchOptions *arguments, const Gpu *gpu, Error *error);

static Result check_vectors(const BenchOptions *arguments, const Gpu *gpu, bool chains,
                            Error *error)
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

static Result run_step(const BenchOptions *arguments, const Gpu *gpu, Error *error)
{
    return check_vectors(arguments, gpu, false, error);
}

static Result run_chain(const BenchOptions *arguments, const Gpu *gpu, Error *error)
{
    return check_vectors(arguments, gpu, true, error);
}

static Result run_speed(const BenchOptions *arguments, const Gpu *gpu, Error *error)
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
static Result add_row(const BenchOptions *arguments, const Gpu *gpu, const char *set,
                      const char *file, const SolverType *type, json_t *rows, Error *error)
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
static Result run_all(const BenchOptions *arguments, const Gpu *gpu, Error *error)
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

static Result run_scenes(const BenchOptions *arguments, const Gpu *gpu, Error *error)
{
    json_t *rows = json_array();
    Result result = scenes_measure(gpu, &arguments->speed, stdout, rows, error);
    if (result == RESULT_OK && arguments->json)
        result = json_write_file(rows, arguments->json, error);
    json_decref(rows);
    return result;
}

static Result run_accuracy(const BenchOptions *arguments, const Gpu *gpu, Error *error)
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

static Result run_image(const BenchOptions *arguments, const Gpu *gpu, Error *error)
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

static Result run_images(const BenchOptions *arguments, const Gpu *gpu, Error *error)
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

static Result run_shaders(const BenchOptions *arguments, const Gpu *gpu, Error *error)
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

static void print_help(void)
{
    printf("usage: tractrix-bench COMMAND [OPTION...] [HAIR_FILE...]\n\nCommands:\n");
    for (size_t i = 0; i < COMMAND_COUNT; ++i)
        printf("  %-8s %s\n", COMMANDS[i].name, COMMANDS[i].help);
    printf("\nOptions:\n");
    bench_options_list(stdout);
    printf("\nTimes are wall-clock milliseconds, median and minimum, after a warm-up.\n"
           "Exit status: 0 done, 1 failure or a row above its pass mark, 2 usage, 3 bad input "
           "file, 4 no usable GL.\n");
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
    BenchOptions arguments;
    size_t command = 0;
    Gpu gpu;
    Result result = bench_options_read(&arguments, argc, argv, error);
    if (result != RESULT_OK) return result;
    if (arguments.help) print_help();
    if (arguments.version) printf("tractrix-bench %s\n", TRACTRIX_VERSION);
    if (arguments.help || arguments.version) return RESULT_OK;
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
