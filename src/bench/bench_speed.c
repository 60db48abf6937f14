// SPDX-License-Identifier: MIT
#include "bench/bench_speed.h"
#include "base/clock.h"
#include "base/interrupt.h"
#include "bench/bench_cpu.h"
#include "bench/bench_scaling.h"
#include "bench/bench_sets.h"
#include "draw/renderer.h"
#include "gen/strands_make.h"
#include "sim/simulation.h"
#include "strands/paint.h"
#include "strands/strands_read.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// --- A scene of one section, as the command line would make it.

typedef struct Bench {
    Scene scene;
    GpuTimer timer;
    Simulation simulation;
} Bench;

static void bench_destroy(Bench *bench)
{
    if (bench->simulation.scene) simulation_destroy(&bench->simulation);
    gpu_timer_destroy(&bench->timer);
    scene_destroy(&bench->scene);
}

static Result bench_create(Bench *bench, const Gpu *gpu, const SpeedSubject *subject, Error *error)
{
    SectionParams params;
    *bench = (Bench){0};
    gpu_timer_create(&bench->timer, false, true);
    Result result = scene_create(&bench->scene, error);
    if (result != RESULT_OK) return result;
    result = method_params(&params, &subject->method, "", error);
    params.sleep = 0; // every step is one
    params.followers = 0;
    if (result == RESULT_OK)
        result = scene_add_section(&bench->scene, subject->name, &params, error);
    params_destroy_section(&params);
    if (result == RESULT_OK)
        result = simulation_create(&bench->simulation, gpu, &bench->timer, &bench->scene,
                                   subject->strands, NULL, error);
    return result;
}

// Each buffer of the solver's state is read and written; so are the drawn positions, unless they
// are such a buffer; the style is read. What a solver touches more often, or beside, is not in it.
static uint64_t count_bytes(const Bench *bench)
{
    const SimulationSection *section = &bench->simulation.sections[0];
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < section->hair.batch_count; ++i) {
        const HairBatch *batch = &section->hair.batches[i];
        SolverBuffer buffers[SOLVER_MAX_BUFFERS];
        int count = solver_buffers(&section->solver, i, buffers);
        bool drawn = false;
        for (int b = 0; b < count; ++b) {
            bytes += 2 * (uint64_t)buffers[b].buffer->size;
            drawn = drawn || buffers[b].buffer == &batch->position;
        }
        bytes += (uint64_t)batch->rest.size + (drawn ? 0 : (uint64_t)batch->position.size);
    }
    return bytes;
}

static Result measure_steps(SpeedResult *result, Bench *bench, const BenchOptions *options,
                            Error *error)
{
    double *step = calloc((size_t)options->steps + 1, sizeof *step),
           *solve = calloc((size_t)options->steps + 1, sizeof *solve);
    if (step && solve) {
        for (int i = -options->warm_up - 1; i < options->steps; ++i) {
            double begin = clock_ms();
            simulation_advance(&bench->simulation);
            glFinish();
            double solved = clock_ms();
            simulation_pose(&bench->simulation);
            glFinish();
            double end = clock_ms();
            if (i == -options->warm_up - 1) result->first_step_ms = end - begin;
            if (i >= 0) step[i] = end - begin, solve[i] = solved - begin;
        }
        result->step = table_times(step, options->steps);
        result->solve = table_times(solve, options->steps);
        result->bytes = count_bytes(bench);
    }
    bool good = step && solve;
    free(step);
    free(solve);
    return good ? RESULT_OK
                : error_set(error, RESULT_FAILED, "no memory for %d samples", options->steps);
}

enum { DRAWN_FRAMES = 20, DRAWN_WARM_UP = 3 };

static Result draw_frames(SpeedResult *result, Renderer *renderer, Bench *bench,
                          const Strands *strands, Image *image, Error *error)
{
    double samples[DRAWN_FRAMES] = {0};
    Framing framing;
    View view;
    outline_frame(&framing, &bench->scene, strands, NULL);
    const RenderItem item = {&bench->simulation.sections[0].hair, &bench->scene.sections[0].params,
                             paint_auto_radius(strands, 0)};
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
        double begin = clock_ms();
        outcome = renderer_draw(renderer, &frame, &item, 1, image, error);
        if (i >= 0) samples[i] = clock_ms() - begin;
    }
    result->draw = table_times(samples, outcome == RESULT_OK ? DRAWN_FRAMES : 0);
    result->fragments = renderer->counts.fragments;
    return outcome;
}

static Result measure_drawing(SpeedResult *result, const Gpu *gpu, Bench *bench,
                              const Strands *strands, const BenchOptions *options, Error *error)
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
    if (outcome == RESULT_OK)
        outcome = draw_frames(result, &renderer, bench, strands, &image, error);
    image_destroy(&image);
    renderer_destroy(&renderer);
    return outcome;
}

Result speed_measure(SpeedResult *result, const Gpu *gpu, const SpeedSubject *subject,
                     const BenchOptions *options, Error *error)
{
    Bench bench;
    *result = (SpeedResult){.draw = table_times(NULL, 0)};
    Result outcome = bench_create(&bench, gpu, subject, error);
    if (outcome == RESULT_OK) outcome = measure_steps(result, &bench, options, error);
    if (outcome == RESULT_OK) outcome = gpu_check("steps", error);
    if (outcome == RESULT_OK && options->size[0])
        outcome = measure_drawing(result, gpu, &bench, subject->strands, options, error);
    bench_destroy(&bench);
    return outcome;
}

// --- Rows.

// What a row is in the files: also what follows from it.
typedef struct Line {
    SpeedRow row;
    const char *variant, *verdict;
    long bytes, fragments;
    double ns_particle, gigabytes_s, share, draw_min, draw_median;
    char command[512];
} Line;

#define AT(member) offsetof(Line, member)
static const Column COLUMNS[] = {
    {"part", COLUMN_TEXT, AT(row.part), 8},
    {"hair", COLUMN_CHARS, AT(row.hair), 20},
    {"algo", COLUMN_TEXT, AT(row.method.algo), 9},
    {"variant", COLUMN_TEXT, AT(variant), 9},
    {"settings", COLUMN_TEXT, AT(row.method.settings), 0},
    {"strands", COLUMN_WHOLE, AT(row.strands), 8},
    {"vertices", COLUMN_WHOLE, AT(row.vertices), 8},
    {"particles", COLUMN_WHOLE, AT(row.particles), 9},
    {"threads", COLUMN_WHOLE, AT(row.threads), 7},
    {"ms_min", COLUMN_REAL, AT(row.result.step.minimum), 8},
    {"ms_q1", COLUMN_REAL, AT(row.result.step.lower_quartile), 8},
    {"ms_median", COLUMN_REAL, AT(row.result.step.median), 9},
    {"ms_q3", COLUMN_REAL, AT(row.result.step.upper_quartile), 8},
    {"solve_ms_min", COLUMN_REAL, AT(row.result.solve.minimum), 0},
    {"solve_ms_median", COLUMN_REAL, AT(row.result.solve.median), 0},
    {"ns_particle", COLUMN_REAL, AT(ns_particle), 11},
    {"thesis_ms", COLUMN_REAL, AT(row.thesis_ms), 9},
    {"bound_ms", COLUMN_REAL, AT(row.bound_ms), 8},
    {"verdict", COLUMN_TEXT, AT(verdict), 7},
    {"bytes", COLUMN_WHOLE, AT(bytes), 10},
    {"gb_s", COLUMN_REAL, AT(gigabytes_s), 7},
    {"bandwidth_share", COLUMN_REAL, AT(share), 15},
    {"exponent", COLUMN_REAL, AT(row.exponent), 8},
    {"spread", COLUMN_REAL, AT(row.spread), 8},
    {"first_ms", COLUMN_REAL, AT(row.result.first_step_ms), 8},
    {"process_ms", COLUMN_REAL, AT(row.process_ms), 10},
    {"draw_ms_min", COLUMN_REAL, AT(draw_min), 11},
    {"draw_ms_median", COLUMN_REAL, AT(draw_median), 0},
    {"fragments", COLUMN_WHOLE, AT(fragments), 0},
    {"off", COLUMN_REAL, AT(row.off), 9},
    {"remark", COLUMN_TEXT, AT(row.remark), 1},
    {"command", COLUMN_CHARS, AT(command), 0},
};

SpeedRow speed_row(const char *part, const SpeedSubject *subject)
{
    const Times none = table_times(NULL, 0);
    SpeedRow row = {.part = part,
                    .method = {"", "", ""},
                    .result = {.step = none, .solve = none, .draw = none, .first_step_ms = NAN},
                    .thesis_ms = NAN,
                    .bound_ms = NAN,
                    .exponent = NAN,
                    .spread = NAN,
                    .gigabytes_s = NAN,
                    .process_ms = NAN,
                    .off = NAN,
                    .off_bound = NAN,
                    .remark = ""};
    if (!subject) return row;
    const Strands *strands = subject->strands;
    snprintf(row.hair, sizeof row.hair, "%s", subject->name);
    row.set = subject->set, row.file = subject->file;
    row.method = subject->method;
    row.strands = strands->strand_count;
    row.particles = strands->vertex_count;
    row.vertices = strands->first[1];
    return row;
}

static void write_command(const Speed *speed, Line *line)
{
    const SpeedRow *row = &line->row;
    char method[256] = "", hair[128] = "", size[64] = "";
    if (*row->method.algo) method_format(&row->method, method, sizeof method);
    if (row->set) snprintf(hair, sizeof hair, " --set %s", row->set);
    if (row->file) snprintf(hair, sizeof hair, " --tfx %s", row->file);
    if (!isnan(line->draw_min))
        snprintf(size, sizeof size, " --size %dx%d", speed->options->size[0],
                 speed->options->size[1]);
    snprintf(line->command, sizeof line->command, "tractrix-bench speed --part %s %s%s%s",
             row->part, method, hair, size);
}

void speed_add(Speed *speed, const SpeedRow *row)
{
    const SpeedResult *result = &row->result;
    double least = result->step.minimum;
    Line line = {.row = *row,
                 .variant = *row->method.algo ? method_variant(&row->method) : "",
                 .bytes = (long)result->bytes,
                 .fragments = (long)result->fragments,
                 .ns_particle = row->particles ? least * 1e6 / (double)row->particles : NAN,
                 .gigabytes_s = row->gigabytes_s,
                 .draw_min = result->draw.minimum,
                 .draw_median = result->draw.median};
    if (result->bytes) line.gigabytes_s = (double)result->bytes / least * 1e-6;
    line.share = speed->bandwidth > 0 ? line.gigabytes_s / speed->bandwidth : NAN;
    line.verdict = table_check(&speed->table, least, row->bound_ms, "%s, %s: least ms a step",
                               row->hair, row->method.algo);
    if (!isnan(row->off_bound))
        line.verdict = table_check(&speed->table, row->off, row->off_bound,
                                   "%s, %s: off the GPU's strands", row->hair, row->remark);
    write_command(speed, &line);
    table_add(&speed->table, &line);
}

// --- The hair.

static Result use_hair(Speed *speed, SpeedSubject *subject, const Strands *strands,
                       Result (*use)(Speed *speed, const SpeedSubject *subject, Error *error),
                       Error *error)
{
    Result result = RESULT_OK;
    const char *name = subject->set ? subject->set : subject->file, *slash = strrchr(name, '/');
    subject->name = slash ? slash + 1 : name;
    subject->strands = strands;
    for (int i = 0; i < speed->method_count && result == RESULT_OK; ++i) {
        subject->method = speed->methods[i];
        result = interrupt_requested() ? error_set(error, RESULT_INTERRUPTED, "interrupted")
                                       : use(speed, subject, error);
    }
    return result;
}

static Result read_and_use(Speed *speed, const char *set, const char *file,
                           Result (*use)(Speed *speed, const SpeedSubject *subject, Error *error),
                           Error *error)
{
    Strands strands = {0};
    SpeedSubject subject = {.set = set, .file = file};
    Result result = set ? strands_make_set(&strands, set, 1, error)
                        : strands_read(&strands, file, &(StrandsReadOptions){0}, NULL, error);
    if (result == RESULT_OK) result = use_hair(speed, &subject, &strands, use, error);
    strands_destroy(&strands);
    return result;
}

Result speed_for_each(Speed *speed,
                      Result (*use)(Speed *speed, const SpeedSubject *subject, Error *error),
                      Error *error)
{
    static const char *const sets[] = {"1k16", "1k32", "10k16", "10k32"};
    const BenchOptions *options = speed->options;
    bool chosen = options->set || options->tfx;
    Result result = RESULT_OK;
    if (options->set) result = read_and_use(speed, options->set, NULL, use, error);
    if (options->tfx && result == RESULT_OK)
        result = read_and_use(speed, NULL, options->tfx, use, error);
    for (size_t i = 0; i < sizeof sets / sizeof *sets && !chosen && result == RESULT_OK; ++i)
        result = read_and_use(speed, sets[i], NULL, use, error);
    for (int i = 0; i < options->file_count && result == RESULT_OK; ++i)
        result = read_and_use(speed, NULL, options->files[i], use, error);
    return result;
}

// --- The command.

static const struct {
    const char *name;
    Result (*run)(Speed *speed, Error *error);
} PARTS[] = {
    {"memory", cpu_run_memory}, // first: the others have shares of its bandwidth
    {"sets", sets_run},
    {"c", cpu_run_split},
    {"strands", scaling_run_strands},
    {"vertices", scaling_run_vertices},
    {"threads", scaling_run_threads},
    {"start", scaling_run_start},
};
enum { PART_COUNT = sizeof PARTS / sizeof *PARTS };

// Hair that is named without a part is only measured itself.
static bool is_asked(const BenchOptions *options, const char *part)
{
    if (!options->parts && (options->set || options->tfx)) return strcmp(part, "sets") == 0;
    return bench_options_part(options, part);
}

Result speed_run(const BenchOptions *options, const Gpu *gpu, Error *error)
{
    Speed speed = {.gpu = gpu, .options = options};
    const char *names[PART_COUNT + 1] = {NULL};
    for (int i = 0; i < PART_COUNT; ++i) names[i] = PARTS[i].name;
    Result result = bench_options_check_parts(options, names, error);
    if (result != RESULT_OK) return result;
    speed.method_count = method_list(&options->method, speed.methods);
    result = table_open(&speed.table, COLUMNS, sizeof COLUMNS / sizeof *COLUMNS, gpu,
                        &options->output, stdout, error);
    for (int i = 0; i < PART_COUNT && result == RESULT_OK; ++i)
        if (is_asked(options, PARTS[i].name)) result = PARTS[i].run(&speed, error);
    return table_close(&speed.table, result, error);
}
