// SPDX-License-Identifier: MIT
// What a run would leave behind when it ends before its time: temporary files and child processes.
// A run that is interrupted removes its own; those of a run that was killed are removed by the next
// one that writes into the folder. All functions may be called from any thread.
#pragma once

#include <stddef.h>

// Something that must go if the run ends now.
typedef struct Leftover Leftover;

// Remembers a file to be unlinked, or a process group to be killed, by leftovers_remove. `folder`:
// a handle that stays open until the file is forgotten. NULL when memory is short: then it is not
// remembered.
Leftover *leftover_add_file(int folder, const char *name);
Leftover *leftover_add_group(int process_group);

// Forgets it again: it has its final name, or has ended. NULL is legal.
void leftover_forget(Leftover *leftover);

// Unlinks and kills all that is remembered; for a process that is about to end at once.
void leftovers_remove(void);

// The name, without a folder, of this process's temporary file number `number`. It tells the
// machine and the process.
enum { LEFTOVER_NAME_SIZE = 64 };
void leftovers_name(char name[LEFTOVER_NAME_SIZE], unsigned number);

// Removes temporary files of this machine's processes that have ended from `folder` (a handle),
// unless it was given last time, too; files that a process holds locked (flock) stay. Failing is
// legal.
void leftovers_sweep(int folder);
