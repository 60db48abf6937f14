// SPDX-License-Identifier: MIT
// The command "trace" (bench_commands.h).
#include "bench/bench_commands.h"
#include "bench/light_case.h"
#include "bench/light_stage.h"
#include "bench/light_traced.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The light of an image divided by its coverage.
static double mean_light(const Image *image, int channel)
{
    const float *pixels = (const float *)(const void *)image->pixels;
    double light = 0, coverage = 0;
    for (int i = 0; i < image->width * image->height; ++i) {
        light += (double)pixels[4 * i + channel];
        coverage += (double)pixels[4 * i + 3];
    }
    return light / coverage;
}

static Result trace_images(LightStage *stage, const char *scene, const char *table, int paths,
                           Image images[2], Error *error)
{
    static const int ORDERS[2] = {1, TRACED_ORDERS};
    const int *size = stage->scene.run.size;
    if (size[0] % LIGHT_BLOCK_PX || size[1] % LIGHT_BLOCK_PX)
        return error_set(error, RESULT_BAD_INPUT,
                         "%s: the image has %dx%d pixels: expected multiples of %d", scene, size[0],
                         size[1], LIGHT_BLOCK_PX);
    for (int i = 0; i < 2; ++i) {
        TRY(image_create_kind(&images[i], size[0], size[1], 4, IMAGE_FLOAT, error));
        TRY(light_traced_draw(stage, &images[i], ORDERS[i], paths, error));
    }
    TRY(light_case_write(table, &images[0], &images[1], error));
    printf("%s: %d paths a pixel, light of hair", table, paths);
    for (int c = 0; c < 3; ++c) printf(" %.4f", mean_light(&images[1], c));
    printf("\n");
    fflush(stdout);
    return RESULT_OK;
}

static Result trace(const BenchOptions *options, const Gpu *gpu, const char *scene, Error *error)
{
    LightStage stage;
    Image images[2] = {{0}};
    char *table;
    const char *own = options->render ? options->render : "", *dot = strrchr(scene, '.');
    if (!dot || strcmp(dot, ".json") != 0)
        return error_set(error, RESULT_USAGE, "trace: %s: expected a scene file NAME.json", scene);
    if (asprintf(&table, "%.*s.csv", (int)(dot - scene), scene) < 0)
        return error_set(error, RESULT_FAILED, "no memory for %s", scene);
    Result result = light_stage_create(&stage, gpu, scene, (const char *[]){own, "", ""}, error);
    THEN(result, trace_images(&stage, scene, table, TRACED_PATHS * options->frames, images, error));
    for (int i = 0; i < 2; ++i) image_destroy(&images[i]);
    light_stage_destroy(&stage);
    free(table);
    return result;
}

Result trace_run(const BenchOptions *options, const Gpu *gpu, Error *error)
{
    if (options->file_count == 0)
        return error_set(error, RESULT_USAGE, "trace: expected scene files");
    TRY(bench_options_some_frames(options, error));
    for (int i = 0; i < options->file_count; ++i)
        TRY(trace(options, gpu, options->files[i], error));
    return RESULT_OK;
}
