// SPDX-License-Identifier: MIT
// tractrix-bench: accuracy of the tractrix and of solvers, speed of solvers and drawing, check of
// all shaders.
#include "base/interrupt.h"
#include "base/program.h"
#include "base/suggest.h"
#include "bench/accuracy.h"
#include "bench/images.h"
#include "bench/scenes.h"
#include "bench/shaders.h"
#include "bench/speed.h"
#include "bench/stress.h"
#include "bench/test_vectors.h"

#include <stdlib.h>
#include <string.h>

static Result run_stress(const BenchOptions *arguments, const Gpu *gpu, Error *error)
{
    const char *variant = arguments->method.variant;
    StressOptions options = arguments->stress;
    options.algo = arguments->method.algo, options.variant = *variant ? variant : NULL;
    if (*arguments->method.settings)
        return error_set(error, RESULT_USAGE, "stress: draws %s itself, or takes it from --case",
                         arguments->method.settings);
    return stress_search(gpu, &options, &arguments->output, stdout, error);
}

static Result run_shaders(const BenchOptions *arguments, const Gpu *gpu, Error *error)
{
    (void)arguments;
    return shaders_check(gpu, stdout, error);
}

static const struct {
    const char *name;
    Result (*run)(const BenchOptions *options, const Gpu *gpu, Error *error);
    const char *help;
} COMMANDS[] = {
    {"step", test_vectors_run_steps,
     "tractrix steps of --vectors against their exact results, by our rule and by the thesis's"},
    {"chain", test_vectors_run_chains,
     "chain pulls of --vectors FILE.csv (FILE_cases.csv beside it) against theirs"},
    {"accuracy", accuracy_run,
     "solvers against what is known exactly. Parts: motions, work (time beside error), pendulum, "
     "static, drift, beam, stretch, energy, rate, scale"},
    {"speed", speed_run,
     "solvers' steps. Parts: memory, sets (--set, --tfx or all of the thesis's; files named; "
     "drawing with --size), c (split in plain C), strands, vertices, threads, start"},
    {"scenes", scenes_run,
     "frames with followers, asleep, and of two sections: --set NAME (default 10k16), --algo"},
    {"stress", run_stress,
     "random circumstances for every solver; the smallest case that breaks a rule, if one does"},
    {"image", images_run_one,
     "drawing --set NAME or --tfx FILE: its time, and its error against the exact picture"},
    {"images", images_run,
     "the same for every scheme and preset; parts: straight, curls, fur, files (those named)"},
    {"shaders", run_shaders, "compiles every shader variant with warnings as errors"},
};
enum { COMMAND_COUNT = sizeof COMMANDS / sizeof *COMMANDS };

static Result find_command(const char *word, size_t *command, Error *error)
{
    const char *names[COMMAND_COUNT];
    for (size_t i = 0; i < COMMAND_COUNT; ++i) {
        names[i] = COMMANDS[i].name;
        *command = i;
        if (strcmp(names[i], word) == 0) return RESULT_OK;
    }
    char words[200];
    return error_set(error, RESULT_USAGE, "no command '%s': %s", word,
                     suggest_words(words, sizeof words, word, names, COMMAND_COUNT));
}

static Result run_command(BenchOptions *options, Error *error)
{
    size_t command = 0;
    Gpu gpu;
    if (options->file_count == 0) return error_set(error, RESULT_USAGE, "no command; see --help");
    TRY(find_command(*options->files++, &command, error));
    --options->file_count;
    // What Mesa finds in its cache it does not compile, and warns of nothing.
    if (COMMANDS[command].run == run_shaders) setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
    TRY(gpu_create(&gpu, &options->gpu, error));
    fprintf(stderr, "%s, OpenGL %s (%s)\n", gpu.renderer, gpu.version, gpu.path);
    Result result = COMMANDS[command].run(options, &gpu, error);
    gpu_destroy(&gpu);
    return result;
}

static Result run(int argc, char **argv, Error *error)
{
    BenchOptions options;
    const char *help[COMMAND_COUNT + 1][2] = {{NULL}};
    for (size_t i = 0; i < COMMAND_COUNT; ++i)
        help[i][0] = COMMANDS[i].name, help[i][1] = COMMANDS[i].help;
    Result result = bench_options_read(&options, argc, argv, (const char *const(*)[2])help, error);
    if (!options.done) THEN(result, run_command(&options, error));
    bench_options_destroy(&options);
    return result;
}

int main(int argc, char **argv)
{
    Error error = {{0}};
    interrupt_install();
    Result result = run(argc, argv, &error);
    return program_end("tractrix-bench", result, &error);
}
