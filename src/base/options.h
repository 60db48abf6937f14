// SPDX-License-Identifier: MIT
// A small program's command line from one table: parsing, --help and the manual page. (Those of
// tractrix-render come from the parameter table instead.)
#pragma once

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

typedef enum OptionKind {
    OPTION_SWITCH, // sets a bool
    OPTION_STRING, // sets a const char *, not empty
    OPTION_REAL,   // sets a double between least and most
    OPTION_WHOLE,  // sets an int between least and most
    OPTION_WORD,   // sets an int: which of the words in `value`, "one|two|three", from 0
    OPTION_STEP,   // appends itself and its text, if it has one, to an OptionSteps
} OptionKind;

typedef struct Option {
    const char *name;
    char letter; // 0: none
    OptionKind kind;
    size_t place;      // offset in the caller's struct
    const char *value; // what stands for the value in the help
    double least, most;
    const char *help;
} Option;

enum { OPTION_MOST_STEPS = 32 };

// Options whose order counts, as they stand on the command line.
typedef struct OptionSteps {
    struct {
        const Option *option;
        const char *text; // NULL: it takes none
    } step[OPTION_MOST_STEPS];
    int count;
} OptionSteps;

typedef struct OptionsProgram {
    const char *name, *summary, *synopsis, *description; // synopsis: behind the name
    const char *page;                                    // name of the manual page; NULL: `name`
    const char *const (*commands)[2]; // words and what they do, {NULL} behind the last; NULL: none
    const Option *options;
    size_t option_count;
    const char *const *notes;       // paragraphs below the options, NULL behind the last
    const char *const (*status)[2]; // number and meaning, {NULL} behind the last
    const char *const *examples;    // NULL behind the last
} OptionsProgram;

// Fills the struct at `values`, which holds the defaults; what is no option is moved to the end of
// argv, from *first on. --help (text) and --help=man, --version are answered on stdout with *done
// set. RESULT_USAGE for anything unknown, incomplete or out of range.
Result options_parse(const OptionsProgram *program, void *values, int argc, char **argv, int *first,
                     bool *done, Error *error);
