// SPDX-License-Identifier: MIT
// The room base: what every other room stands on. It takes nothing of this project and hands on
// results and errors (this file), files whole or in chunks (bytes.h, outfile.h, chunk.h, reader.h,
// csv.h, json.h, leftovers.h), text (decimal.h, suggest.h), the table of parameters (params.h), the
// command line of all programs (options.h, program.h), numbers that are the same on every machine
// (random.h, portable.h, double3.h), threads and vectors (parallel.h, simd.h).
//
// This file: how every function reports failure: a Result and, with it, one line of text.
#pragma once

#include <stdarg.h>

// What went wrong, by kind. The values are the programs' exit statuses, so that `main` returns
// them.
typedef enum Result {
    RESULT_OK = 0,
    RESULT_FAILED = 1,        // at run time: disk full, out of memory, ffmpeg died, ...
    RESULT_USAGE = 2,         // the command line or a parameter is wrong
    RESULT_BAD_INPUT = 3,     // a file's content is wrong
    RESULT_NO_GL = 4,         // no usable OpenGL
    RESULT_INTERRUPTED = 130, // SIGINT, SIGTERM or SIGHUP
} Result;

// One line for the user: what, where, what was expected. No newline, no trailing full stop.
typedef struct Error {
    char text[1024];
} Error;

// Writes the line (printf style; whatever bytes the arguments have it stays a line, shortened in
// the middle where it is too long: quote.h) and returns `result`, so that failing reads `return
// error_set(error, RESULT_BAD_INPUT, "%s: byte %zu: ...", path, at);`. `error` may be NULL.
Result error_set(Error *error, Result result, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

// Puts a prefix (printf style) before the text that is already there; returns `result`.
Result error_prefix(Error *error, Result result, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

// Static analysers look at one file at a time: without this they follow paths on which a failure
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

// Leaves the function with the call's result unless it is RESULT_OK. For functions that have
// nothing to clean up on that way; those that have say THEN.
#define TRY(call)                                                                                  \
    do {                                                                                           \
        Result try_result = (call);                                                                \
        if (try_result != RESULT_OK) return try_result;                                            \
    } while (0)

// result = call, unless an earlier call of the chain has failed: what follows cleans up either way.
#define THEN(result, call)                                                                         \
    do {                                                                                           \
        if ((result) == RESULT_OK) (result) = (call);                                              \
    } while (0)
