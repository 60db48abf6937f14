// SPDX-License-Identifier: MIT
// Command lines of all programs: one parser and one form of help. Options are rows of a table;
// those of tractrix-render are the rows of params.def.
//
// --flag VALUE and --flag=VALUE are equivalent. A switch is set by --flag and cleared by --no-flag.
// Letters are -l VALUE or -lVALUE; the letters of switches can be combined (-qv). -- ends the
// options. The last of repeated options counts. '_' in names is read as '-'. An OPTION_MAYBE takes
// the next argument only if it is a number: in --turntable hair.tfx the second word is a file.
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
    OPTION_WORD,   // sets an int: the index of the word in `value`, "one|two|three", from 0
    OPTION_MAYBE,  // sets a const char *: a number, or "" if none follows
    OPTION_STEP,   // appends itself and its text (if any) to an OptionSteps
} OptionKind;

typedef struct Option {
    const char *name;
    char letter; // 0 if there is none
    OptionKind kind;
    size_t place;      // offset in the caller's struct
    const char *value; // placeholder of the value in the help; NULL if the option takes none
    double least, most;
    const char *help;
} Option;

enum { OPTION_MOST_STEPS = 32, OPTIONS_MOST = 256 };

// Options whose order matters, in the order of the command line.
typedef struct OptionSteps {
    struct {
        const Option *option;
        const char *text; // NULL if it takes none
    } step[OPTION_MOST_STEPS];
    int count;
} OptionSteps;

// A part of the manual page, and a topic of --help, that is not about options.
typedef struct OptionsChapter {
    const char *topic, *title, *text;
    const char *const (*entries)[3]; // key, example, meaning or ""; terminated by {NULL}
} OptionsChapter;

// The content of --help and of the manual page. Lists are terminated by NULL; a NULL list is empty.
typedef struct OptionsProgram {
    const char *name, *summary, *description;
    const char *synopsis;             // follows the name; further lines are further usages
    const char *page;                 // name of the manual page; NULL: `name`
    const struct OptionsProgram *sub; // the program with its command `sub_word`, or NULL
    const char *sub_word;
    const char *const (*commands)[2]; // commands and their meanings
    const Option *options;
    size_t option_count;
    const char *const *headings; // [option_count] heading of each option; NULL: all under "Options"
    const char *const *brief;    // names of the options that plain --help lists; NULL: all
    const char *const (*topics)[2]; // --help TOPIC: words, and their content or NULL
    bool (*is_of)(const char *topic, size_t option); // for each word of `topics`
    const OptionsChapter *const *chapters;
    const char *const *notes;       // paragraphs after the options
    const char *const (*status)[2]; // number and meaning
    const char *const *examples;
} OptionsProgram;

// Fills the struct at `values`, which must hold the defaults. Arguments that are not options are
// moved to the end of argv, from *first on. --help and --version are answered on stdout, with *done
// set. RESULT_USAGE for anything unknown, incomplete or out of range.
Result options_parse(const OptionsProgram *program, void *values, int argc, char **argv, int *first,
                     bool *done, Error *error);

// --- The parser alone.

// A walk along a command line; zero except for the first four members.
typedef struct OptionsWalk {
    const Option *options;
    size_t option_count;
    int argc;
    char **argv;         // [argc]; the first is the program's name
    int taken;           // arguments after the name that are done
    const char *letters; // rest of a group such as -qv
    bool ended;          // by --
} OptionsWalk;

typedef enum OptionsFound {
    OPTIONS_END,     // end of the command line
    OPTIONS_OPTION,  // an option and its value
    OPTIONS_OPERAND, // an argument that is not an option: `text`
    OPTIONS_HELP,    // --help, -h: `text` is the topic or NULL
    OPTIONS_VERSION, // --version
} OptionsFound;

typedef struct OptionsArgument {
    OptionsFound found;
    const Option *option;
    const char *text; // the option's value, "true" or "false" for a switch; NULL if it takes none
    char flag[80];    // the option as the user wrote it, for messages
} OptionsArgument;

// Takes the next argument. RESULT_USAGE for an unknown option, with the nearest one if there is
// any, and for a missing or superfluous value.
Result options_next(OptionsWalk *walk, OptionsArgument *argument, Error *error);

// The options of every program: --help, --version.
enum { OPTIONS_COMMON_COUNT = 2 };
extern const Option OPTIONS_COMMON[OPTIONS_COMMON_COUNT];

// The parameters of params.def as options, [PARAM_COUNT], in the table's order, without `place`.
extern const Option OPTIONS_OF_PARAMS[];

// The option called `name`, "--name" or "-l", with '_' read as '-'; NULL if there is none.
const Option *options_find(const Option *options, size_t count, const char *name);

// --- The help alone.

// Prints --help TOPIC: NULL for plain --help; all; man (roff), markdown; bash, zsh, fish
// (completion); a word of `topics`, the topic of a chapter, or an option. RESULT_USAGE for others,
// with the list.
Result options_help(const OptionsProgram *program, const char *topic, FILE *stream, Error *error);
