// SPDX-License-Identifier: MIT
// The edits of tractrix-convert between reading and writing, in the order of the command line.
#pragma once

#include "base/options.h"
#include "strands/strands.h"
#include "strands/strands_edit.h"
#include "strands/strands_mesh.h"
#include "strands/strands_resample.h"

#include <stdio.h>

typedef enum ConvertKind {
    CONVERT_SUBSAMPLE, // a random share of the strands
    CONVERT_NTH,       // every n-th
    CONVERT_GROUP,     // the strands of one group
    CONVERT_MIN_LENGTH,
    CONVERT_RESAMPLE,
    CONVERT_SMOOTH,
    CONVERT_MOVE,
    CONVERT_REVERSE,
    CONVERT_FIT,      // to a mesh, by rotation, translation and scaling
    CONVERT_ATTACH,   // moves roots onto a mesh
    CONVERT_PUSH_OUT, // moves vertices out of a mesh
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
    uint32_t seed;          // of random choices
    const Surface *surface; // of --mesh; NULL: no mesh
    FILE *messages;         // for reports of changes on a mesh; NULL: nowhere
    StrandsFit fit;         // found in the first frame, used for all
    bool has_fit;
} ConvertSteps;

// The options' names are those of main_convert.c's table. RESULT_USAGE for invalid values.
Result convert_steps_parse(ConvertSteps *steps, const OptionSteps *options, Error *error);

// The name of a step that needs a mesh, NULL if none does.
const char *convert_steps_need_mesh(const ConvertSteps *steps);
// Whether one of the steps is --fit.
bool convert_steps_fit(const ConvertSteps *steps);

// Does the steps in their order. Reports on `messages` what --fit, --attach and --push-out have
// done in the first frame. RESULT_FAILED when memory is short, a strand would have too many
// vertices, or no strand is left.
Result convert_steps_apply(ConvertSteps *steps, Strands *strands, Error *error);
