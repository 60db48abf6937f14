// SPDX-License-Identifier: MIT
#include "bench/bench_child.h"
#include "base/clock.h"
#include "base/outfile.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum { MOST_WORDS = 64 };

// The words of a command line; those of a method's settings are cut in place.
typedef struct Words {
    char *at[MOST_WORDS + 1]; // NULL behind the last
    int count;
} Words;

static void add(Words *words, const char *text)
{
    if (words->count < MOST_WORDS) words->at[words->count++] = (char *)text;
}

static void add_pair(Words *words, const char *flag, const char *value)
{
    if (!value || !*value) return;
    add(words, flag);
    add(words, value);
}

// Only what may be called between fork and exec.
static void become(const Words *words, int nowhere)
{
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    execv("/proc/self/exe", words->at);
    _exit(127);
}

static Result run(const Words *words, double *wall_ms, Error *error)
{
    int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC), status = 0;
    double begin = clock_ms();
    pid_t child = fork();
    if (child == 0) become(words, nowhere);
    while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
    *wall_ms = clock_ms() - begin;
    if (nowhere >= 0) close(nowhere);
    // 1: a bound is broken, which is this process's to tell
    if (child > 0 && WIFEXITED(status) && WEXITSTATUS(status) <= 1) return RESULT_OK;
    return error_set(error, RESULT_FAILED, "%s: another process for a measurement failed",
                     words->at[0]);
}

Result child_measure(const BenchOptions *options, const Method *method, const char *set,
                     const char *file, int steps, int warm_up, const ChildVariable *variables,
                     int variable_count, json_t **row, double *wall_ms, Error *error)
{
    char path[PATH_MAX], counts[3][16], *settings = strdup(method->settings), *rest = NULL;
    Words words = {{NULL}, 0};
    outfile_scratch_name(path, "tractrix-bench");
    int temporary = mkstemp(path);
    *row = NULL;
    if (temporary >= 0) close(temporary);
    if (!settings || temporary < 0) {
        free(settings);
        return error_set(error, RESULT_FAILED, "%s: %s", path, strerror(errno));
    }
    snprintf(counts[0], sizeof counts[0], "%d", steps);
    snprintf(counts[1], sizeof counts[1], "%d", warm_up);
    snprintf(counts[2], sizeof counts[2], "%d", options->gpu.device);
    add(&words, "tractrix-bench");
    add(&words, "speed");
    add_pair(&words, "--part", "sets");
    add_pair(&words, "--algo", method->algo);
    add_pair(&words, "--variant", method->variant);
    for (char *word = strtok_r(settings, " ", &rest); word; word = strtok_r(NULL, " ", &rest))
        add(&words, word);
    add_pair(&words, "--set", set);
    add_pair(&words, "--tfx", file);
    add_pair(&words, "--steps", counts[0]);
    add_pair(&words, "--warm-up", counts[1]);
    add_pair(&words, "--json", path);
    if (options->gpu.device >= 0) add_pair(&words, "--device", counts[2]);
    if (options->gpu.software) add(&words, "--software");
    if (options->gpu.backend == BACKEND_OSMESA) add(&words, "--osmesa");
    for (int i = 0; i < variable_count; ++i) setenv(variables[i].name, variables[i].value, 1);
    Result result = run(&words, wall_ms, error);
    json_t *rows = result == RESULT_OK ? json_load_file(path, 0, NULL) : NULL;
    *row = json_incref(json_array_get(rows, 0));
    json_decref(rows);
    unlink(path);
    free(settings);
    if (result == RESULT_OK && !*row)
        result = error_set(error, RESULT_FAILED, "a measurement's process left no row");
    return result;
}
