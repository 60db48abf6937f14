// SPDX-License-Identifier: MIT
// tractrix-render: simulates the hair of files or scenes and draws it.
#include "base/clock.h"
#include "base/program.h"
#include "run/render_help.h"
#include "run/run.h"

#include "version.h"

#include <string.h>

// Runs --check: first the options, then the hair files.
static Result check(const Scene *scene, Error *error)
{
    TRY(run_check(scene, error));
    error->text[0] = 0; // the report on stdout names all errors
    return assets_check(scene, stdout);
}

static Result answer(Run *run, Error *error)
{
    const RunParams *params = &run->scene.run;
    if (run->scene.request == REQUEST_HELP) return render_help(run->scene.topic, stdout, error);
    if (run->scene.request == REQUEST_VERSION) {
        printf("tractrix-render %s\n", TRACTRIX_VERSION);
        return RESULT_OK;
    }
    if (params->list_devices) return gpu_list_devices(stdout, error);
    if (params->platform) return run_print_platform(params, stdout, error);
    if (params->check) return check(&run->scene, error);
    return run_go(run, error);
}

// `--algo list` needs no hair file, so it is handled before the command line is parsed.
static bool wants_solver_list(int argc, char **argv)
{
    for (int i = 1; i < argc; ++i)
        if (strcmp(argv[i], "--algo=list") == 0 ||
            (strcmp(argv[i], "--algo") == 0 && i + 1 < argc && strcmp(argv[i + 1], "list") == 0))
            return true;
    return false;
}

int main(int argc, char **argv)
{
    Error error = {{0}};
    program_begin(argc, argv);
    if (wants_solver_list(argc, argv)) {
        solver_print_list(stdout);
        return program_end("tractrix-render", RESULT_OK, &error);
    }
    Run run = {.begin_ms = clock_ms()};
    Result result = assumptions_take_option(&argc, argv, &error);
    THEN(result, scene_from_arguments(&run.scene, argc, argv, &error));
    THEN(result, answer(&run, &error));
    run_destroy(&run);
    return program_end("tractrix-render", result, &error);
}
