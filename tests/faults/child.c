// SPDX-License-Identifier: MIT
#include "faults/child.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { NAMES_MOST = 400 };

static double now_s(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static void sleep_s(double seconds)
{
    struct timespec time = {.tv_sec = (time_t)seconds,
                            .tv_nsec = (long)(1e9 * (seconds - (double)(time_t)seconds))};
    nanosleep(&time, NULL);
}

static bool same_name(const char *a, const char *b)
{
    size_t length = strcspn(a, "=");
    return strncmp(a, b, length + 1) == 0;
}

// Joins the parent's environment, except for replaced variables, with `own`.
static void join_names(const char *names[NAMES_MOST], const char *const *own)
{
    int count = 0;
    for (int i = 0; own[i]; ++i) names[count++] = own[i];
    int owned = count;
    for (char **each = environ; *each && count < NAMES_MOST - 1; ++each) {
        bool replaced = false;
        for (int i = 0; i < owned; ++i) replaced = replaced || same_name(names[i], *each);
        if (!replaced) names[count++] = *each;
    }
    names[count] = NULL;
}

// Starts a process group, so that all its processes can be killed.
static pid_t start(const Child *child, int errors)
{
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    const char *names[NAMES_MOST];
    pid_t process = 0;
    join_names(names, child->environment);
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    posix_spawn_file_actions_addchdir_np(&actions, child->folder);
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 1, "../stdout", O_WRONLY | O_CREAT | O_TRUNC, 0666);
    posix_spawn_file_actions_adddup2(&actions, errors, 2);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    int reason = posix_spawn(&process, child->program, &actions, &attributes, child->arguments,
                             (char *const *)names);
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    if (reason == 0) return process;
    fprintf(stderr, "torture: cannot start %s in %s: %s\n", child->program, child->folder,
            strerror(reason));
    exit(1);
}

static void read_errors(int file, ChildEnd *end)
{
    ssize_t length = pread(file, end->errors, sizeof end->errors - 1, 0);
    end->errors[length < 0 ? 0 : length] = 0;
}

void child_run(const Child *child, ChildEnd *end)
{
    *end = (ChildEnd){.status = -1};
    int errors = memfd_create("errors", MFD_CLOEXEC), state = 0;
    double begin = now_s();
    pid_t process = start(child, errors);
    bool sent = child->kill_after_s < 0;
    for (double pause = 2e-4; waitpid(process, &state, WNOHANG) == 0;) {
        double age = now_s() - begin;
        if (!sent && age >= child->kill_after_s) {
            kill(process, child->kill_signal);
            sent = true;
        }
        if (age > child->limit_s) {
            end->hung = true;
            kill(-process, SIGKILL);
        }
        double wait = sent ? pause : child->kill_after_s - age;
        sleep_s(wait < pause ? (wait > 0 ? wait : 0) : pause);
        if (pause < 2e-3) pause *= 1.2;
    }
    end->seconds = now_s() - begin;
    if (WIFEXITED(state)) end->status = WEXITSTATUS(state);
    if (WIFSIGNALED(state)) end->signal = WTERMSIG(state);
    read_errors(errors, end);
    close(errors);
}
