// SPDX-License-Identifier: MIT
#include "base/json_write.h"
#include "base/outfile.h"

#include <stdlib.h>

Result json_write_file(const json_t *value, const char *path, Error *error)
{
    char *text = value ? json_dumps(value, JSON_INDENT(2) | JSON_REAL_PRECISION(9)) : NULL;
    if (!text) return error_set(error, RESULT_FAILED, "%s: no memory for the result", path);
    OutFile file;
    Result result = outfile_open(&file, path, error);
    if (result == RESULT_OK) {
        fprintf(file.stream, "%s\n", text);
        result = outfile_commit(&file, error);
    }
    free(text);
    return result;
}
