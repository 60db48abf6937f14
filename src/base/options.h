// SPDX-License-Identifier: MIT
// Command lines of all programs: one parser, one kind of help. Options are rows of a table; those
// of tractrix-render are the rows of params.def.
//
// --flag VALUE and --flag=VALUE are the same; a switch is set by --flag and unset by --no-flag, a
// letter is -l VALUE or -lVALUE, switches' letters may stand together (-qv), -- ends the options.
// The last of equal options counts. In names '_' is '-'. An OPTION_MAYBE takes the next argument
// only if that is a number: --turntable hair.tfx names a file.
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
    OPTION_MAYBE,  // sets a const char *: a number, or "" where none follows
    OPTION_STEP,   // appends itself and its text, if it has one, to an OptionSteps
} OptionKind;

typedef struct Option {
    const char *name;
    char letter; // 0: none
    OptionKind kind;
    size_t place;      // offset in the caller's struct
    const char *value; // what stands for the value in the help; NULL: it takes none
    double least, most;
    const char *help;
} Option;

enum { OPTION_MOST_STEPS = 32, OPTIONS_MOST = 256 };

// Options whose order counts, as they stand on the command line.
typedef struct OptionSteps {
    struct {
        const Option *option;
        const char *text; // NULL: it takes none
    } step[OPTION_MOST_STEPS];
    int count;
} OptionSteps;

// A part of the manual page and a topic of --help that is not about options.
typedef struct OptionsChapter {
    const char *topic, *title, *text;
    const char *const (*entries)[3]; // key, example, meaning or ""; {NULL} behind the last
} OptionsChapter;

// What --help and the manual page say. Lists end with NULL; a list that is NULL is empty.
typedef struct OptionsProgram {
    const char *name, *summary, *description;
    const char *synopsis;             // behind the name; more lines, each for a usage of its own
    const char *page;                 // name of the manual page; NULL: `name`
    const struct OptionsProgram *sub; // what it is with its command `sub_word`, or NULL
    const char *sub_word;
    const char *const (*commands)[2]; // words and what they do
    const Option *options;
    size_t option_count;
    const char *const *headings; // [option_count] under which each is listed; NULL: all "Options"
    const char *const *brief;    // names of the options that --help alone lists; NULL: all
    const char *const (*topics)[2]; // --help TOPIC: words, and what they list or NULL
    bool (*is_of)(const char *topic, size_t option); // for each word of `topics`
    const OptionsChapter *const *chapters;
    const char *const *notes;       // paragraphs below the options
    const char *const (*status)[2]; // number and meaning
    const char *const *examples;
} OptionsProgram;

// Fills the struct at `values`, which holds the defaults; what is no option is moved to the end of
// argv, from *first on. --help and --version are answered on stdout with *done set. RESULT_USAGE
// for anything unknown, incomplete or out of range.
Result options_parse(const OptionsProgram *program, void *values, int argc, char **argv, int *first,
                     bool *done, Error *error);

// --- The parser by itself.

// A walk through a command line; zero but for the first four.
typedef struct OptionsWalk {
    const Option *options;
    size_t option_count;
    int argc;
    char **argv;         // [argc]; the first is the program's name
    int taken;           // arguments behind that name that are done with
    const char *letters; // what is left of a group such as -qv
    bool ended;          // by --
} OptionsWalk;

typedef enum OptionsFound {
    OPTIONS_END,     // the command line's end
    OPTIONS_OPTION,  // an option and its value
    OPTIONS_OPERAND, // what is no option: `text`
    OPTIONS_HELP,    // --help, -h: `text` is the topic or NULL
    OPTIONS_VERSION, // --version
} OptionsFound;

typedef struct OptionsArgument {
    OptionsFound found;
    const Option *option;
    const char *text; // an option's value, "true" or "false" for a switch; NULL if it takes none
    char flag[80];    // the option as the user wrote it, for messages
} OptionsArgument;

// The next argument. RESULT_USAGE for an unknown option, with the nearest one if any is near, and
// for a value that is missing or not taken.
Result options_next(OptionsWalk *walk, OptionsArgument *argument, Error *error);

// Those that every program has: --help, --version.
enum { OPTIONS_COMMON_COUNT = 2 };
extern const Option OPTIONS_COMMON[OPTIONS_COMMON_COUNT];

// The parameters of params.def as options, [PARAM_COUNT], in the table's order, without `place`.
extern const Option OPTIONS_OF_PARAMS[];

// The option called `name` or "--name" or "-l", '_' read as '-'; NULL: there is none.
const Option *options_find(const Option *options, size_t count, const char *name);

// --- The help by itself.

// Writes what --help TOPIC prints: NULL for plain --help; all; man (roff), markdown; bash, zsh,
// fish (completion); a word of `topics`, the chapter's topic, or an option. RESULT_USAGE for
// others, with the list.
Result options_help(const OptionsProgram *program, const char *topic, FILE *stream, Error *error);
