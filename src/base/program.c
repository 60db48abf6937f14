// SPDX-License-Identifier: MIT
#include "base/program.h"

#include <stdbool.h>
#include <stdio.h>

int program_end(const char *name, Result result, Error *error)
{
    bool told = result != RESULT_OK && error->text[0];
    bool lost = fflush(stdout) != 0 || ferror(stdout);
    if (lost && !told) result = error_set(error, RESULT_FAILED, "cannot write to standard output");
    if (result == RESULT_BAD_INPUT && error->text[0])
        fprintf(stderr, "%s\n", error->text);
    else if (result != RESULT_OK && error->text[0])
        fprintf(stderr, "%s: %s\n", name, error->text);
    return result;
}
