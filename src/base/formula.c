// SPDX-License-Identifier: MIT
#include "base/formula.h"

#include "base/portable.h"
#include "base/quote.h"

#include <ctype.h>
#include <muParserDLL.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static double smoothstep(double a, double b, double x)
{
    double u = fmin(fmax((x - a) / (b - a), 0), 1);
    return u * u * (3 - 2 * u);
}

// Without an error handler muParser prints errors itself. formula_create asks for errors by
// mupError.
static void stay_silent(muParserHandle_t parser)
{
    (void)parser;
}

// Describes the parser's error as "reason at character N", N counted from 1. muParser's message has
// its own place (counted from 0, in several forms) and ends with a full stop; both are removed.
static void describe_fault(char *text, size_t size, const Formula *formula)
{
    const char *message = mupGetErrorMsg(formula->parser), *end_of_words = NULL;
    for (const char *const *tail =
             (const char *const[]){" found at position", " at position", NULL};
         *tail && !end_of_words; ++tail)
        end_of_words = strstr(message, *tail);
    char *own = strndup(message, end_of_words ? (size_t)(end_of_words - message) : strlen(message));
    // Leave half of the room for the place.
    quote_line(text, size / 2, own ? own : "out of memory");
    free(own);
    size_t length = strlen(text);
    if (length && text[length - 1] == '.') text[--length] = 0;
    text[0] = (char)tolower((unsigned char)text[0]);
    int place = mupGetErrorPos(formula->parser), end = (int)strlen(formula->text);
    if (place >= 0)
        snprintf(text + length, size - length, " at character %d", (place < end ? place : end) + 1);
}

// Evaluates the formula once to find faults that parsing lets pass: `1,2` has two values, `t=3`
// sets the time. Returns NULL if there are none. `words` is a buffer for the message.
static const char *find_fault(const Formula *formula, char *words, size_t size)
{
    const double probe = 0.25;
    int values = 0;
    for (int i = 0; i < formula->count; i++) formula->value[i] = probe;
    mupEvalMulti(formula->parser, &values);
    if (mupError(formula->parser)) {
        describe_fault(words, size, formula);
        return words;
    }
    if (values != 1) return "more than one value, and a decimal point is '.'";
    for (int i = 0; i < formula->count; i++)
        if (formula->value[i] != probe) return "variables are given, they cannot be set";
    return NULL;
}

static Result fail(Formula *formula, const char *const *names, const char *fault, Error *error)
{
    char list[128] = "";
    for (int i = 0; i < formula->count; i++) {
        size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%s", i ? ", " : "", names[i]);
    }
    error_set(error, RESULT_BAD_INPUT, "got '%.100s', expected a formula of %s: %s", formula->text,
              list, fault);
    formula_destroy(formula);
    return RESULT_BAD_INPUT;
}

Result formula_create_named(Formula *formula, const char *text, const char *const *names, int count,
                            Error *error)
{
    *formula = (Formula){.text = strdup(text),
                         .parser = mupCreate(muBASETYPE_FLOAT),
                         .value = calloc((size_t)count, sizeof *formula->value),
                         .count = count};
    if (!formula->text || !formula->parser || !formula->value) {
        formula_destroy(formula);
        return error_set(error, RESULT_FAILED, "out of memory");
    }
    muParserHandle_t parser = formula->parser;
    mupSetErrorHandler(parser, stay_silent);
    for (int i = 0; i < count; i++) mupDefineVar(parser, names[i], &formula->value[i]);
    mupDefineConst(parser, "pi", M_PI);
    mupDefineFun3(parser, "smoothstep", smoothstep, 1);
    mupDefineFun3(parser, "noise", portable_noise, 1);
    mupSetExpr(parser, text);
    char words[300];
    const char *fault = find_fault(formula, words, sizeof words);
    return fault ? fail(formula, names, fault, error) : RESULT_OK;
}

Result formula_create(Formula *formula, const char *text, Error *error)
{
    static const char *const names[] = {"t"};
    return formula_create_named(formula, text, names, 1, error);
}

void formula_destroy(Formula *formula)
{
    if (formula->parser) mupRelease(formula->parser);
    free(formula->text);
    free(formula->value);
    *formula = (Formula){0};
}

double formula_evaluate(const Formula *formula, double time)
{
    formula->value[0] = time;
    return mupEval(formula->parser);
}

double formula_evaluate_named(const Formula *formula, const double *values)
{
    memcpy(formula->value, values, (size_t)formula->count * sizeof *values);
    return mupEval(formula->parser);
}
