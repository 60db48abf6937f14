// SPDX-License-Identifier: MIT
// How long drawing hair takes, and how far the picture is from the exact one.
#pragma once

#include "bench/bench_image_exact.h"
#include "bench/table.h"
#include "draw/renderer.h"

// A way to draw.
typedef struct ImageScheme {
    Raster raster;
    Oit oit;
    int layers;      // of abuffer that are sorted
    int samples;     // across a pixel; 0: as the quality says
    Shadow shadow;   // none: as the quality says
    Quality quality; // the defaults of all else
} ImageScheme;

typedef struct ImageOptions {
    const char *set;  // straight, curls, fur or a name that strands_make_set knows; or NULL
    const char *file; // a hair file, or NULL; one of both
    int size[2];      // px
    int frames;       // measured, >= 1, after two that are not
    bool no_error;    // the reference takes many seconds
    ImageScheme scheme;
} ImageOptions;

typedef struct ImageResult {
    Times wall, processor; // drawing and reading back; by the clock and as
    // processor time of all threads, which a busy machine lengthens less
    ImageDistance distance; // from the exact picture; NaN: not measured
    double reference_s;     // that the exact picture took; NaN: none
    Raster raster;          // that drew
    RendererCounts counts;  // of one picture
    char spans[256];        // passes and their least ms, with waits between them
} ImageResult;

// Hair on the GPU and, once asked for, its exact picture: for any number of schemes.
typedef struct ImageBench {
    const Gpu *gpu;
    ImageHair hair;
    ImageExact exact;
} ImageBench;

// 1280x720, 15 frames, all auto.
ImageOptions image_options_default(void);

// RESULT_USAGE for a set that does not exist, RESULT_BAD_INPUT for a file that cannot be read. It
// may be destroyed in either case.
Result image_bench_create(ImageBench *bench, const Gpu *gpu, const ImageOptions *options,
                          Error *error);
void image_bench_destroy(ImageBench *bench);

// Draws by options->scheme and compares with the exact picture (image_exact_find), which is drawn
// at the first call that needs it.
Result image_bench_measure(ImageBench *bench, const ImageOptions *options, ImageResult *result,
                           Error *error);
