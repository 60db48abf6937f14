// SPDX-License-Identifier: MIT
// The command line of tractrix-bench.
#pragma once

#include "bench_accuracy.h"
#include "bench_image.h"
#include "bench_speed.h"
#include "gpu.h"

#include <stdio.h>

typedef struct BenchOptions {
    SpeedOptions speed;
    AccuracyOptions accuracy;
    ImageOptions image; // but for what speed has
    GpuOptions gpu;
    const char *vectors, *json; // files; NULL: none
    char **files;               // what is no option: the command and hair files
    int file_count;
    bool help, version; // is asked for, and the rest of the command line was not read
} BenchOptions;

// Reads a command line; strings point into argv, which is reordered. RESULT_USAGE for an option
// that is unknown, lacks its value, or has one out of range.
Result bench_options_read(BenchOptions *options, int argc, char **argv, Error *error);

// A line for each option.
void bench_options_list(FILE *out);
