// SPDX-License-Identifier: MIT
// What tractrix-convert does to hair between reading and writing, in the order of the command line.
#pragma once

#include "base/options.h"
#include "strands/strands.h"
#include "strands/strands_edit.h"
#include "strands/strands_resample.h"

typedef enum ConvertKind {
    CONVERT_SUBSAMPLE, // a random share of the strands
    CONVERT_NTH,       // each n-th
    CONVERT_MIN_LENGTH,
    CONVERT_RESAMPLE,
    CONVERT_SMOOTH,
    CONVERT_MOVE,
    CONVERT_REVERSE,
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
    uint32_t seed; // of what is random
} ConvertSteps;

// The options' names are those of main_convert.c's table. RESULT_USAGE for values that they can't
// have.
Result convert_steps_parse(ConvertSteps *steps, const OptionSteps *options, Error *error);

// RESULT_FAILED when memory is short, a strand would have too many vertices, or none is left.
Result convert_steps_apply(const ConvertSteps *steps, Strands *strands, Error *error);
