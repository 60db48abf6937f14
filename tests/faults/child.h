// SPDX-License-Identifier: MIT
// Runs a program to its end, or until it is killed by a signal, within limited time.
#pragma once

#include <stdbool.h>

typedef struct Child {
    const char *folder;             // working directory
    const char *program;            // path
    char *const *arguments;         // NULL-terminated; [0] is the program's name
    const char *const *environment; // NAME=VALUE in addition to the parent's environment,
                                    // NULL-terminated
    double limit_s;                 // the program is killed after that time
    double kill_after_s;            // negative: never
    int kill_signal;
} Child;

typedef struct ChildEnd {
    bool hung;         // exceeded limit_s
    int status;        // exit status, -1: ended by `signal`
    int signal;        // 0: none
    double seconds;    // wall clock
    char errors[4000]; // standard error, truncated, zero-terminated
} ChildEnd;

// Writes standard output to the file "stdout" next to the folder. Ends the calling program if
// nothing can be started: a harness that cannot run must not pass.
void child_run(const Child *child, ChildEnd *end);
