// SPDX-License-Identifier: MIT
// Where the hair that tractrix-gen makes goes: what its commands share of options and words.
#pragma once

#include "base/options.h"
#include "strands/strands_write.h"

typedef struct GenOutput {
    const char *path; // NULL: not given
    int format;       // as --format counts them
    bool quiet;
} GenOutput;

enum { GEN_OUTPUT_TFX4 = 2 }; // the default format

// Rows of an option table; `at` is the offset of a GenOutput's member, or of an int, in the
// command's struct.
#define GEN_OPTION_OUTPUT(at)                                                                      \
    {                                                                                              \
        "output", 'o', OPTION_STRING, at, "FILE", 0, 0, "the hair"                                 \
    }
#define GEN_OPTION_FORMAT(at)                                                                      \
    {                                                                                              \
        "format", 0, OPTION_WORD, at, "text|tfx3|tfx4|hair", 0, 0,                                 \
            "TressFX 2 text, TressFX binary or HAIR [default tfx4]"                                \
    }
#define GEN_OPTION_SEED(at)                                                                        \
    {                                                                                              \
        "seed", 0, OPTION_WHOLE, at, "N", 0, 2147483647, "of all that is random [default 1]"       \
    }
#define GEN_OPTION_QUIET(at)                                                                       \
    {                                                                                              \
        "quiet", 'q', OPTION_SWITCH, at, NULL, 0, 0, "print nothing"                               \
    }

// What --format asks for.
StrandsKind gen_output_kind(const GenOutput *output);

// Writes strands of one size to output->path and, unless quiet, tells so on the standard output;
// `guides` of them are guides, 0: none to speak of. Errors of strands_write.
Result gen_output_write(const GenOutput *output, const Strands *strands, uint32_t guides,
                        Error *error);
