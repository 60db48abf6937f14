// SPDX-License-Identifier: MIT
// Where the hair that tractrix-gen makes goes: what its commands share of options and words.
#pragma once

#include "base/options.h"
#include "strands/formats/format.h"

typedef struct GenOutput {
    const char *path; // NULL: not given
    int format;       // a FormatKind
    bool quiet;
} GenOutput;

// Rows of an option table; `at` is the offset of a GenOutput's member, or of an int, in the
// command's struct.
#define GEN_OPTION_OUTPUT(at)                                                                      \
    {                                                                                              \
        "output", 'o', OPTION_STRING, at, "FILE", 0, 0, "hair file to write"                       \
    }
#define GEN_OPTION_FORMAT(at)                                                                      \
    {                                                                                              \
        "format", 0, OPTION_WORD, at, &(FORMAT_WORDS)[1], 0, 0,                                    \
            "format of FILE, whatever its name [default tfx4]"                                     \
    }
#define GEN_OPTION_SEED(at)                                                                        \
    {                                                                                              \
        "seed", 0, OPTION_WHOLE, at, "N", 0, 2147483647, "start of all random numbers [default 1]" \
    }
#define GEN_OPTION_QUIET(at)                                                                       \
    {                                                                                              \
        "quiet", 'q', OPTION_SWITCH, at, NULL, 0, 0, "print nothing"                               \
    }

// Writes strands of one size to output->path and, unless quiet, tells so on the standard output;
// `guides` of them are guides, 0: none to speak of. Errors as format_write.
Result gen_output_write(const GenOutput *output, const Strands *strands, uint32_t guides,
                        Error *error);
