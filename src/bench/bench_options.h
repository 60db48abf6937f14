// SPDX-License-Identifier: MIT
// The room of measurements, the program tractrix-bench: accuracy, speed, stress and image error of
// what the rooms below it do. It takes hair, solvers, simulation and renderer as they are, steps
// and draws them itself, and hands on rows (table.h) on the screen, as CSV and as JSON, with stated
// bounds checked. bench_commands.h, stress.h and test_vectors.h have its commands.
//
// This header: the command line.
#pragma once

#include "bench/stress.h"
#include "bench/table.h"
#include "bench/trial.h"
#include "gpu/gpu.h"

enum { BENCH_MOST_RATES = 8, BENCH_MOST_PARAMS = 64 };

// A way to draw.
typedef struct BenchScheme {
    Raster raster;
    Oit oit;
    int layers;      // of abuffer that are sorted
    int samples;     // across a pixel; 0: as the quality says
    Shadow shadow;   // none: as the quality says
    Quality quality; // the defaults of all else
} BenchScheme;

typedef struct BenchOptions {
    const char *set, *tfx;           // a set's name; a hair file; NULL: neither
    const char *vectors, *reference; // file of test vectors; folder of exact motions or of
                                     // path-traced light; NULL: those that ship
    const char *parts;               // "motions,work"; NULL: all of the command
    const char *case_name;          // "curls_blond_sky,fur_brown_side"; a case of stress; NULL: all
    const char *ways;               // of light, "grid,none"; NULL: those that have bounds
    const char *render;             // flags of tractrix-render for every scene; NULL: none
    const char *mesh;               // OBJ file of the head of grooms; NULL: none
    int strands;                    // of a groom, spread evenly over the file; 0: all
    const char *picture, *before;   // PNG file; folder of PFM files by another version; NULL: none
    Method method;                  // algo NULL: all
    double rates[BENCH_MOST_RATES]; // steps a second
    int rate_count;                 // 0: the part's own
    double seconds;                 // of long runs
    int steps, warm_up;             // measured, and not measured before that
    StressOptions stress;           // but for its method
    int size[2];                    // image to draw in px; 0: none, or the usual size
    BenchScheme scheme;             // how hair is drawn
    int frames;                     // images, >= 1, after two that are not measured
    bool no_error;                  // no exact image, which takes many seconds
    GpuOptions gpu;
    TableOutput output;
    char **files; // what is no option: the command and hair files
    int file_count;
    bool done;          // --help or --version was answered
    char *settings;     // owned: the text that `method` points to
    char *line, *title; // owned: what `output` points to
} BenchOptions;

// Reads a command line; strings point into argv, which is reordered. `commands`, names and what
// they do, {NULL} behind the last, are for --help. RESULT_USAGE for an option that is unknown,
// lacks its value, or has one out of range. The struct may be destroyed in either case.
Result bench_options_read(BenchOptions *options, int argc, char **argv,
                          const char *const (*commands)[2], Error *error);
void bench_options_destroy(BenchOptions *options);

// That --algo, if it is given, is one solver; for commands that take no list. RESULT_USAGE.
Result bench_options_one_algo(const BenchOptions *options, Error *error);

// Whether a command shall do its part `name`.
bool bench_options_part(const BenchOptions *options, const char *name);

// Whether a list of words with commas between them has `word`.
bool bench_options_lists(const char *text, const char *word);

// That every part which is asked for is one of `names`, which end with NULL; RESULT_USAGE naming
// them.
Result bench_options_check_parts(const BenchOptions *options, const char *const *names,
                                 Error *error);

// The same for the list of another option; NULL is right.
Result bench_options_check_list(const char *option, const char *text, const char *const *names,
                                Error *error);
