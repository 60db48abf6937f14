// SPDX-License-Identifier: MIT
#include "bench/child.h"
#include "base/clock.h"
#include "base/outfile.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum { MOST_WORDS = 64 };

double child_number(const json_t *row, const char *name)
{
    const json_t *value = json_object_get(row, name);
    return json_is_number(value) ? json_number_value(value) : NAN;
}

// Runs this program with the given arguments and environment variable; discards its output.
static Result execute(char **words, const ChildRun *run, double *wall_ms, Error *error)
{
    int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC), status = 0;
    const char *before = getenv(run->variable);
    char *kept = before ? strdup(before) : NULL;
    double begin = clock_ms();
    setenv(run->variable, run->value, 1);
    pid_t child = fork();
    if (child == 0) { // only async-signal-safe calls between fork and exec
        dup2(nowhere, STDOUT_FILENO);
        dup2(nowhere, STDERR_FILENO);
        execv("/proc/self/exe", words);
        _exit(127);
    }
    while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
    *wall_ms = clock_ms() - begin;
    if (nowhere >= 0) close(nowhere);
    if (kept)
        setenv(run->variable, kept, 1);
    else
        unsetenv(run->variable);
    free(kept);
    // Exit status 1 means that a bound is broken. This process reports that itself.
    if (child > 0 && WIFEXITED(status) && WEXITSTATUS(status) <= 1) return RESULT_OK;
    return error_set(error, RESULT_FAILED,
                     "the measuring process failed: its own message is above");
}

Result child_run(const ChildRun *run, json_t **row, double *wall_ms, Error *error)
{
    char path[PATH_MAX], steps[16], warm_up[16], *rest = NULL;
    char *words[MOST_WORDS + 1] = {"tractrix-bench", "speed"},
                             *settings = strdup(run->method->settings);
    int count = 2;
    *row = NULL;
    Result result = settings ? outfile_make_scratch(path, "tractrix-bench", error)
                             : error_set(error, RESULT_FAILED, "no memory for settings");
    if (result != RESULT_OK) {
        free(settings);
        return result;
    }
    snprintf(steps, sizeof steps, "%d", run->steps);
    snprintf(warm_up, sizeof warm_up, "%d", run->warm_up);
    const char *const pairs[][2] = {{"--part", "sets"},
                                    {"--algo", run->method->algo},
                                    {"--variant", run->method->variant},
                                    {"--set", run->set},
                                    {"--tfx", run->file},
                                    {"--steps", steps},
                                    {"--warm-up", warm_up},
                                    {"--json", path},
                                    {"--device", run->gpu->device}};
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; ++i) {
        if (!pairs[i][1] || !*pairs[i][1]) continue;
        words[count++] = (char *)pairs[i][0];
        words[count++] = (char *)pairs[i][1];
    }
    if (run->gpu->software) words[count++] = "--software";
    if (run->gpu->backend == BACKEND_OSMESA) words[count++] = "--osmesa";
    for (char *word = strtok_r(settings, " ", &rest); word && count < MOST_WORDS;
         word = strtok_r(NULL, " ", &rest))
        words[count++] = word;
    result = execute(words, run, wall_ms, error);
    json_t *rows = NULL;
    THEN(result, json_load(&rows, path, error));
    *row = json_incref(json_array_get(rows, 0));
    json_decref(rows);
    outfile_remove(path, NULL);
    free(settings);
    if (!*row)
        THEN(result, error_set(error, RESULT_FAILED, "the measuring process wrote no result"));
    return result;
}
