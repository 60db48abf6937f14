// SPDX-License-Identifier: MIT
// What tractrix-convert does to hair between reading and writing, in the order of the command line.
#pragma once

#include "base/options.h"
#include "strands/strands.h"
#include "strands/strands_edit.h"
#include "strands/strands_mesh.h"
#include "strands/strands_resample.h"

#include <stdio.h>

typedef enum ConvertKind {
    CONVERT_SUBSAMPLE, // a random share of the strands
    CONVERT_NTH,       // each n-th
    CONVERT_GROUP,     // those of one group
    CONVERT_MIN_LENGTH,
    CONVERT_RESAMPLE,
    CONVERT_SMOOTH,
    CONVERT_MOVE,
    CONVERT_REVERSE,
    CONVERT_FIT,      // to a mesh, by a similarity
    CONVERT_ATTACH,   // roots onto a mesh
    CONVERT_PUSH_OUT, // vertices out of a mesh
    CONVERT_KINDS
} ConvertKind;

typedef struct ConvertStep {
    ConvertKind kind;
    double number; // share or metres
    uint32_t count;
    ResampleOptions resample;
    StrandsMove move;
} ConvertStep;

typedef struct ConvertSteps {
    ConvertStep step[OPTION_MOST_STEPS];
    int count;
    uint32_t seed;          // of what is random
    const Surface *surface; // that of --mesh; NULL: there is none
    FILE *messages;         // what was done on a mesh; NULL: nowhere
    StrandsFit fit;         // found by the first frame, for all
    bool has_fit;
} ConvertSteps;

// The options' names are those of main_convert.c's table. RESULT_USAGE for values that they can't
// have.
Result convert_steps_parse(ConvertSteps *steps, const OptionSteps *options, Error *error);

// Whether a step needs a mesh: its name, else NULL.
const char *convert_steps_need_mesh(const ConvertSteps *steps);

// Does the steps in their order. What --fit, --attach and --push-out have done in the first frame
// is written to `messages`. RESULT_FAILED when memory is short, a strand would have too many
// vertices, or none is left.
Result convert_steps_apply(ConvertSteps *steps, Strands *strands, Error *error);
