// SPDX-License-Identifier: MIT
// A number that changes over time, written as a formula of the time t in seconds.
#pragma once

#include "error.h"

#include <stdbool.h>

// A zeroed formula is none.
typedef struct Formula {
    char *text;   // as written, owned; NULL: none
    void *parser; // muParser's
    double *time; // what the parser reads as t
} Formula;

// Reads `text`: numbers, t, pi, + - * / ^ ( ), comparisons, && || and a ? b : c, and the functions
// of muParser (sin, cos, tan, asin, acos, atan, atan2, exp, ln, sqrt, abs, sign, rint, min, max
// ...) and smoothstep(a, b, x), which rises from 0 at x = a to 1 at x = b. RESULT_BAD_INPUT saying
// what is wrong and where in the text, RESULT_FAILED when memory is short.
Result formula_create(Formula *formula, const char *text, Error *error);
void formula_destroy(Formula *formula);

// The value at `time` (s). May be infinite or NaN, as in 1/t at 0. Not for two threads at once.
double formula_evaluate(const Formula *formula, double time);
