// SPDX-License-Identifier: MIT
// How long drawing hair takes, and how far the picture is from the exact one.
#pragma once

#include "gpu.h"
#include "renderer.h"

#include <jansson.h>

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
    int frames;       // measured, >= 1, after three that are not
    bool no_error;    // the reference takes many seconds
    ImageScheme scheme;
} ImageOptions;

typedef struct ImageResult {
    double median_ms, min_ms; // drawing and reading back
    double rms;               // levels of 255 over covered pixels; negative: not measured
    double covered;           // share of the picture's pixels
    double reference_s;       // that the exact picture took
    Raster raster;            // that drew
    RendererCounts counts;    // of one picture
    char spans[256];          // passes and their least ms, with waits between them
} ImageResult;

// Hair on the GPU and, once asked for, its exact picture: for any number of schemes.
typedef struct ImageBench ImageBench;

// 1280x720, 15 frames, all auto.
ImageOptions image_options_default(void);

// The schemes that are worth comparing.
extern const ImageScheme IMAGE_SCHEMES[];
extern const size_t IMAGE_SCHEME_COUNT;

// The sets that are worth it, names for ImageOptions.set, and "files"; ends with NULL.
extern const char *const IMAGE_SETS[];

// NULL and *result for a set that does not exist or a file that cannot be read.
ImageBench *image_bench_create(const Gpu *gpu, const ImageOptions *options, Result *result,
                               Error *error);
void image_bench_destroy(ImageBench *bench);

// Draws by options->scheme and compares with the reference (image_reference.h), which is found at
// the first call that needs it: with the exact light at the vertices (shadow_reference_fill) for a
// scheme with shadows, without shadows for one without; smooth strands for one that smoothes; and
// all strands for one that leaves some out.
Result image_bench_measure(ImageBench *bench, const ImageOptions *options, ImageResult *result,
                           Error *error);

// A row for JSON with set, size, scheme and device. The caller owns the reference.
json_t *image_to_json(const ImageBench *bench, const ImageOptions *options,
                      const ImageResult *result);

// A table: a head line, then a line a row.
void image_print_head(FILE *stream);
void image_print(const ImageBench *bench, const ImageOptions *options, const ImageResult *result,
                 FILE *stream);
