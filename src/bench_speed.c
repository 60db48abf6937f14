// SPDX-License-Identifier: MIT
#include "bench_speed.h"
#include "fibre.h"
#include "renderer.h"
#include "simulation.h"
#include "stats.h"
#include "strands_make.h"
#include "strands_read.h"

#include "version.h"

#include <stdlib.h>
#include <string.h>

SpeedOptions speed_options_default(void)
{
    return (SpeedOptions){.algo = "split", .variant = "", .style = -1, .steps = 200, .warm_up = 20};
}

static int compare_times(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

SpeedTimes speed_summarise(double *samples, int count)
{
    if (count == 0) return (SpeedTimes){0};
    qsort(samples, (size_t)count, sizeof *samples, compare_times);
    return (SpeedTimes){.median = samples[count / 2], .minimum = samples[0]};
}

// A scene of one section, as the command line would make it.
typedef struct Bench {
    Scene scene;
    Strands strands;
    GpuTimer timer;
    Simulation simulation;
} Bench;

static void bench_destroy(Bench *bench)
{
    if (bench->simulation.scene) simulation_destroy(&bench->simulation);
    gpu_timer_destroy(&bench->timer);
    strands_destroy(&bench->strands);
    scene_destroy(&bench->scene);
}

static Result read_strands(Bench *bench, const SpeedOptions *options, Error *error)
{
    if (options->set) return strands_make_set(&bench->strands, options->set, 1, error);
    return strands_read(&bench->strands, options->file, &(StrandsReadOptions){0}, NULL, error);
}

static Result describe_section(SectionParams *params, const SpeedOptions *options, Error *error)
{
    Result result = section_params_create(params, error);
    if (result == RESULT_OK) result = param_parse(param_find("algo"), params, options->algo, error);
    if (result == RESULT_OK)
        result = param_parse(param_find("variant"), params, options->variant, error);
    params->sleep = 0; // every step is one
    params->followers = 0;
    if (options->style >= 0) params->style = (float)options->style;
    return result;
}

static Result bench_create(Bench *bench, const Gpu *gpu, const SpeedOptions *options, Error *error)
{
    SectionParams params;
    *bench = (Bench){0};
    gpu_timer_create(&bench->timer, false, true);
    Result result = scene_create(&bench->scene, error);
    if (result == RESULT_OK) result = describe_section(&params, options, error);
    if (result != RESULT_OK) return result;
    result = scene_add_section(&bench->scene, options->set ? options->set : options->file, &params,
                               error);
    section_params_destroy(&params);
    if (result == RESULT_OK) result = read_strands(bench, options, error);
    if (result == RESULT_OK)
        result = simulation_create(&bench->simulation, gpu, &bench->timer, &bench->scene,
                                   &bench->strands, NULL, error);
    return result;
}

static Result measure_steps(SpeedResult *result, Bench *bench, const SpeedOptions *options,
                            Error *error)
{
    double *step = calloc((size_t)options->steps + 1, sizeof *step),
           *solve = calloc((size_t)options->steps + 1, sizeof *solve);
    if (step && solve) {
        for (int i = -options->warm_up - 1; i < options->steps; ++i) {
            double begin = stats_clock_ms();
            simulation_advance(&bench->simulation);
            glFinish();
            double solved = stats_clock_ms();
            simulation_pose(&bench->simulation);
            glFinish();
            double end = stats_clock_ms();
            if (i == -options->warm_up - 1) result->first_step_ms = end - begin;
            if (i >= 0) step[i] = end - begin, solve[i] = solved - begin;
        }
        result->step = speed_summarise(step, options->steps);
        result->solve = speed_summarise(solve, options->steps);
    }
    bool good = step && solve;
    free(step);
    free(solve);
    return good ? RESULT_OK
                : error_set(error, RESULT_FAILED, "no memory for %d samples", options->steps);
}

enum { DRAWN_FRAMES = 20, DRAWN_WARM_UP = 3 };

static Result draw_frames(SpeedResult *result, Renderer *renderer, Bench *bench, Image *image,
                          Error *error)
{
    double samples[DRAWN_FRAMES] = {0};
    Framing framing;
    View view;
    framing_compute(&framing, &bench->scene, &bench->strands, NULL);
    const RenderItem item = {&bench->simulation.sections[0].hair, &bench->scene.sections[0].params,
                             fibre_auto_radius(&bench->strands, 0)};
    const RenderFrame frame = {.view = &view,
                               .lights = bench->scene.lights,
                               .light_count = bench->scene.light_count,
                               .head_rotation = {0, 0, 0, 1}};
    Result outcome = RESULT_OK;
    for (int i = -DRAWN_WARM_UP; i < DRAWN_FRAMES && outcome == RESULT_OK; ++i) {
        camera_view(&view, &bench->scene, &framing, 0);
        simulation_advance(&bench->simulation);
        simulation_pose(&bench->simulation);
        glFinish();
        double begin = stats_clock_ms();
        outcome = renderer_draw(renderer, &frame, &item, 1, image, error);
        if (i >= 0) samples[i] = stats_clock_ms() - begin;
    }
    result->draw = speed_summarise(samples, outcome == RESULT_OK ? DRAWN_FRAMES : 0);
    result->fragments = renderer->counts.fragments;
    return outcome;
}

static Result measure_drawing(SpeedResult *result, const Gpu *gpu, Bench *bench,
                              const SpeedOptions *options, Error *error)
{
    Renderer renderer;
    Image image = {0};
    const RendererOptions size = {.raster = options->raster,
                                  .width = options->size[0],
                                  .height = options->size[1],
                                  .background = {0.2f, 0.2f, 0.2f, 1}};
    bench->scene.run.size[0] = options->size[0], bench->scene.run.size[1] = options->size[1];
    Result outcome = renderer_create(&renderer, gpu, &bench->timer, &size, error);
    if (outcome != RESULT_OK) return outcome;
    outcome = image_create(&image, options->size[0], options->size[1], renderer_channels(&renderer),
                           error);
    if (outcome == RESULT_OK) outcome = draw_frames(result, &renderer, bench, &image, error);
    image_destroy(&image);
    renderer_destroy(&renderer);
    return outcome;
}

Result speed_measure(SpeedResult *result, const Gpu *gpu, const SpeedOptions *options, Error *error)
{
    Bench bench;
    *result = (SpeedResult){0};
    Result outcome = bench_create(&bench, gpu, options, error);
    if (outcome == RESULT_OK) {
        const char *name = options->set ? options->set : options->file, *slash = strrchr(name, '/');
        snprintf(result->name, sizeof result->name, "%s", slash ? slash + 1 : name);
        result->strands = bench.strands.strand_count;
        result->particles = bench.strands.vertex_count;
        result->batches = bench.simulation.sections[0].hair.batch_count;
        outcome = measure_steps(result, &bench, options, error);
    }
    if (outcome == RESULT_OK && options->size[0])
        outcome = measure_drawing(result, gpu, &bench, options, error);
    bench_destroy(&bench);
    return outcome;
}

json_t *speed_to_json(const SpeedResult *result, const SpeedOptions *options, const Gpu *gpu)
{
    json_t *row = json_pack(
        "{s:s, s:s, s:s, s:I, s:I, s:i, s:f, s:f, s:f, s:f, s:f, s:s, s:s, s:s, s:s}", "set",
        result->name, "algo", options->algo, "variant", options->variant, "strands",
        (json_int_t)result->strands, "particles", (json_int_t)result->particles, "steps",
        options->steps, "median_ms", result->step.median, "min_ms", result->step.minimum,
        "solve_median_ms", result->solve.median, "solve_min_ms", result->solve.minimum,
        "first_step_ms", result->first_step_ms, "renderer", gpu->renderer, "gl_version",
        gpu->version, "version", TRACTRIX_VERSION, "commit", TRACTRIX_COMMIT);
    if (row && options->size[0]) {
        json_object_set_new(row, "draw_median_ms", json_real(result->draw.median));
        json_object_set_new(row, "draw_min_ms", json_real(result->draw.minimum));
        json_object_set_new(row, "draw_size",
                            json_pack("[i, i]", options->size[0], options->size[1]));
        json_object_set_new(row, "fragments", json_integer((json_int_t)result->fragments));
    }
    return row;
}

void speed_print_head(FILE *stream)
{
    fprintf(stream, "%-24s %-8s %-8s %8s %10s %9s %9s %9s %9s %9s\n", "set", "algo", "variant",
            "strands", "particles", "step ms", "(min)", "draw ms", "(min)", "first ms");
}

void speed_print(const SpeedResult *result, const SpeedOptions *options, FILE *stream)
{
    fprintf(stream, "%-24s %-8s %-8s %8u %10llu %9.3f %9.3f ", result->name, options->algo,
            *options->variant ? options->variant : "-", result->strands,
            (unsigned long long)result->particles, result->step.median, result->step.minimum);
    if (options->size[0])
        fprintf(stream, "%9.2f %9.2f ", result->draw.median, result->draw.minimum);
    else
        fprintf(stream, "%9s %9s ", "-", "-");
    fprintf(stream, "%9.1f\n", result->first_step_ms);
}
