// SPDX-License-Identifier: MIT
#include "base/completion.h"

#include <ctype.h>
#include <stdbool.h>
#include <string.h>

// The parts of "-j, --jobs N"; `value` is empty if there is none.
typedef struct Flag {
    char letter;
    const char *name;
    int name_length;
    const char *value;
} Flag;

static Flag take_apart(const char *text)
{
    Flag flag = {.letter = text[0] == '-' && text[1] != '-' ? text[1] : 0};
    flag.name = flag.letter ? text + strlen("-j, ") : text;
    flag.name_length = (int)strcspn(flag.name, " ");
    flag.value = flag.name + flag.name_length;
    flag.value += *flag.value == ' ';
    return flag;
}

// "--jobs", or "-j|--jobs" with `between` behind the letter.
static void write_names(FILE *stream, const Flag *flag, const char *between)
{
    if (flag->letter) fprintf(stream, "-%c%s", flag->letter, between);
    fprintf(stream, "%.*s", flag->name_length, flag->name);
}

static bool is_word(const char *text, size_t length)
{
    for (size_t i = 0; i < length; ++i)
        if (isupper((unsigned char)text[i]) || !(isalnum((unsigned char)text[i]) || text[i] == '-'))
            return false;
    return length > 0;
}

// The small words among a value's alternatives, with blanks between them; whether there are any.
static bool write_words(FILE *stream, const char *value)
{
    bool any = false;
    while (*value) {
        size_t length = strcspn(value, "|");
        if (is_word(value, length)) {
            if (stream) fprintf(stream, "%s%.*s", any ? " " : "", (int)length, value);
            any = true;
        }
        value += length + (value[length] == '|');
    }
    return any;
}

static bool is_path(const char *value)
{
    return strstr(value, "FILE") || strstr(value, "DIR") || strstr(value, "PATH");
}

static void write_values(FILE *stream, const Flag *flag)
{
    if (!*flag->value) return;
    fprintf(stream, "    ");
    write_names(stream, flag, "|");
    if (write_words(NULL, flag->value)) {
        fprintf(stream, ") mapfile -t COMPREPLY < <(compgen -W '");
        write_words(stream, flag->value);
        fprintf(stream, "' -- \"$word\") ;;\n");
    } else if (is_path(flag->value)) {
        fprintf(stream, ") files ;;\n");
    } else {
        fprintf(stream, ") ;;\n");
    }
}

void completion_write_bash(FILE *stream, const char *program, const char *const *flags,
                           size_t flag_count)
{
    fprintf(stream, "# Completion of %s in bash, made by %s --help=bash.\n", program, program);
    fprintf(stream, "_");
    for (const char *at = program; *at; ++at) fputc(*at == '-' ? '_' : *at, stream);
    // bash ends words at '=': --flag=value comes as three.
    fprintf(stream, "() {\n"
                    "    local word=${COMP_WORDS[COMP_CWORD]} flag=${COMP_WORDS[COMP_CWORD - 1]}\n"
                    "    [[ $word == = ]] && word=\n"
                    "    [[ $flag == = ]] && flag=${COMP_WORDS[COMP_CWORD - 2]}\n"
                    "    files() { compopt -o filenames; mapfile -t COMPREPLY < <(compgen -f -- "
                    "\"$word\"); }\n"
                    "    COMPREPLY=()\n"
                    "    case $flag in\n");
    for (size_t i = 0; i < flag_count; ++i) {
        Flag flag = take_apart(flags[i]);
        write_values(stream, &flag);
    }
    fprintf(stream, "    *) if [[ $word == -* ]]; then mapfile -t COMPREPLY < <(compgen -W '");
    for (size_t i = 0; i < flag_count; ++i) {
        Flag flag = take_apart(flags[i]);
        fprintf(stream, "%s", i ? " " : "");
        write_names(stream, &flag, " ");
    }
    fprintf(stream, "' -- \"$word\"); else files; fi ;;\n    esac\n}\ncomplete -F _");
    for (const char *at = program; *at; ++at) fputc(*at == '-' ? '_' : *at, stream);
    fprintf(stream, " %s\n", program);
}
