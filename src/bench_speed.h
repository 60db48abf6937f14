// SPDX-License-Identifier: MIT
// How long a solver's step and a drawn frame take.
#pragma once

#include "gpu.h"
#include "params.h"

#include <jansson.h>

typedef struct SpeedOptions {
    const char *set;  // a name that strands_make_set knows, or NULL
    const char *file; // a hair file, or NULL; one of both
    const char *algo, *variant;
    double style;  // share of the style in the drawn strand; < 0: the default
    int steps;     // measured
    int warm_up;   // steps before that, not measured
    int size[2];   // picture to draw in px; 0: no drawing
    Raster raster; // how hair is drawn
} SpeedOptions;

// Of some samples, ms.
typedef struct SpeedTimes {
    double median, minimum;
} SpeedTimes;

typedef struct SpeedResult {
    char name[128];
    uint32_t strands, batches;
    uint64_t particles;
    double first_step_ms; // with shader compilation, unless the driver's cache has it
    SpeedTimes step; // what moves the hair one step further and writes the positions that are drawn
    SpeedTimes solve;   // its part without the positions
    SpeedTimes draw;    // drawing and reading back
    uint64_t fragments; // of the last picture
} SpeedResult;

// The defaults: 200 steps after 20, split, no drawing.
SpeedOptions speed_options_default(void);

// Of `count` samples, which are put in order; 0 for none.
SpeedTimes speed_summarise(double *samples, int count);

// Measures with the wall clock, waiting for the GPU at the end of each sample. Steps of 1/60 s from
// rest under gravity.
Result speed_measure(SpeedResult *result, const Gpu *gpu, const SpeedOptions *options,
                     Error *error);

// One row as JSON, with device, processor-independent set-up, version and commit. The caller owns
// the reference.
json_t *speed_to_json(const SpeedResult *result, const SpeedOptions *options, const Gpu *gpu);

// A table: a head line, then a line a row.
void speed_print_head(FILE *stream);
void speed_print(const SpeedResult *result, const SpeedOptions *options, FILE *stream);
