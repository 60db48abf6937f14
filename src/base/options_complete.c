// SPDX-License-Identifier: MIT
#include "base/options_complete.h"

#include "base/colors.h"

#include <ctype.h>
#include <string.h>

enum { NAME_SIZE = 80, WORDS_SIZE = 1200, CLAUSE_SIZE = 200 };

// The kind of value that follows an option.
typedef enum ValueKind {
    VALUE_NONE,
    VALUE_WORDS,
    VALUE_FILES,
    VALUE_FOLDERS,
    VALUE_TEXT,
} ValueKind;

// --- Names and words for the scripts of all shells.

static const Option *option_at(const OptionsProgram *program, size_t i)
{
    size_t own = program->option_count;
    return i < own ? &program->options[i] : &OPTIONS_COMMON[i - own];
}

static size_t count_options(const OptionsProgram *program)
{
    return program->option_count + OPTIONS_COMMON_COUNT;
}

// Turns camera_up into "camera-up".
static void write_name(char *text, size_t size, const char *name)
{
    snprintf(text, size, "%s", name);
    for (char *at = text; *at; ++at)
        if (*at == '_') *at = '-';
}

// The name of the shell function, "_tractrix-gen-fur". It follows the manual page's name, because
// zsh looks for a file with the function's name.
static void write_function(char *text, size_t size, const OptionsProgram *program)
{
    snprintf(text, size, "_%s", program->page ? program->page : program->name);
}

static void add_word(char *words, const char *word, size_t word_length)
{
    size_t length = strlen(words);
    if (length + word_length + 2 < WORDS_SIZE)
        snprintf(words + length, WORDS_SIZE - length, "%s%.*s", length ? " " : "", (int)word_length,
                 word);
}

static bool is_small(const char *word, size_t length)
{
    for (size_t i = 0; i < length; ++i)
        if (isupper((unsigned char)word[i]) || !(isalnum((unsigned char)word[i]) || word[i] == '-'))
            return false;
    return length > 0;
}

// Adds the lower-case words of "one|two|N".
static void add_choices(char *words, const char *value)
{
    if (!strchr(value, '|')) return;
    for (;; ++value) {
        size_t length = strcspn(value, "|");
        if (is_small(value, length)) add_word(words, value, length);
        value += length;
        if (!*value) return;
    }
}

// Adds the topics of --help.
static void add_topics(char *words, const OptionsProgram *program)
{
    static const char *const OWN[] = {"all", "man", "markdown", "bash", "zsh", "fish"};
    for (size_t i = 0; i < sizeof OWN / sizeof *OWN; ++i) add_word(words, OWN[i], strlen(OWN[i]));
    for (const char *const(*t)[2] = program->topics; t && (*t)[0]; ++t)
        add_word(words, (*t)[0], strlen((*t)[0]));
    for (const OptionsChapter *const *c = program->chapters; c && *c; ++c)
        add_word(words, (*c)->topic, strlen((*c)->topic));
}

// The kind of the option's value. For VALUE_WORDS, `words` receives the words, separated by blanks.
static ValueKind find_value(const OptionsProgram *program, const Option *option, char *words)
{
    const char *value = option->value;
    words[0] = 0;
    if (!value) return VALUE_NONE;
    if (option == &OPTIONS_COMMON[0]) add_topics(words, program);
    add_choices(words, value);
    for (size_t i = 0; strstr(value, "COLOR") && i < COLOR_NAME_COUNT; ++i)
        add_word(words, COLOR_NAMES[i].name, strlen(COLOR_NAMES[i].name));
    if (strcmp(value, "UNIT") == 0) snprintf(words, WORDS_SIZE, "auto m cm mm in");
    if (*words) return VALUE_WORDS;
    if (strstr(value, "FILE") || strstr(value, "PATH")) return VALUE_FILES;
    return strstr(value, "DIR") ? VALUE_FOLDERS : VALUE_TEXT;
}

// Whether the switch can be negated by "--no-NAME". Not if the table has an option of that name.
static bool has_negation(const OptionsProgram *program, const Option *option)
{
    char name[NAME_SIZE];
    snprintf(name, sizeof name, "no-%s", option->name);
    return option->kind == OPTION_SWITCH && option != &OPTIONS_COMMON[1] &&
           !options_find(program->options, program->option_count, name);
}

// Shortens the help to its first clause, because lists of completions have little room. A single
// word before a colon does not count as a clause: "fur: short hair".
static void write_clause(char clause[CLAUSE_SIZE], const char *help)
{
    static const char *const ENDS[] = {"; ", ": ", " ["};
    if (strncmp(help, "* ", 2) == 0 || strncmp(help, "+ ", 2) == 0) help += 2;
    size_t length = strlen(help);
    for (size_t i = 0; i < sizeof ENDS / sizeof *ENDS; ++i) {
        const char *end = strstr(help, ENDS[i]);
        size_t before = end ? (size_t)(end - help) : length;
        if (before > 0 && before < length && (ENDS[i][0] != ':' || before > strcspn(help, " ")))
            length = before;
    }
    snprintf(clause, CLAUSE_SIZE, "%.*s", (int)length, help);
}

// Writes `text` with a backslash before each character of `special`, inside single quotes of bash
// or zsh.
static void put_escaped(FILE *stream, const char *text, const char *special)
{
    for (; *text; ++text) {
        if (*text == '\'')
            fputs("'\\''", stream);
        else
            fprintf(stream, strchr(special, *text) ? "\\%c" : "%c", *text);
    }
}

// --- bash

static void put_bash_value(FILE *stream, const OptionsProgram *program, const Option *option)
{
    char name[NAME_SIZE], words[WORDS_SIZE];
    ValueKind kind = find_value(program, option, words);
    if (kind == VALUE_NONE) return;
    write_name(name, sizeof name, option->name);
    fprintf(stream, "    ");
    if (option->letter) fprintf(stream, "-%c|", option->letter);
    fprintf(stream, "--%s) ", name);
    if (kind == VALUE_WORDS) fprintf(stream, "_tractrix_words '%s'", words);
    if (kind == VALUE_FILES) fprintf(stream, "_tractrix_files -f");
    if (kind == VALUE_FOLDERS) fprintf(stream, "_tractrix_files -d");
    fprintf(stream, "%s;;\n", kind == VALUE_TEXT ? "" : " ");
}

static void put_bash_names(FILE *stream, const OptionsProgram *program, bool negations)
{
    char name[NAME_SIZE];
    bool any = false;
    for (size_t i = 0; i < count_options(program); ++i) {
        const Option *option = option_at(program, i);
        if (negations && !has_negation(program, option)) continue;
        write_name(name, sizeof name, option->name);
        if (!negations && option->letter)
            fprintf(stream, "%s-%c", any ? " " : "", option->letter), any = true;
        fprintf(stream, "%s--%s%s", any ? " " : "", negations ? "no-" : "", name);
        any = true;
    }
}

static void put_bash(FILE *stream, const OptionsProgram *program)
{
    char function[NAME_SIZE], below[NAME_SIZE];
    write_function(function, sizeof function, program);
    if (program->sub) put_bash(stream, program->sub);
    // bash splits words at '=', so --flag=value arrives as three words.
    fprintf(
        stream,
        "%s() {\n"
        "    local word=${COMP_WORDS[COMP_CWORD]} flag=${COMP_WORDS[COMP_CWORD - 1]}\n"
        "    [[ $word == = ]] && word=\n"
        "    [[ $flag == = ]] && flag=${COMP_WORDS[COMP_CWORD - 2]}\n"
        "    _tractrix_words() { mapfile -t COMPREPLY < <(compgen -W \"$1\" -- \"$word\"); }\n"
        "    _tractrix_files() { compopt -o filenames; mapfile -t COMPREPLY < <(compgen \"$1\" -- "
        "\"$word\"); }\n"
        "    COMPREPLY=()\n",
        function);
    if (program->sub) {
        write_function(below, sizeof below, program->sub);
        fprintf(stream,
                "    if ((COMP_CWORD > 1)) && [[ ${COMP_WORDS[1]} == %s ]]; then\n"
                "        %s; return\n    fi\n",
                program->sub_word, below);
    }
    fprintf(stream, "    case $flag in\n");
    for (size_t i = 0; i < count_options(program); ++i)
        put_bash_value(stream, program, option_at(program, i));
    fprintf(stream, "    *) case $word in\n        --no-*) _tractrix_words '");
    put_bash_names(stream, program, false);
    fputc(' ', stream);
    put_bash_names(stream, program, true);
    fprintf(stream, "' ;;\n        -*) _tractrix_words '");
    put_bash_names(stream, program, false);
    fprintf(stream, "' ;;\n        *) ");
    if (program->commands) {
        fprintf(stream, "if ((COMP_CWORD == 1)); then _tractrix_words '");
        for (const char *const(*c)[2] = program->commands; c && (*c)[0]; ++c)
            fprintf(stream, "%s%s", c == program->commands ? "" : " ", (*c)[0]);
        fprintf(stream, "'; else _tractrix_files -f; fi ;;\n");
    } else {
        fprintf(stream, "_tractrix_files -f ;;\n");
    }
    fprintf(stream, "        esac ;;\n    esac\n}\n");
}

// --- zsh

static const char ZSH_SPECIAL[] = "\\[]:";

// The message "NAME" or "X,Y,Z", which _arguments shows if it cannot complete, and the action.
static void put_zsh_value(FILE *stream, const OptionsProgram *program, const Option *option)
{
    char words[WORDS_SIZE];
    ValueKind kind = find_value(program, option, words);
    if (kind == VALUE_NONE) return;
    fprintf(stream, option->kind == OPTION_MAYBE ? "::" : ":");
    put_escaped(stream, strchr(option->value, '|') ? "value" : option->value, ZSH_SPECIAL);
    if (kind == VALUE_WORDS) fprintf(stream, ":(%s)", words);
    if (kind == VALUE_FILES) fprintf(stream, ":_files");
    if (kind == VALUE_FOLDERS) fprintf(stream, ":_files -/");
    if (kind == VALUE_TEXT) fprintf(stream, ": ");
}

static void put_zsh_spec(FILE *stream, const OptionsProgram *program, const Option *option,
                         bool negation)
{
    char name[NAME_SIZE], clause[CLAUSE_SIZE];
    write_name(name, sizeof name, option->name);
    write_clause(clause, option->help);
    for (int letter = option->letter && !negation ? 1 : 0; letter >= 0; --letter) {
        fprintf(stream, "        '");
        if (letter)
            fprintf(stream, "-%c%s", option->letter, option->value ? "+" : "");
        else
            fprintf(stream, "--%s%s%s", negation ? "no-" : "", name, option->value ? "=" : "");
        fprintf(stream, negation ? "[off\\: " : "[");
        put_escaped(stream, clause, ZSH_SPECIAL);
        fputc(']', stream);
        put_zsh_value(stream, program, option);
        fprintf(stream, "'\n");
    }
}

static void put_zsh_function(FILE *stream, const OptionsProgram *program)
{
    char function[NAME_SIZE], below[NAME_SIZE];
    write_function(function, sizeof function, program);
    if (program->sub) put_zsh_function(stream, program->sub);
    fprintf(stream, "%s() {\n", function);
    if (program->sub) {
        write_function(below, sizeof below, program->sub);
        fprintf(stream,
                "    if ((CURRENT > 2)) && [[ $words[2] == %s ]]; then\n"
                "        shift words; ((--CURRENT)); %s; return\n    fi\n",
                program->sub_word, below);
    }
    fprintf(stream, "    local -a specs=(\n");
    for (size_t i = 0; i < count_options(program); ++i)
        put_zsh_spec(stream, program, option_at(program, i), false);
    fprintf(stream, "    )\n    [[ $PREFIX == --no-* ]] && specs+=(\n");
    for (size_t i = 0; i < count_options(program); ++i)
        if (has_negation(program, option_at(program, i)))
            put_zsh_spec(stream, program, option_at(program, i), true);
    fprintf(stream, "    )\n    _arguments -s -S $specs");
    if (program->commands) {
        fprintf(stream, " \\\n        '1:command:((");
        for (const char *const(*c)[2] = program->commands; c && (*c)[0]; ++c) {
            char clause[CLAUSE_SIZE];
            write_clause(clause, (*c)[1]);
            fprintf(stream, "%s%s\\:\"", c == program->commands ? "" : " ", (*c)[0]);
            put_escaped(stream, clause, "\\\":");
            fprintf(stream, "\"");
        }
        fprintf(stream, "))'");
    }
    // A program that passes its options on to this one adds its own specs.
    fprintf(stream, " \\\n        \"${@:-*:file:_files}\"\n}\n");
}

// --- fish

static void put_fish_text(FILE *stream, const char *text)
{
    for (; *text; ++text) fprintf(stream, *text == '\'' || *text == '\\' ? "\\%c" : "%c", *text);
}

// The beginning of every line: "complete -c tractrix-gen -n 'condition'".
static void put_fish_start(FILE *stream, const OptionsProgram *program, const char *condition)
{
    fprintf(stream, "complete -c %s", program->name);
    if (*condition) fprintf(stream, " -n '%s'", condition);
}

static void put_fish_option(FILE *stream, const OptionsProgram *program, const Option *option,
                            const char *condition)
{
    char name[NAME_SIZE], clause[CLAUSE_SIZE], words[WORDS_SIZE];
    ValueKind kind = find_value(program, option, words);
    write_name(name, sizeof name, option->name);
    write_clause(clause, option->help);
    put_fish_start(stream, program, condition);
    if (option->letter) fprintf(stream, " -s %c", option->letter);
    fprintf(stream, " -l %s", name);
    bool maybe = option->kind == OPTION_MAYBE;
    if (kind == VALUE_WORDS) fprintf(stream, " -x -a '%s'", words);
    if (kind == VALUE_FILES) fprintf(stream, " -r -F");
    if (kind == VALUE_FOLDERS) fprintf(stream, " -x -a '(__fish_complete_directories)'");
    if (kind == VALUE_TEXT && !maybe) fprintf(stream, " -x");
    fprintf(stream, " -d '");
    put_fish_text(stream, clause);
    fprintf(stream, "'\n");
}

static void put_fish(FILE *stream, const OptionsProgram *program, const char *condition)
{
    char here[NAME_SIZE * 2], clause[CLAUSE_SIZE], name[NAME_SIZE];
    if (program->sub) {
        snprintf(here, sizeof here, "__fish_seen_subcommand_from %s", program->sub_word);
        put_fish(stream, program->sub, here);
        snprintf(here, sizeof here, "not __fish_seen_subcommand_from %s", program->sub_word);
        condition = here;
    }
    for (const char *const(*c)[2] = program->commands; c && (*c)[0]; ++c) {
        write_clause(clause, (*c)[1]);
        put_fish_start(stream, program, "__fish_is_first_token");
        fprintf(stream, " -a %s -d '", (*c)[0]);
        put_fish_text(stream, clause);
        fprintf(stream, "'\n");
    }
    for (size_t i = 0; i < count_options(program); ++i)
        put_fish_option(stream, program, option_at(program, i), condition);
    for (size_t i = 0; i < count_options(program); ++i) {
        const Option *option = option_at(program, i);
        if (!has_negation(program, option)) continue;
        write_name(name, sizeof name, option->name);
        write_clause(clause, option->help);
        fprintf(stream, "complete -c %s -n '%s%sstring match -q -- \"--no-*\" (commandline -ct)'",
                program->name, condition, *condition ? "; and " : "");
        fprintf(stream, " -l no-%s -d 'off: ", name);
        put_fish_text(stream, clause);
        fprintf(stream, "'\n");
    }
}

bool options_complete(const OptionsProgram *program, const char *shell, FILE *stream)
{
    char function[NAME_SIZE];
    bool bash = strcmp(shell, "bash") == 0, zsh = strcmp(shell, "zsh") == 0;
    if (!bash && !zsh && strcmp(shell, "fish") != 0) return false;
    write_function(function, sizeof function, program);
    if (zsh) fprintf(stream, "#compdef %s\n", program->name);
    fprintf(stream, "# Completion of %s in %s, made by %s --help=%s.\n", program->name, shell,
            program->name, shell);
    if (bash) {
        put_bash(stream, program);
        fprintf(stream, "complete -F %s %s\n", function, program->name);
    } else if (zsh) {
        // If zsh loads the file from $fpath, the file is the function's body and must call it; if
        // it is read by `source`, it only registers the function.
        put_zsh_function(stream, program);
        fprintf(stream, "if [[ $funcstack[1] == %s ]]; then %s \"$@\"; else compdef %s %s; fi\n",
                function, function, function, program->name);
    } else {
        put_fish(stream, program, "");
    }
    return true;
}
