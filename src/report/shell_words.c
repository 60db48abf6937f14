// SPDX-License-Identifier: MIT
#include "report/shell_words.h"

#include "base/utf8.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static const char PLAIN[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                            "_-./,:+@%=";

static bool is_printable(const char *word)
{
    for (size_t left = strlen(word), length; left; word += length, left -= length) {
        length = utf8_length(word, left);
        bool control = (unsigned char)*word < 0x20 || *word == 0x7f;
        // C1 controls, U+0080 to U+009F
        control |= length == 2 && word[0] == '\xc2' && (unsigned char)word[1] < 0xa0;
        if (!length || control) return false;
    }
    return true;
}

static void put_escaped(FILE *stream, const char *word)
{
    fputs("$'", stream);
    for (; *word; ++word) {
        unsigned char byte = (unsigned char)*word;
        if (byte == '\'' || byte == '\\')
            fprintf(stream, "\\%c", byte);
        else
            fprintf(stream, byte < 0x20 || byte >= 0x7f ? "\\%03o" : "%c", byte);
    }
    fputc('\'', stream);
}

void shell_put_word(FILE *stream, const char *word)
{
    // zsh expands =NAME at the beginning of a word to a program's path
    if (*word && *word != '=' && strspn(word, PLAIN) == strlen(word)) {
        fputs(word, stream);
    } else if (!is_printable(word)) {
        put_escaped(stream, word);
    } else {
        fputc('\'', stream);
        for (; *word; ++word)
            if (*word == '\'')
                fputs("'\\''", stream);
            else
                fputc(*word, stream);
        fputc('\'', stream);
    }
}

char *shell_join(const char *const *words)
{
    char *text = NULL;
    size_t size;
    FILE *stream = open_memstream(&text, &size);
    if (!stream) return NULL;
    for (size_t i = 0; words[i]; ++i) {
        if (i) fputc(' ', stream);
        shell_put_word(stream, words[i]);
    }
    if (fclose(stream) == 0) return text;
    free(text);
    return NULL;
}

char *shell_join_line(const char *program, int argc, char **argv)
{
    const char **words = calloc((size_t)argc + 2, sizeof *words);
    if (!words) return NULL;
    words[0] = program;
    for (int i = 1; i < argc; ++i) words[i] = argv[i];
    char *line = shell_join(words);
    free(words);
    return line;
}
