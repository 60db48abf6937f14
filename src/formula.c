// SPDX-License-Identifier: MIT
#include "formula.h"

#include <muParserDLL.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

static double smoothstep(double a, double b, double x)
{
    double u = fmin(fmax((x - a) / (b - a), 0), 1);
    return u * u * (3 - 2 * u);
}

// muParser prints errors itself unless somebody listens; formula_create asks for them by mupError.
static void stay_silent(muParserHandle_t parser)
{
    (void)parser;
}

// A probe of what the parser lets pass: `1,2` is two values, `t=3` sets the time.
static const char *find_fault(const Formula *formula)
{
    const double probe = 0.25;
    int values = 0;
    *formula->time = probe;
    mupEvalMulti(formula->parser, &values);
    if (mupError(formula->parser)) return mupGetErrorMsg(formula->parser);
    if (values != 1) return "more than one value, and a decimal point is '.'";
    return *formula->time == probe ? NULL : "t is given, it cannot be set";
}

Result formula_create(Formula *formula, const char *text, Error *error)
{
    *formula = (Formula){.text = strdup(text),
                         .parser = mupCreate(muBASETYPE_FLOAT),
                         .time = calloc(1, sizeof *formula->time)};
    if (!formula->text || !formula->parser || !formula->time) {
        formula_destroy(formula);
        return error_set(error, RESULT_FAILED, "out of memory");
    }
    muParserHandle_t parser = formula->parser;
    mupSetErrorHandler(parser, stay_silent);
    mupDefineVar(parser, "t", formula->time);
    mupDefineConst(parser, "pi", 3.14159265358979323846);
    mupDefineFun3(parser, "smoothstep", smoothstep, 1);
    mupSetExpr(parser, text);
    const char *fault = find_fault(formula);
    if (!fault) return RESULT_OK;
    error_set(error, RESULT_BAD_INPUT, "got '%.100s', expected a formula of t: %.200s", text,
              fault);
    formula_destroy(formula);
    return RESULT_BAD_INPUT;
}

void formula_destroy(Formula *formula)
{
    if (formula->parser) mupRelease(formula->parser);
    free(formula->text);
    free(formula->time);
    *formula = (Formula){0};
}

double formula_evaluate(const Formula *formula, double time)
{
    *formula->time = time;
    return mupEval(formula->parser);
}
