// SPDX-License-Identifier: MIT
#include "gpu/assume.h"

#include "base/quote.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char VARIABLE[] = "TRACTRIX_ASSUME";

// Whether the word is NAME=N with N from 1 to `most`; stores N in *value.
static bool is_number(const char *word, const char *name, long most, int *value)
{
    char *end;
    size_t length = strlen(name);
    if (strncmp(word, name, length) != 0 || word[length] != '=') return false;
    long number = strtol(word + length + 1, &end, 10);
    if (*end || number < 1 || number > most) return false;
    *value = (int)number;
    return true;
}

static bool take_word(Assumptions *assumptions, const char *word)
{
    if (strcmp(word, "hardware") == 0) return assumptions->hardware = true;
    return is_number(word, "groups", 65535, &assumptions->groups) ||
           is_number(word, "side", 1 << 20, &assumptions->side_px) ||
           is_number(word, "ulps", 1 << 20, &assumptions->ulps);
}

Result assumptions_read(Assumptions *assumptions, Error *error)
{
    char words[256], *rest = words;
    const char *text = getenv(VARIABLE);
    *assumptions = (Assumptions){0};
    if (!text) return RESULT_OK;
    snprintf(words, sizeof words, "%s", text);
    for (char *word = strtok_r(words, " ", &rest); word; word = strtok_r(NULL, " ", &rest))
        if (!take_word(assumptions, word))
            return error_set(error, RESULT_USAGE,
                             "%s: got '%s', expected hardware, groups=N, side=N or ulps=N",
                             VARIABLE, quote(word).text);
    return RESULT_OK;
}

static Result assume_hardware(Error *error)
{
    char words[256];
    const char *text = getenv(VARIABLE);
    snprintf(words, sizeof words, "hardware %s", text ? text : "");
    if (setenv(VARIABLE, words, 1) == 0) return RESULT_OK;
    return error_set(error, RESULT_FAILED, "--assume-hardware: no memory");
}

Result assumptions_take_option(int *argc, char **argv, Error *error)
{
    for (int i = 1; i < *argc && strcmp(argv[i], "--") != 0; ++i) {
        if (strcmp(argv[i], "--assume-hardware") != 0) continue;
        // Including the NULL at the end.
        memmove(&argv[i], &argv[i + 1], (size_t)(*argc - i) * sizeof *argv);
        --*argc;
        return assume_hardware(error);
    }
    return RESULT_OK;
}
