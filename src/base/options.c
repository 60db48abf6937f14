// SPDX-License-Identifier: MIT
#include "base/options.h"

#include "base/params.h"
#include "base/suggest.h"

#include "glsl/common/collider_table.h"

#include "version.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_WORDS = 16, NAME_SIZE = 80 };

// --- Parameters as options.

#define BAR_WORD(value, word)     "|" word
#define VALUE_BOOL(CHOICES)       NULL
#define VALUE_INT(CHOICES)        "N"
#define VALUE_UINT(CHOICES)       "N"
#define VALUE_FLOAT(CHOICES)      "X"
#define VALUE_VEC3(CHOICES)       "X,Y,Z"
#define VALUE_COLOR(CHOICES)      "COLOR"
#define VALUE_BACKGROUND(CHOICES) "COLOR"
#define VALUE_PROFILE(CHOICES)    "X[:X...]"
#define VALUE_TURN(CHOICES)       "[X]"
#define VALUE_AUTO_INT(CHOICES)   "N|auto"
#define VALUE_RATE(CHOICES)       "X|A/B"
#define VALUE_AUTO_FLOAT(CHOICES) "X|auto"
#define VALUE_AUTO_VEC3(CHOICES)  "X,Y,Z|auto"
#define VALUE_AUTO_COLOR(CHOICES) "COLOR|auto"
#define VALUE_UNIT(CHOICES)       "UNIT"
#define VALUE_SIZE(CHOICES)       "WxH"
#define VALUE_PART(CHOICES)       "I/N"
#define VALUE_CHOICE(CHOICES)     &(CHOICES(BAR_WORD))[1]
#define VALUE_TEXT(CHOICES)       "NAME"
#define VALUE_PATH(CHOICES)       "PATH"

#define PARAM(scope, KIND, GROUP, owner, field, letter_, default_, minimum, maximum, unit,         \
              CHOICES, help_)                                                                      \
    {.name = #field,                                                                               \
     .letter = letter_,                                                                            \
     .kind = PARAM_##KIND == PARAM_BOOL   ? OPTION_SWITCH                                          \
             : PARAM_##KIND == PARAM_TURN ? OPTION_MAYBE                                           \
                                          : OPTION_STRING,                                         \
     .value = VALUE_##KIND(CHOICES),                                                               \
     .help = help_},
const Option OPTIONS_OF_PARAMS[] = {
#include "base/params.def"
};
#undef PARAM

// --- Walking over the arguments.

static bool names_equal(const char *a, const char *b)
{
    for (; *a && *b; a++, b++)
        if ((*a == '_' ? '-' : *a) != (*b == '_' ? '-' : *b)) return false;
    return *a == *b;
}

const Option *options_find(const Option *options, size_t count, const char *name)
{
    bool letter = name[0] == '-' && name[1] && name[1] != '-' && !name[2];
    if (strncmp(name, "--", 2) == 0) name += 2;
    for (size_t i = 0; i < count; ++i)
        if (letter ? options[i].letter == name[1] : names_equal(options[i].name, name))
            return &options[i];
    // A parameter of params.def may have a second name.
    const ParamInfo *info = letter ? NULL : params_find(name);
    for (size_t i = 0; info && i < count; ++i)
        if (names_equal(options[i].name, info->name)) return &options[i];
    return NULL;
}

// Options of earlier versions, and what takes their place.
static const struct {
    const char *flag, *instead;
} GONE[] = {{"--chain-bend", "--algo rod bends and twists (--youngs-modulus)"}};

static Result fail_unknown(const OptionsWalk *walk, const char *flag, Error *error)
{
    const char *names[OPTIONS_MOST + 2] = {"help", "version"};
    const char *word = flag + 2;
    assert(walk->option_count <= OPTIONS_MOST);
    bool long_name = strncmp(flag, "--", 2) == 0, negated = long_name && !strncmp(word, "no-", 3);
    for (size_t i = 0; i < sizeof GONE / sizeof *GONE; ++i)
        if (strcmp(flag, GONE[i].flag) == 0)
            return error_set(error, RESULT_USAGE, "%s: no such option any more: %s", flag,
                             GONE[i].instead);
    for (size_t i = 0; i < walk->option_count; ++i) names[i + 2] = walk->options[i].name;
    const char *nearest =
        long_name ? suggest_nearest(word + 3 * negated, names, walk->option_count + 2) : NULL;
    if (!nearest) return error_set(error, RESULT_USAGE, "%s: no such option: see --help", flag);
    char name[NAME_SIZE];
    snprintf(name, sizeof name, "%s%s", negated ? "no-" : "", nearest);
    for (char *at = name; *at; ++at)
        if (*at == '_') *at = '-';
    return error_set(error, RESULT_USAGE, "%s: no such option: did you mean '--%s'?", flag, name);
}

static bool is_number(const char *text)
{
    char *end;
    strtod(text, &end);
    return end != text && !*end;
}

// Takes the next argument as the value, for an option without "=VALUE".
static Result take_value(OptionsWalk *walk, OptionsArgument *argument, Error *error)
{
    const char *next = walk->taken + 1 < walk->argc ? walk->argv[walk->taken + 1] : NULL;
    if (argument->option->kind == OPTION_MAYBE && !(next && is_number(next))) {
        argument->text = "";
        return RESULT_OK;
    }
    if (!next || strncmp(next, "--", 2) == 0)
        return error_set(error, RESULT_USAGE, "%s: no value: expected %s", argument->flag,
                         argument->option->value);
    argument->text = next;
    ++walk->taken;
    return RESULT_OK;
}

static void take_topic(OptionsWalk *walk, OptionsArgument *argument)
{
    argument->found = OPTIONS_HELP;
    if (!argument->text && walk->taken + 1 < walk->argc) argument->text = walk->argv[++walk->taken];
}

static Result take_letter(OptionsWalk *walk, OptionsArgument *argument, Error *error)
{
    const char flag[] = {'-', *walk->letters++, 0};
    snprintf(argument->flag, sizeof argument->flag, "%s", flag);
    if (flag[1] == 'h') {
        take_topic(walk, argument);
        return RESULT_OK;
    }
    argument->option = options_find(walk->options, walk->option_count, flag);
    if (!argument->option) return fail_unknown(walk, flag, error);
    if (!argument->option->value) {
        argument->text = argument->option->kind == OPTION_SWITCH ? "true" : NULL;
        return RESULT_OK;
    }
    argument->text = *walk->letters ? walk->letters : NULL;
    walk->letters = NULL;
    return argument->text ? RESULT_OK : take_value(walk, argument, error);
}

static Result take_flag(OptionsWalk *walk, const char *word, OptionsArgument *argument,
                        Error *error)
{
    const char *equals = strchr(word, '='), *name = argument->flag + 2;
    snprintf(argument->flag, sizeof argument->flag, "%.*s",
             equals ? (int)(equals - word) : (int)strlen(word), word);
    argument->text = equals ? equals + 1 : NULL;
    if (strcmp(name, "help") == 0) {
        take_topic(walk, argument);
        return RESULT_OK;
    }
    bool version = strcmp(name, "version") == 0;
    argument->option = options_find(walk->options, walk->option_count, argument->flag);
    bool negated = !argument->option && strncmp(name, "no-", 3) == 0;
    if (negated) argument->option = options_find(walk->options, walk->option_count, name + 3);
    if (!argument->option && !version) return fail_unknown(walk, argument->flag, error);
    bool is_switch = argument->option && argument->option->kind == OPTION_SWITCH;
    if (negated && !is_switch)
        return error_set(error, RESULT_USAGE, "%s: --%s takes a value: only switches have --no-",
                         argument->flag, name + 3);
    if (equals && (version || negated || (!argument->option->value && !is_switch)))
        return error_set(error, RESULT_USAGE, "%s: got '%s', expected no value", argument->flag,
                         equals + 1);
    if (version) argument->found = OPTIONS_VERSION;
    if (is_switch && !equals) argument->text = negated ? "false" : "true";
    bool missing = !version && argument->option->value && !equals;
    return missing ? take_value(walk, argument, error) : RESULT_OK;
}

Result options_next(OptionsWalk *walk, OptionsArgument *argument, Error *error)
{
    *argument = (OptionsArgument){.found = OPTIONS_OPTION};
    if (walk->letters && *walk->letters) return take_letter(walk, argument, error);
    if (walk->taken + 1 >= walk->argc) {
        argument->found = OPTIONS_END;
        return RESULT_OK;
    }
    const char *word = walk->argv[++walk->taken];
    if (walk->ended || word[0] != '-' || !word[1]) {
        argument->found = OPTIONS_OPERAND;
        argument->text = word;
        return RESULT_OK;
    }
    walk->letters = word[1] == '-' ? NULL : word + 1;
    if (walk->letters) return take_letter(walk, argument, error);
    if (word[2]) return take_flag(walk, word, argument, error);
    walk->ended = true;
    return options_next(walk, argument, error);
}

// --- Setting values.

static Result refuse(const OptionsArgument *argument, const char *expected, const char *nearest,
                     Error *error)
{
    return error_set(error, RESULT_USAGE, "%s: got '%.200s', expected %s%s%s%s", argument->flag,
                     argument->text, expected, nearest ? " (nearest: " : "", nearest ? nearest : "",
                     nearest ? ")" : "");
}

static Result set_number(const OptionsArgument *argument, char *at, Error *error)
{
    const Option *option = argument->option;
    char *end, expected[80];
    double number = strtod(argument->text, &end);
    bool whole = option->kind == OPTION_WHOLE;
    snprintf(expected, sizeof expected, "a %snumber from %.10g to %.10g", whole ? "whole " : "",
             option->least, option->most);
    if (end == argument->text || *end || !(number >= option->least && number <= option->most) ||
        (whole && number != (int)number))
        return refuse(argument, expected, NULL, error);
    int count = (int)number;
    memcpy(at, whole ? (void *)&count : (void *)&number, whole ? sizeof count : sizeof number);
    return RESULT_OK;
}

// Stores the index of the text among the words of "one|two|three".
static Result set_word(const OptionsArgument *argument, char *at, Error *error)
{
    char words[MOST_WORDS * 32], expected[MOST_WORDS * 32] = "";
    const char *names[MOST_WORDS];
    int count = 0;
    size_t length = 0;
    snprintf(words, sizeof words, "%s", argument->option->value);
    for (char *rest = words, *word; count < MOST_WORDS && (word = strsep(&rest, "|"));) {
        if (strcmp(word, argument->text) == 0) {
            memcpy(at, &count, sizeof count);
            return RESULT_OK;
        }
        if (length < sizeof expected)
            length += (size_t)snprintf(expected + length, sizeof expected - length, "%s%s",
                                       count == 0 ? ""
                                       : rest     ? ", "
                                                  : " or ",
                                       word);
        names[count++] = word;
    }
    return refuse(argument, expected, suggest_nearest(argument->text, names, (size_t)count), error);
}

static Result set_option(const OptionsArgument *argument, char *values, Error *error)
{
    const Option *option = argument->option;
    char *at = values + option->place;
    OptionSteps *steps = (OptionSteps *)(void *)at;
    bool on = option->kind == OPTION_SWITCH && strcmp(argument->text, "true") == 0;
    switch (option->kind) {
    case OPTION_SWITCH:
        if (!on && strcmp(argument->text, "false") != 0)
            return refuse(argument, "true or false",
                          suggest_nearest(argument->text, (const char *[]){"true", "false"}, 2),
                          error);
        memcpy(at, &on, sizeof on);
        return RESULT_OK;
    case OPTION_MAYBE:
        memcpy(at, &argument->text, sizeof argument->text);
        return RESULT_OK;
    case OPTION_STRING:
        if (!*argument->text) return refuse(argument, option->value, NULL, error);
        memcpy(at, &argument->text, sizeof argument->text);
        return RESULT_OK;
    case OPTION_WORD:
        return set_word(argument, at, error);
    case OPTION_STEP:
        if (steps->count == OPTION_MOST_STEPS)
            return error_set(error, RESULT_USAGE, "%s: too many steps: expected %d at most",
                             argument->flag, OPTION_MOST_STEPS);
        steps->step[steps->count].option = option;
        steps->step[steps->count++].text = argument->text;
        return RESULT_OK;
    default:
        return set_number(argument, at, error);
    }
}

Result options_parse(const OptionsProgram *program, void *values, int argc, char **argv, int *first,
                     bool *done, Error *error)
{
    OptionsWalk walk = {program->options, program->option_count, argc, argv, 0, NULL, false};
    OptionsArgument argument;
    int operands = 0;
    *done = false;
    for (;;) {
        TRY(options_next(&walk, &argument, error));
        if (argument.found == OPTIONS_END) break;
        *done = argument.found == OPTIONS_HELP || argument.found == OPTIONS_VERSION;
        if (argument.found == OPTIONS_HELP)
            return options_help(program, argument.text, stdout, error);
        if (argument.found == OPTIONS_VERSION) {
            printf("%s %s\n", program->name, TRACTRIX_VERSION);
            return RESULT_OK;
        }
        // Operands are moved to the front, where arguments were already read.
        if (argument.found == OPTIONS_OPERAND)
            argv[1 + operands++] = argv[walk.taken];
        else
            TRY(set_option(&argument, values, error));
    }
    *first = argc - operands;
    memmove(argv + *first, argv + 1, (size_t)operands * sizeof *argv);
    return RESULT_OK;
}
