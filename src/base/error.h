// SPDX-License-Identifier: MIT
// The room base: foundations for all other rooms. It uses nothing of this project, and provides
// results and errors (this file), files as a whole or in chunks (bytes.h, outfile.h, chunk.h,
// reader.h, csv.h, json.h, leftovers.h), text (decimal.h, suggest.h), the table of parameters
// (params.h), the command line of all programs (options.h, program.h), numbers that are the same on
// every machine (random.h, portable.h, double3.h), threads and vectors (parallel.h, simd.h).
//
// This file: how every function reports failure, by a Result and one line of text.
#pragma once

#include <stdarg.h>

// Kinds of failure. The values are the programs' exit statuses.
typedef enum Result {
    RESULT_OK = 0,
    RESULT_FAILED = 1,        // at run time: disk full, out of memory, ffmpeg died, ...
    RESULT_USAGE = 2,         // the command line or a parameter is wrong
    RESULT_BAD_INPUT = 3,     // a file's content is wrong
    RESULT_NO_GL = 4,         // no usable OpenGL
    RESULT_INTERRUPTED = 130, // SIGINT, SIGTERM or SIGHUP
} Result;

// One line for the user: where, what is wrong, what was expected. No newline, no full stop at the
// end.
typedef struct Error {
    char text[1024];
} Error;

// Writes the line (printf style) and returns `result`, so that a failure reads `return
// error_set(error, RESULT_BAD_INPUT, "%s: byte %zu: ...", path, at);`. Whatever bytes the arguments
// contain, it stays one line, shortened in the middle if it is too long (quote.h). `error` may be
// NULL.
Result error_set(Error *error, Result result, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

// Puts a prefix (printf style) before the existing text; returns `result`.
Result error_prefix(Error *error, Result result, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

// Static analysers look at one file at a time. Without this, they follow paths on which a failure
// returns RESULT_OK.
#if defined __clang_analyzer__ || defined TRACTRIX_ANALYZER
#define RETURNS_RESULT(function, error, result, ...)                                               \
    __extension__({                                                                                \
        Result returned = (result);                                                                \
        function(error, returned, __VA_ARGS__);                                                    \
        returned;                                                                                  \
    })
#define error_set(...)    RETURNS_RESULT((error_set), __VA_ARGS__)
#define error_prefix(...) RETURNS_RESULT((error_prefix), __VA_ARGS__)
#endif

// Returns the call's result unless it is RESULT_OK. For functions that need no clean-up on that
// path; others use THEN.
#define TRY(call)                                                                                  \
    do {                                                                                           \
        Result try_result = (call);                                                                \
        if (try_result != RESULT_OK) return try_result;                                            \
    } while (0)

// result = call, unless an earlier call of the chain failed. The code after the chain cleans up in
// either case.
#define THEN(result, call)                                                                         \
    do {                                                                                           \
        if ((result) == RESULT_OK) (result) = (call);                                              \
    } while (0)
