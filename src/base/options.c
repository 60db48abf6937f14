// SPDX-License-Identifier: MIT
#include "base/options.h"

#include "base/completion.h"
#include "base/prose.h"
#include "base/suggest.h"

#include "version.h"

#include <ctype.h>
#include <getopt.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_OPTIONS = 128, MOST_WORDS = 16, FIRST_CODE = 256 };
enum { CODE_HELP = FIRST_CODE + MOST_OPTIONS, CODE_VERSION };

static const Option COMMON[] = {
    {"help", 'h', OPTION_SWITCH, 0, NULL, 0, 0,
     "print this and stop; --help=man: in roff; --help=bash: completion"},
    {"version", 0, OPTION_SWITCH, 0, NULL, 0, 0, "print the version and stop"},
};
enum { COMMON_COUNT = sizeof COMMON / sizeof *COMMON };

static const Option *option_at(const OptionsProgram *program, size_t i)
{
    return i < program->option_count ? &program->options[i] : &COMMON[i - program->option_count];
}

// "-j, --jobs N"
static void write_flag(const Option *option, char *text, size_t size)
{
    char letter[8] = "";
    if (option->letter) snprintf(letter, sizeof letter, "-%c, ", option->letter);
    snprintf(text, size, "%s--%s%s%s", letter, option->name, option->value ? " " : "",
             option->value ? option->value : "");
}

// --- The text.

static void write_text(const OptionsProgram *program)
{
    printf("Usage: %s %s\n\n", program->name, program->synopsis);
    prose_write_wrapped(stdout, program->description, 0, 0);
    if (program->commands) printf("\nCommands:\n");
    for (const char *const(*c)[2] = program->commands; c && (*c)[0]; ++c)
        prose_write_entry(stdout, (*c)[0], (*c)[1]);
    printf("\nOptions:\n");
    for (size_t i = 0; i < program->option_count + COMMON_COUNT; ++i) {
        char flag[96];
        write_flag(option_at(program, i), flag, sizeof flag);
        prose_write_entry(stdout, flag, option_at(program, i)->help);
    }
    for (const char *const *note = program->notes; *note; ++note) {
        printf("\n");
        prose_write_wrapped(stdout, *note, 0, 0);
    }
    printf("\nExit status:\n");
    for (const char *const(*s)[2] = program->status; (*s)[0]; ++s)
        printf("  %3s  %s\n", (*s)[0], (*s)[1]);
    printf("\nExamples:\n");
    for (const char *const *e = program->examples; *e; ++e) printf("  %s\n", *e);
}

// --- The manual page.

static void write_man(const OptionsProgram *program)
{
    const char *page = program->page ? program->page : program->name;
    printf(".TH ");
    for (const char *at = page; *at; ++at) putchar(toupper((unsigned char)*at));
    printf(" 1 \"\" \"Tractrix %s\"\n.SH NAME\n", TRACTRIX_VERSION);
    printf("%s \\- ", page);
    prose_write_roff(stdout, program->summary);
    printf(".SH SYNOPSIS\n.B %s\n", program->name);
    prose_write_roff(stdout, program->synopsis);
    printf(".SH DESCRIPTION\n");
    prose_write_roff(stdout, program->description);
    if (program->commands) printf(".SH COMMANDS\n");
    for (const char *const(*c)[2] = program->commands; c && (*c)[0]; ++c)
        prose_write_roff_entry(stdout, (*c)[0], (*c)[1]);
    printf(".SH OPTIONS\n");
    for (size_t i = 0; i < program->option_count + COMMON_COUNT; ++i) {
        char flag[96];
        write_flag(option_at(program, i), flag, sizeof flag);
        prose_write_roff_entry(stdout, flag, option_at(program, i)->help);
    }
    printf(".SH NOTES\n");
    for (const char *const *note = program->notes; *note; ++note) {
        printf(".PP\n");
        prose_write_roff(stdout, *note);
    }
    printf(".SH \"EXIT STATUS\"\n");
    for (const char *const(*s)[2] = program->status; (*s)[0]; ++s)
        prose_write_roff_entry(stdout, (*s)[0], (*s)[1]);
    printf(".SH EXAMPLES\n.nf\n");
    for (const char *const *e = program->examples; *e; ++e) prose_write_roff(stdout, *e);
    printf(".fi\n");
}

static void write_bash(const OptionsProgram *program)
{
    char texts[MOST_OPTIONS + COMMON_COUNT][96];
    const char *flags[MOST_OPTIONS + COMMON_COUNT];
    size_t count = program->option_count + COMMON_COUNT;
    for (size_t i = 0; i < count; ++i) {
        write_flag(option_at(program, i), texts[i], sizeof *texts);
        flags[i] = texts[i];
    }
    completion_write_bash(stdout, program->name, flags, count);
}

// --- Parsing.

static Result fail_unknown(const OptionsProgram *program, const char *flag, Error *error)
{
    const char *names[MOST_OPTIONS + COMMON_COUNT];
    char word[64];
    size_t count = program->option_count + COMMON_COUNT, length = strcspn(flag, "=");
    for (size_t i = 0; i < count; ++i) names[i] = option_at(program, i)->name;
    snprintf(word, sizeof word, "%s", flag + strspn(flag, "-"));
    word[strcspn(word, "=")] = 0;
    return error_set(error, RESULT_USAGE, "no option '%.*s': did you mean '--%s'?", (int)length,
                     flag, suggest_nearest(word, names, count));
}

static Result set_number(const Option *option, char *at, const char *text, Error *error)
{
    char *end;
    double number = strtod(text, &end);
    bool whole = option->kind == OPTION_WHOLE;
    if (end == text || *end || !(number >= option->least && number <= option->most) ||
        (whole && number != (int)number))
        return error_set(error, RESULT_USAGE, "--%s: expected %s from %.10g to %.10g, got '%s'",
                         option->name, whole ? "a whole number" : "a number", option->least,
                         option->most, text);
    int count = (int)number;
    memcpy(at, whole ? (void *)&count : (void *)&number, whole ? sizeof count : sizeof number);
    return RESULT_OK;
}

// Which of the words in "one|two|three" the text is.
static Result set_word(const Option *option, char *at, const char *text, Error *error)
{
    char words[MOST_WORDS * 32];
    const char *names[MOST_WORDS];
    int count = 0;
    snprintf(words, sizeof words, "%s", option->value);
    for (char *rest = words, *word; count < MOST_WORDS && (word = strsep(&rest, "|"));) {
        if (strcmp(word, text) == 0) {
            memcpy(at, &count, sizeof count);
            return RESULT_OK;
        }
        names[count++] = word;
    }
    return error_set(error, RESULT_USAGE, "--%s: expected %s, got '%s': did you mean '%s'?",
                     option->name, option->value, text,
                     suggest_nearest(text, names, (size_t)count));
}

static Result append_step(const Option *option, OptionSteps *steps, const char *text, Error *error)
{
    if (steps->count == OPTION_MOST_STEPS)
        return error_set(error, RESULT_USAGE, "--%s: more than %d steps", option->name,
                         OPTION_MOST_STEPS);
    steps->step[steps->count].option = option;
    steps->step[steps->count++].text = text;
    return RESULT_OK;
}

static Result set_option(const Option *option, char *values, const char *text, Error *error)
{
    char *at = values + option->place;
    const bool on = true;
    switch (option->kind) {
    case OPTION_SWITCH:
        memcpy(at, &on, sizeof on);
        return RESULT_OK;
    case OPTION_STRING:
        if (!*text)
            return error_set(error, RESULT_USAGE, "--%s: expected %s, got nothing", option->name,
                             option->value);
        memcpy(at, &text, sizeof text);
        return RESULT_OK;
    case OPTION_WORD:
        return set_word(option, at, text, error);
    case OPTION_STEP:
        return append_step(option, (OptionSteps *)(void *)at, text, error);
    default:
        return set_number(option, at, text, error);
    }
}

static void make_tables(const OptionsProgram *program, struct option *table, char *letters)
{
    *letters++ = ':'; // tell a missing value from an unknown option
    for (size_t i = 0; i < program->option_count; ++i) {
        const Option *option = &program->options[i];
        table[i] = (struct option){option->name, option->value != NULL, NULL, FIRST_CODE + (int)i};
        if (!option->letter) continue;
        *letters++ = option->letter;
        if (option->value) *letters++ = ':';
    }
    table += program->option_count;
    table[0] = (struct option){"help", optional_argument, NULL, CODE_HELP};
    table[1] = (struct option){"version", no_argument, NULL, CODE_VERSION};
    table[2] = (struct option){0};
    *letters++ = 'h';
    *letters = 0;
}

static Result answer(const OptionsProgram *program, int code, Error *error)
{
    if (code == CODE_VERSION)
        printf("%s %s\n", program->name, TRACTRIX_VERSION);
    else if (code == 'h' || !optarg)
        write_text(program);
    else if (strcmp(optarg, "man") == 0)
        write_man(program);
    else if (strcmp(optarg, "bash") == 0)
        write_bash(program);
    else
        return error_set(error, RESULT_USAGE, "--help: expected man, bash or nothing, got '%s'",
                         optarg);
    return RESULT_OK;
}

static const Option *find_option(const OptionsProgram *program, int code)
{
    if (code >= FIRST_CODE) return &program->options[code - FIRST_CODE];
    for (size_t i = 0; i < program->option_count; ++i)
        if (program->options[i].letter == code) return &program->options[i];
    return NULL;
}

Result options_parse(const OptionsProgram *program, void *values, int argc, char **argv, int *first,
                     bool *done, Error *error)
{
    struct option table[MOST_OPTIONS + COMMON_COUNT + 1];
    char letters[2 * MOST_OPTIONS + 4];
    int code;
    make_tables(program, table, letters);
    opterr = 0;
    optind = 0;
    *done = false;
    while ((code = getopt_long(argc, argv, letters, table, NULL)) != -1) {
        if (code == ':')
            return error_set(error, RESULT_USAGE, "'%s' needs a value", argv[optind - 1]);
        if (code == CODE_HELP || code == CODE_VERSION || code == 'h') {
            *done = true;
            return answer(program, code, error);
        }
        const Option *option = code == '?' ? NULL : find_option(program, code);
        if (!option) return fail_unknown(program, argv[optind - 1], error);
        Result result = set_option(option, values, optarg, error);
        if (result != RESULT_OK) return result;
    }
    *first = optind;
    return RESULT_OK;
}
