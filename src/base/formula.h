// SPDX-License-Identifier: MIT
// A formula for a number: of the time t in seconds, or of other variables.
#pragma once

#include "base/error.h"

#include <stdbool.h>

// A zeroed struct has no formula.
typedef struct Formula {
    char *text;    // as written, owned; NULL if there is none
    void *parser;  // muParser's
    double *value; // variables of the parser, owned
    int count;
} Formula;

// Parses `text`: numbers, t, pi, + - * / ^ ( ), comparisons, && || and a ? b : c, the functions of
// muParser (sin, cos, tan, asin, acos, atan, atan2, exp, ln, sqrt, abs, sign, rint, min, max ...),
// smoothstep(a, b, x), which rises from 0 at x = a to 1 at x = b, and noise(x, y, z) (portable.h).
// RESULT_BAD_INPUT with the error and its place in the text, RESULT_FAILED when memory is short.
Result formula_create(Formula *formula, const char *text, Error *error);

// The same for `count` variables instead of t, 1 to 16.
Result formula_create_named(Formula *formula, const char *text, const char *const *names, int count,
                            Error *error);
void formula_destroy(Formula *formula);

// The value at `time` (s). It may be infinite or NaN, like 1/t at 0. Not thread-safe.
double formula_evaluate(const Formula *formula, double time);

// The value for these values of the variables.
double formula_evaluate_named(const Formula *formula, const double *values);
