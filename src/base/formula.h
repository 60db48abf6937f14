// SPDX-License-Identifier: MIT
// A number that changes over time, written as a formula of the time t in seconds; or a number that
// is a formula of other variables.
#pragma once

#include "base/error.h"

#include <stdbool.h>

// A zeroed formula is none.
typedef struct Formula {
    char *text;    // as written, owned; NULL: none
    void *parser;  // muParser's
    double *value; // what the parser reads as variables, owned
    int count;
} Formula;

// Reads `text`: numbers, t, pi, + - * / ^ ( ), comparisons, && || and a ? b : c, and the functions
// of muParser (sin, cos, tan, asin, acos, atan, atan2, exp, ln, sqrt, abs, sign, rint, min, max
// ...), smoothstep(a, b, x), which rises from 0 at x = a to 1 at x = b, and noise(x, y, z)
// (portable.h). RESULT_BAD_INPUT saying what is wrong and where in the text, RESULT_FAILED when
// memory is short.
Result formula_create(Formula *formula, const char *text, Error *error);

// The same of `count` variables instead of t, 1 to 16.
Result formula_create_named(Formula *formula, const char *text, const char *const *names, int count,
                            Error *error);
void formula_destroy(Formula *formula);

// The value at `time` (s). May be infinite or NaN, as in 1/t at 0. Not for two threads at once.
double formula_evaluate(const Formula *formula, double time);

// The value where the variables have these.
double formula_evaluate_named(const Formula *formula, const double *values);
