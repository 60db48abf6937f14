// SPDX-License-Identifier: MIT
// The room gen, the program tractrix-gen, makes hair: styles and test sets on a sphere or a head
// (strands_make.h), and fur on any mesh (fur.h: roots, guides that grow over the surface, strands
// woven between them). From the command line, meshes and maps, it makes Strands and writes them by
// the table of formats.
//
// This file: the options that all commands of tractrix-gen share, and writing the hair.
#pragma once

#include "base/options.h"
#include "formats/format.h"

#include <stdio.h>

typedef struct GenOutput {
    const char *path; // NULL: not given
    int format;       // a FormatKind; -1: not given
    bool quiet;
} GenOutput;

// The stream of messages: standard output may be the hair's ("-").
static inline FILE *gen_messages(const GenOutput *output)
{
    return output->path && outfile_is_stdout(output->path) ? stderr : stdout;
}

// Without --format, the suffix decides; other suffixes and standard output get TressFX 4.
// RESULT_USAGE if the suffix is that of an image or a video.
Result gen_choose_format(GenOutput *output, Error *error);

// Rows of an option table; `at` is the offset of a GenOutput's member, or of an int, in the
// command's struct.
#define GEN_OPTION_OUTPUT(at)                                                                      \
    {                                                                                              \
        "output", 'o', OPTION_STRING, at, "FILE", 0, 0, "hair file to write; - is standard output" \
    }
#define GEN_OPTION_FORMAT(at)                                                                      \
    {                                                                                              \
        "format", 0, OPTION_WORD, at, &(FORMAT_WORDS)[1], 0, 0,                                    \
            "format of FILE, whatever its name [default: by its suffix; tfx4]"                     \
    }
#define GEN_OPTION_SEED(at)                                                                        \
    {                                                                                              \
        "seed", 0, OPTION_WHOLE, at, "N", 0, 2147483647, "start of all random numbers [default 1]" \
    }
#define GEN_OPTION_QUIET(at)                                                                       \
    {                                                                                              \
        "quiet", 'q', OPTION_SWITCH, at, NULL, 0, 0, "print errors only"                           \
    }
