// SPDX-License-Identifier: MIT
// Things that a run would leave behind if it ended early: temporary files and child processes. An
// interrupted run removes its own; those of a killed run are removed by the next run that writes to
// the same folder. All functions are thread-safe.
#pragma once

#include <stddef.h>

// Something to remove if the run ends now.
typedef struct Leftover Leftover;

// Registers a file to be unlinked, or a process group to be killed, by leftovers_remove. `folder`:
// a handle that must stay open until the file is forgotten. NULL when memory is short; then it is
// not registered.
Leftover *leftover_add_file(int folder, const char *name);
Leftover *leftover_add_group(int process_group);

// Removes the registration, when the file has its final name or the process has ended. Accepts
// NULL.
void leftover_forget(Leftover *leftover);

// Unlinks and kills everything registered. The process must end immediately afterwards.
void leftovers_remove(void);

// The name (without folder) of this process's temporary file number `number`. It contains the
// machine and the process.
enum { LEFTOVER_NAME_SIZE = 64 };
void leftovers_name(char name[LEFTOVER_NAME_SIZE], unsigned number);

// Removes temporary files in `folder` (a handle) whose processes, on this machine, have ended. Does
// nothing if it is the same folder as last time. Files that a process holds locked (flock) stay.
// Errors are ignored.
void leftovers_sweep(int folder);
