// SPDX-License-Identifier: MIT
// The room of measurements, the program tractrix-bench: accuracy, speed, stress and image error of
// the rooms below. It steps and draws with their hair, solvers, simulation and renderer, and
// outputs rows (table.h) on the screen, as CSV and as JSON, and checks documented bounds. Its
// commands are in bench_commands.h, stress.h and test_vectors.h.
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
    int layers;      // number of sorted layers of abuffer
    int samples;     // per pixel side; 0: as in `quality`
    Shadow shadow;   // none: as in `quality`
    Quality quality; // defaults of everything else
} BenchScheme;

typedef struct BenchOptions {
    const char *set, *tfx;           // a set's name; a hair file; NULL: neither
    const char *vectors, *reference; // file of test vectors; folder of exact motions or of
                                     // path-traced light; NULL: the included ones
    const char *parts;               // "motions,work"; NULL: all parts of the command
    const char *case_name;           // "curls_blond_sky,fur_brown_side"; a stress case; NULL: all
    const char *ways;                // ways to compute light, "grid,none"; NULL: those with bounds
    const char *render;              // flags of tractrix-render for every scene; NULL: none
    const char *mesh;                // OBJ file of the head of grooms; NULL: none
    int strands; // number of a groom's strands, spread evenly over the file; 0: all
    const char *picture, *before;   // PNG file; folder of PFM files by another version; NULL: none
    Method method;                  // algo NULL: all solvers
    double rates[BENCH_MOST_RATES]; // steps per second
    int rate_count;                 // 0: defaults of the part
    double seconds;                 // duration of long runs
    int steps, warm_up;             // measured steps, and unmeasured ones before
    StressOptions stress;           // all except its method
    int size[2];                    // image to draw in px; 0: none, or the usual size
    BenchScheme scheme;             // how hair is drawn
    int frames;                     // measured images, >= 0, after two unmeasured ones
    bool no_error;                  // no exact image, which takes many seconds
    GpuOptions gpu;
    TableOutput output;
    char **files; // the command and hair files
    int file_count;
    bool done;          // --help or --version was answered
    char *settings;     // owned: the text that `method` points to
    char *line, *title; // owned: strings of `output`
} BenchOptions;

// Reads a command line; strings point into argv, which is reordered. `commands` lists names and
// descriptions for --help and ends with {NULL}. RESULT_USAGE for an unknown option or a missing or
// invalid value. The struct may be destroyed in either case.
Result bench_options_read(BenchOptions *options, int argc, char **argv,
                          const char *const (*commands)[2], Error *error);
void bench_options_destroy(BenchOptions *options);

// For commands that take one solver only: RESULT_USAGE if --algo lists several.
Result bench_options_one_algo(const BenchOptions *options, Error *error);

// Checks that there are images to measure, or paths to trace.
Result bench_options_some_frames(const BenchOptions *options, Error *error);

// Whether the command's part `name` is requested.
bool bench_options_part(const BenchOptions *options, const char *name);

// Whether a comma-separated list contains `word`.
bool bench_options_lists(const char *text, const char *word);

// RESULT_USAGE unless every requested part is one of `names`, which end with NULL; the message
// lists them.
Result bench_options_check_parts(const BenchOptions *options, const char *const *names,
                                 Error *error);

// The same for the list of another option; a NULL `text` is valid.
Result bench_options_check_list(const char *option, const char *text, const char *const *names,
                                Error *error);
