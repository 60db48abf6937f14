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

static void add(char **words, const char *text)
{
    for (int i = 0; i < MOST_WORDS; ++i)
        if (!words[i]) {
            words[i] = (char *)text;
            return;
        }
}

static void add_pair(char **words, const char *flag, const char *value)
{
    if (!value || !*value) return;
    add(words, flag);
    add(words, value);
}

// Runs the words with the variable set, its output thrown away.
static Result execute(char **words, const ChildRun *run, double *wall_ms, Error *error)
{
    int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC), status = 0;
    const char *before = getenv(run->variable);
    char *kept = before ? strdup(before) : NULL;
    double begin = clock_ms();
    setenv(run->variable, run->value, 1);
    pid_t child = fork();
    if (child == 0) { // only what may be called between fork and exec
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
    // 1: a bound is broken, which this process reports
    if (child > 0 && WIFEXITED(status) && WEXITSTATUS(status) <= 1) return RESULT_OK;
    return error_set(error, RESULT_FAILED, "tractrix-bench: another process to measure in failed");
}

Result child_run(const ChildRun *run, json_t **row, double *wall_ms, Error *error)
{
    char path[PATH_MAX], steps[16], warm_up[16], device[16], *rest = NULL;
    char *words[MOST_WORDS + 1] = {NULL}, *settings = strdup(run->method->settings);
    outfile_scratch_name(path, "tractrix-bench");
    int temporary = mkstemp(path);
    *row = NULL;
    if (temporary >= 0) close(temporary);
    if (!settings || temporary < 0) {
        free(settings);
        return error_set(error, RESULT_FAILED, "%s: %s", path, strerror(errno));
    }
    snprintf(steps, sizeof steps, "%d", run->steps);
    snprintf(warm_up, sizeof warm_up, "%d", run->warm_up);
    snprintf(device, sizeof device, "%d", run->gpu->device);
    add(words, "tractrix-bench");
    add(words, "speed");
    add_pair(words, "--part", "sets");
    add_pair(words, "--algo", run->method->algo);
    add_pair(words, "--variant", run->method->variant);
    for (char *word = strtok_r(settings, " ", &rest); word; word = strtok_r(NULL, " ", &rest))
        add(words, word);
    add_pair(words, "--set", run->set);
    add_pair(words, "--tfx", run->file);
    add_pair(words, "--steps", steps);
    add_pair(words, "--warm-up", warm_up);
    add_pair(words, "--json", path);
    if (run->gpu->device >= 0) add_pair(words, "--device", device);
    if (run->gpu->software) add(words, "--software");
    if (run->gpu->backend == BACKEND_OSMESA) add(words, "--osmesa");
    Result result = execute(words, run, wall_ms, error);
    json_t *rows = result == RESULT_OK ? json_load_file(path, 0, NULL) : NULL;
    *row = json_incref(json_array_get(rows, 0));
    json_decref(rows);
    unlink(path);
    free(settings);
    if (!*row) THEN(result, error_set(error, RESULT_FAILED, "a measuring process left no row"));
    return result;
}
