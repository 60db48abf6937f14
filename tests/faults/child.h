// SPDX-License-Identifier: MIT
// A program run to its end, or to a signal, in bounded time.
#pragma once

#include <stdbool.h>

typedef struct Child {
    const char *folder;             // where it runs
    const char *program;            // path
    char *const *arguments;         // NULL behind the last; [0] is the program's name
    const char *const *environment; // NAME=VALUE besides the parent's, NULL behind the last
    double limit_s;                 // then it is killed
    double kill_after_s;            // negative: never
    int kill_signal;
} Child;

typedef struct ChildEnd {
    bool hung;         // past limit_s
    int status;        // exit status, -1: ended by `signal`
    int signal;        // 0: none
    double seconds;    // wall clock
    char errors[4000]; // standard error, cut, zero-terminated
} ChildEnd;

// Standard output goes to the file "stdout" beside the folder. Ends the calling program if nothing
// can be started: a harness that cannot run must not pass.
void child_run(const Child *child, ChildEnd *end);
