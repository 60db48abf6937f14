// SPDX-License-Identifier: MIT
#include "base/clock.h"
#include "base/interrupt.h"
#include "base/outfile.h"
#include "bench/bench_commands.h"
#include "bench/child.h"
#include "bench/cpu_split.h"
#include "bench/trial.h"
#include "bench/waited.h"
#include "draw/renderer.h"
#include "formats/strands_read.h"
#include "gen/strands_make.h"
#include "sim/simulation.h"
#include "strands/paint.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// ms: one step of the hair and the computation of drawn positions. solve_ms: the step without drawn
// positions. draw_ms: drawing and reading back. `hair`: file name without folders. `vertices`: of
// the first strand. `threads`: of the driver or the program, 0: their default. `thesis_ms`: the
// time that the thesis states for its GPU; `bound_ms`: the time that our docs state. `bytes`: size
// of the buffers that a step and its pose use, counted once for reading and once for writing.
// `exponent`: of a power law fitted to the rows of a part. `first_ms`: the first step, with shader
// compilation unless the driver has cached it. `process_ms`: wall time of a separate process.
// `off`: RMS distance from the GPU's strands, over the length. `waited`: share of the steps' time
// in which threads of this program waited for a processor.
// clang-format off
#define ROW(X)                                                                                     \
    X(TEXT, part, 8) X(CHARS, hair, 20) X(TEXT, algo, 9) X(TEXT, variant, 9) X(TEXT, settings, 0)  \
    X(WHOLE, strands, 8) X(WHOLE, vertices, 8) X(WHOLE, particles, 9) X(WHOLE, threads, 7)         \
    X(REAL, ms_min, 8) X(REAL, ms_q1, 8) X(REAL, ms_median, 9) X(REAL, ms_q3, 8)                   \
    X(REAL, solve_ms_min, 0) X(REAL, solve_ms_median, 0) X(REAL, ns_particle, 11)                  \
    X(REAL, thesis_ms, 9) X(REAL, bound_ms, 8) X(TEXT, verdict, 7) X(WHOLE, bytes, 10)             \
    X(REAL, gb_s, 7) X(REAL, bandwidth_share, 15) X(REAL, exponent, 8) X(REAL, spread, 8)          \
    X(REAL, first_ms, 8) X(REAL, process_ms, 10) X(REAL, draw_ms_min, 11)                          \
    X(REAL, draw_ms_median, 0) X(WHOLE, fragments, 0) X(REAL, off, 9) X(TEXT, remark, 1)           \
    X(REAL, waited, 0) X(CHARS, command, 0)
// clang-format on

typedef struct Row {
    ROW(TABLE_FIELD)
    const char *set, *file; // the hair's source; both NULL: the part makes it
    Method method;
    double off_bound; // the bound of `off`
} Row;
static const Column COLUMNS[] = {ROW(TABLE_COLUMN)};

typedef struct Speed {
    const Gpu *gpu;
    const BenchOptions *options;
    Table table;
    Method methods[METHODS_MOST];
    int method_count;
    double bandwidth; // GB/s of the memory; measured once
} Speed;

// --- Rows.

// A row of a part. Its hair comes from a set or a file or, if both are NULL, has a name of its own.
static Row row_of(const char *part, const char *set, const char *file, const char *name)
{
    Row row = {.part = part, .set = set, .file = file, .method = {"", "", ""}, .remark = ""};
    row.ms_min = row.ms_q1 = row.ms_median = row.ms_q3 = row.solve_ms_min = row.solve_ms_median =
        NAN;
    row.draw_ms_min = row.draw_ms_median = row.first_ms = row.gb_s = NAN;
    row.thesis_ms = row.bound_ms = row.waited = NAN;
    row.exponent = row.spread = row.process_ms = row.off = row.off_bound = NAN;
    if (!name) name = set ? set : file ? file : "";
    const char *slash = strrchr(name, '/');
    snprintf(row.hair, sizeof row.hair, "%s", slash ? slash + 1 : name);
    return row;
}

static void set_times(Row *row, Times times)
{
    row->ms_min = times.minimum, row->ms_median = times.median;
    row->ms_q1 = times.lower_quartile, row->ms_q3 = times.upper_quartile;
}

static void count_strands(Row *row, const Strands *strands)
{
    row->strands = strands->strand_count;
    row->particles = strands->vertex_count;
    row->vertices = strands->first[1];
}

// Checks the bound and adds the row, with derived columns and the command that repeats it.
static void add_row(Speed *speed, Row *row)
{
    char method[256] = "", hair[128] = "", size[64] = "";
    double least = row->ms_min;
    row->algo = row->method.algo, row->settings = row->method.settings;
    row->variant = *row->method.algo ? trial_variant(&row->method) : "";
    row->ns_particle = row->particles ? least * 1e6 / (double)row->particles : NAN;
    if (row->bytes) row->gb_s = (double)row->bytes / least * 1e-6;
    row->bandwidth_share = speed->bandwidth > 0 ? row->gb_s / speed->bandwidth : NAN;
    if (!isnan(row->bound_ms) && row->waited > WAITED_MOST)
        row->verdict = "not measured"; // the machine was busy
    else
        row->verdict = isnan(row->off_bound)
                           ? table_check(&speed->table, least, row->bound_ms,
                                         "%s, %s: least ms a step", row->hair, row->method.algo)
                           : table_check(&speed->table, row->off, row->off_bound,
                                         "%s, %s: off the GPU's strands", row->hair, row->remark);
    if (*row->method.algo) trial_format(&row->method, method, sizeof method);
    if (row->set) snprintf(hair, sizeof hair, " --set %s", row->set);
    if (row->file) snprintf(hair, sizeof hair, " --tfx %s", row->file);
    if (!isnan(row->draw_ms_min))
        snprintf(size, sizeof size, " --size %dx%d", speed->options->size[0],
                 speed->options->size[1]);
    snprintf(row->command, sizeof row->command, "tractrix-bench speed --part %s %s%s%s", row->part,
             method, hair, size);
    table_add(&speed->table, row);
}

// --- One step, in a scene with one section, as the command line would make it.

// Counts each buffer of the solver's state as read and written, the drawn positions as written
// (unless they are part of the state), and the style as read. Repeated accesses and other buffers
// are not counted.
static long count_bytes(const SimulationSection *section)
{
    long bytes = 0;
    for (uint32_t i = 0; i < section->hair.batch_count; ++i) {
        const HairBatch *batch = &section->hair.batches[i];
        SolverBuffer buffers[SOLVER_MAX_BUFFERS];
        int count = solver_buffers(&section->solver, i, buffers);
        bool drawn = false;
        for (int b = 0; b < count; ++b) {
            bytes += 2 * (long)buffers[b].buffer->size;
            drawn = drawn || buffers[b].buffer == &batch->position;
        }
        bytes += (long)batch->rest.size + (drawn ? 0 : (long)batch->position.size);
    }
    return bytes;
}

static Result measure_steps(Row *row, Simulation *simulation, const BenchOptions *options,
                            Error *error)
{
    double *step = calloc(2 * (size_t)options->steps, sizeof *step);
    if (!step) return error_set(error, RESULT_FAILED, "no memory for %d samples", options->steps);
    double *solve = step + options->steps;
    for (int i = -options->warm_up - 1; i < options->steps; ++i) {
        double begin = clock_ms();
        simulation_advance(simulation);
        glFinish();
        double solved = clock_ms();
        simulation_pose(simulation);
        glFinish();
        double end = clock_ms();
        if (i == -options->warm_up - 1) row->first_ms = end - begin;
        if (i >= 0) step[i] = end - begin, solve[i] = solved - begin;
    }
    set_times(row, table_times(step, options->steps));
    Times solved = table_times(solve, options->steps);
    row->solve_ms_min = solved.minimum, row->solve_ms_median = solved.median;
    row->bytes = count_bytes(&simulation->sections[0]);
    free(step);
    return gpu_check("steps", error);
}

enum { DRAWN_FRAMES = 20, DRAWN_WARM_UP = 3 };

static Result draw_frames(Row *row, Renderer *renderer, Simulation *simulation, const Scene *scene,
                          const Strands *strands, Image *image, Error *error)
{
    double samples[DRAWN_FRAMES] = {0};
    Framing framing;
    View view;
    outline_frame(&framing, scene, strands, NULL);
    const RenderItem item = {.hair = &simulation->sections[0].hair,
                             .material = &scene->sections[0].params,
                             .radius = paint_auto_radius(strands, 0)};
    const RenderFrame frame = {.view = &view,
                               .lights = scene->lights,
                               .light_count = scene->light_count,
                               .head_rotation = {0, 0, 0, 1}};
    for (int i = -DRAWN_WARM_UP; i < DRAWN_FRAMES; ++i) {
        camera_view(&view, scene, &framing, 0);
        simulation_advance(simulation);
        simulation_pose(simulation);
        glFinish();
        double begin = clock_ms();
        TRY(renderer_draw(renderer, &frame, &item, 1, image, error));
        if (i >= 0) samples[i] = clock_ms() - begin;
    }
    Times drawn = table_times(samples, DRAWN_FRAMES);
    row->draw_ms_min = drawn.minimum, row->draw_ms_median = drawn.median;
    row->fragments = (long)renderer->counts.fragments;
    return RESULT_OK;
}

static Result measure_drawing(Row *row, Simulation *simulation, Scene *scene,
                              const Strands *strands, const Gpu *gpu, const BenchOptions *options,
                              Error *error)
{
    Renderer renderer;
    Image image = {0};
    const int *size = options->size;
    const RendererOptions how = {.raster = options->scheme.raster,
                                 .width = size[0],
                                 .height = size[1],
                                 .background = {0.2f, 0.2f, 0.2f, 1}};
    if (size[0] == 0) return RESULT_OK;
    memcpy(scene->run.size, size, sizeof scene->run.size);
    TRY(renderer_create(&renderer, gpu, simulation->timer, &how, error));
    Result result = image_create(&image, size[0], size[1], renderer_channels(&renderer), error);
    THEN(result, draw_frames(row, &renderer, simulation, scene, strands, &image, error));
    image_destroy(&image);
    renderer_destroy(&renderer);
    return result;
}

// Measures steps of row->method on the strands and, if a size is set, images.
static Result measure(Row *row, const Gpu *gpu, const Strands *strands, const BenchOptions *options,
                      Error *error)
{
    Scene scene = {0};
    GpuTimer timer;
    SectionParams params;
    Simulation simulation = {0};
    count_strands(row, strands);
    gpu_timer_create(&timer, false, true);
    Result result = trial_params(&params, &row->method, "", error);
    THEN(result, scene_create_as(&scene, &(Presets){.look = "plain"}, error));
    params.sleep = 0; // hair that sleeps would take no time
    params.followers = (AutoInt){.value = 0};
    THEN(result, scene_add_section(&scene, row->hair, &params, error));
    params_destroy_section(&params);
    THEN(result, simulation_create(&simulation, gpu, &timer, &scene, strands, NULL, error));
    const Waited before = waited_now();
    THEN(result, measure_steps(row, &simulation, options, error));
    row->waited = waited_since(before);
    THEN(result, measure_drawing(row, &simulation, &scene, strands, gpu, options, error));
    if (simulation.scene) simulation_destroy(&simulation);
    gpu_timer_destroy(&timer);
    scene_destroy(&scene);
    return result;
}

// --- The hair to measure.

typedef Result UseHair(Speed *speed, Row *row, const Strands *strands, Error *error);

static Result use_methods(Speed *speed, const char *part, const char *set, const char *file,
                          UseHair *use, Error *error)
{
    Strands strands = {0};
    Result result = set ? strands_make_set(&strands, set, 1, error)
                        : strands_read(&strands, file, &(StrandsReadOptions){0}, NULL, error);
    for (int i = 0; i < speed->method_count && result == RESULT_OK; ++i) {
        Row row = row_of(part, set, file, NULL);
        row.method = speed->methods[i];
        result = interrupt_requested() ? error_set(error, RESULT_INTERRUPTED, "interrupted")
                                       : use(speed, &row, &strands, error);
    }
    strands_destroy(&strands);
    return result;
}

// Calls `use` for --set and --tfx or, without both, for all sets of the thesis and the named files.
static Result for_each(Speed *speed, const char *part, UseHair *use, Error *error)
{
    static const char *const sets[] = {"1k16", "1k32", "10k16", "10k32"};
    const BenchOptions *options = speed->options;
    bool chosen = options->set || options->tfx;
    if (options->set) TRY(use_methods(speed, part, options->set, NULL, use, error));
    if (options->tfx) TRY(use_methods(speed, part, NULL, options->tfx, use, error));
    for (size_t i = 0; i < sizeof sets / sizeof *sets && !chosen; ++i)
        TRY(use_methods(speed, part, sets[i], NULL, use, error));
    for (int i = 0; i < options->file_count; ++i)
        TRY(use_methods(speed, part, NULL, options->files[i], use, error));
    return RESULT_OK;
}

// thesis_ms: table 4.2 of the thesis, ms a step on a GTX 1080 Ti. Its Mohawk and Short are one
// scene, which is not among these sets. bound_ms: the bound of the least ms for the default
// variants on llvmpipe with two cores. The least is used because other load of the machine only
// adds time.
static const struct {
    const char *set, *algo;
    double thesis_ms, bound_ms; // 0: nothing
} STATED[] = {
    {"1k16", "emulation", 3.5, 1.5}, {"1k16", "split", 0.4, 0},     {"1k32", "emulation", 42.5, 0},
    {"1k32", "split", 0.75, 0},      {"10k16", "emulation", 31, 0}, {"10k16", "split", 1.4, 0},
    {"10k32", "emulation", 410, 60}, {"10k32", "split", 5.9, 0},    {"10k32", "hybrid", 0, 12},
    {"10k32", "chain", 0, 15},       {"10k32", "tressfx", 0, 15},
};

static Result measure_set(Speed *speed, Row *row, const Strands *strands, Error *error)
{
    bool plain = trial_is_default(&row->method);
    bool thesis = plain || strcmp(row->method.variant, "thesis") == 0;
    TRY(measure(row, speed->gpu, strands, speed->options, error));
    for (size_t i = 0; i < sizeof STATED / sizeof *STATED && row->set; ++i) {
        if (strcmp(STATED[i].set, row->set) != 0 || strcmp(STATED[i].algo, row->method.algo) != 0)
            continue;
        if (thesis && STATED[i].thesis_ms > 0) row->thesis_ms = STATED[i].thesis_ms;
        if (plain && STATED[i].bound_ms > 0 && strstr(speed->gpu->renderer, "llvmpipe"))
            row->bound_ms = STATED[i].bound_ms;
    }
    add_row(speed, row);
    return RESULT_OK;
}

// --- What the processor can do: memory bandwidth, and split in C.

static Result run_memory(Speed *speed, Error *error)
{
    Row row = row_of("memory", NULL, NULL, NULL);
    Times times;
    double bytes;
    int threads;
    TRY(cpu_split_time_memory(&times, &bytes, &threads, error));
    set_times(&row, times);
    speed->bandwidth = row.gb_s = bytes / times.minimum * 1e-6;
    row.threads = threads;
    row.remark = "a = b + 3 c, 3 x 64 MiB";
    add_row(speed, &row);
    return RESULT_OK;
}

#define RATE 60.0

// Simulates one second from rest with both programs. `off`: the RMS distance over the length of all
// particles but roots.
static Result compare_split(const Gpu *gpu, const Strands *strands, CpuSplit *split,
                            CpuSplitForm form, double *off, Error *error)
{
    const Method method = {"split", "", "--style 0 --drag 1"};
    SectionParams params = {0};
    Trial trial = {0};
    float(*own)[3] = calloc(strands->vertex_count, sizeof *own);
    double sum = 0, length = cpu_split_length(split);
    Result result = own ? trial_params(&params, &method, "", error)
                        : error_set(error, RESULT_FAILED, "no memory for positions");
    THEN(result, trial_create(&trial, gpu, strands, 0, &params, RATE, error));
    for (int i = 0; i < (int)RATE && result == RESULT_OK; ++i) {
        trial_step(&trial);
        cpu_split_time(split, 1 / RATE, 1, i == 0);
        cpu_split_step(split, form, 0, split->tile_count);
    }
    THEN(result, trial_read(&trial, error));
    if (result == RESULT_OK) cpu_split_read(split, own);
    uint32_t count = result == RESULT_OK ? strands->vertex_count : 0;
    for (uint32_t i = 0; i < count; ++i)
        for (int k = 0; k < 3; ++k) sum += pow((double)own[i][k] - (double)trial.points[i][k], 2);
    *off = sqrt(sum / (double)(count - strands->strand_count)) / length;
    trial_destroy(&trial);
    params_destroy_section(&params);
    free(own);
    return result;
}

static Result measure_form(Speed *speed, Row *row, const Strands *strands, CpuSplitForm form,
                           Error *error)
{
    const BenchOptions *options = speed->options;
    char lanes[64];
    CpuSplit split;
    snprintf(lanes, sizeof lanes, "plain C, %d strands side by side, %s", CPU_SPLIT_WIDTH,
             cpu_split_lanes());
    row->remark = form == CPU_SPLIT_LANES ? lanes : "plain C, scalar";
    row->off_bound = 1e-4;
    count_strands(row, strands);
    Result result = cpu_split_create(&split, strands, error);
    THEN(result, compare_split(speed->gpu, strands, &split, form, &row->off, error));
    cpu_split_time(&split, 1 / RATE, 1, false);
    for (int threads = 1; threads <= 2 && result == RESULT_OK; ++threads) {
        row->threads = threads;
        row->bytes = 8 * (long)split.tile_count * CPU_SPLIT_WIDTH * 4 * (long)split.link_count;
        Times times = {0};
        result = cpu_split_time_steps(&times, &split, form, threads, options->steps,
                                      options->warm_up, error);
        set_times(row, times);
        if (result == RESULT_OK) add_row(speed, row);
    }
    cpu_split_destroy(&split);
    return result;
}

static Result measure_split(Speed *speed, Row *row, const Strands *strands, Error *error)
{
    bool alike = true;
    for (uint32_t s = 0; s < strands->strand_count; ++s)
        alike = alike && strands->first[s + 1] - strands->first[s] == strands->first[1];
    if (strcmp(row->method.algo, "split") != 0 || !trial_is_default(&row->method) || !alike)
        return RESULT_OK;
    TRY(measure_form(speed, row, strands, CPU_SPLIT_SCALAR, error));
    return measure_form(speed, row, strands, CPU_SPLIT_LANES, error);
}

// --- Growth of times with the size of the hair.

enum { MOST_SIZES = 8 };

// Reduces the number of steps so that a row takes about half a second, but to no fewer than 3.
static BenchOptions fewer_steps(const Speed *speed, uint64_t particles)
{
    BenchOptions options = *speed->options;
    double most = fmax(3, 1e7 / (double)particles);
    if (options.steps > most) options.steps = (int)most;
    if (options.warm_up > options.steps / 3) options.warm_up = options.steps / 3;
    options.size[0] = 0;
    return options;
}

// Adds a row for each method and size {strands, vertices of each}, and for each method the exponent
// of the least time as a power of sizes[i][by].
static Result measure_growth(Speed *speed, const char *part, const uint32_t (*sizes)[2],
                             int size_count, int by, Error *error)
{
    double least[METHODS_MOST][MOST_SIZES], size[MOST_SIZES];
    for (int i = 0; i < size_count; ++i) {
        char name[64];
        Strands strands = {0};
        StrandsRecipe recipe = strands_make_recipe(STRANDS_STYLE_RANDOM);
        recipe.count = sizes[i][0], recipe.vertices = sizes[i][1], size[i] = sizes[i][by];
        snprintf(name, sizeof name, "%u x %u", recipe.count, recipe.vertices);
        Result result = strands_make(&strands, &recipe, error);
        for (int m = 0; m < speed->method_count && result == RESULT_OK; ++m) {
            const BenchOptions options = fewer_steps(speed, strands.vertex_count);
            Row row = row_of(part, NULL, NULL, name);
            row.method = speed->methods[m];
            if (interrupt_requested()) result = error_set(error, RESULT_INTERRUPTED, "interrupted");
            THEN(result, measure(&row, speed->gpu, &strands, &options, error));
            least[m][i] = row.ms_min;
            if (result == RESULT_OK) add_row(speed, &row);
        }
        strands_destroy(&strands);
        TRY(result);
    }
    for (int m = 0; m < speed->method_count; ++m) {
        Row row = row_of(part, NULL, NULL, "all of these");
        row.method = speed->methods[m];
        row.exponent = table_slope(size, least[m], size_count, &row.spread);
        add_row(speed, &row);
    }
    return RESULT_OK;
}

static Result run_strands(Speed *speed, Error *error)
{
    static const uint32_t sizes[][2] = {{1000, 16}, {10000, 16}, {100000, 16}, {1000000, 16}};
    return measure_growth(speed, "strands", sizes, 4, 0, error);
}

static Result run_vertices(Speed *speed, Error *error)
{
    static const uint32_t sizes[][2] = {
        {10000, 4}, {10000, 8}, {10000, 16}, {10000, 32}, {10000, 64}};
    return measure_growth(speed, "vertices", sizes, 5, 1, error);
}

// --- Measurements in separate processes.

static Row child_row(const Speed *speed, const char *part, const char *set, int method)
{
    const BenchOptions *options = speed->options;
    const char *own = options->set ? options->set : set;
    Row row = row_of(part, options->tfx ? NULL : own, options->tfx, NULL);
    row.method = speed->methods[method];
    return row;
}

// Runs part "sets" in a process with the environment variable set, and copies its times to the row.
static Result measure_child(Row *row, const BenchOptions *options, int steps, int warm_up,
                            const char *variable, const char *value, Error *error)
{
    const ChildRun run = {.method = &row->method,
                          .set = row->set,
                          .file = row->file,
                          .steps = steps,
                          .warm_up = warm_up,
                          .gpu = &options->gpu,
                          .variable = variable,
                          .value = value};
    json_t *from = NULL;
    if (interrupt_requested()) return error_set(error, RESULT_INTERRUPTED, "interrupted");
    TRY(child_run(&run, &from, &row->process_ms, error));
    row->strands = (long)child_number(from, "strands");
    row->vertices = (long)child_number(from, "vertices");
    row->particles = (long)child_number(from, "particles");
    row->first_ms = child_number(from, "first_ms");
    row->ms_min = child_number(from, "ms_min"), row->ms_median = child_number(from, "ms_median");
    row->ms_q1 = child_number(from, "ms_q1"), row->ms_q3 = child_number(from, "ms_q3");
    json_decref(from);
    return RESULT_OK;
}

static Result run_threads(Speed *speed, Error *error)
{
    static const double threads[] = {1, 2};
    const BenchOptions options = fewer_steps(speed, 320000);
    bool known = strstr(speed->gpu->renderer, "llvmpipe") != NULL;
    for (int m = 0; m < speed->method_count && known; ++m) {
        double least[2] = {NAN, NAN};
        for (int i = 0; i < 2; ++i) {
            Row row = child_row(speed, "threads", "10k32", m);
            row.threads = i + 1;
            TRY(measure_child(&row, &options, options.steps, options.warm_up, "LP_NUM_THREADS",
                              i ? "2" : "1", error));
            least[i] = row.ms_min;
            add_row(speed, &row);
        }
        Row row = child_row(speed, "threads", "10k32", m);
        row.exponent = table_slope(threads, least, 2, &row.spread);
        add_row(speed, &row);
    }
    return RESULT_OK;
}

static Result run_start(Speed *speed, Error *error)
{
    for (int m = 0; m < speed->method_count; ++m) {
        char cache[PATH_MAX];
        Result result = RESULT_OK;
        TRY(outfile_make_scratch_folder(cache, "tractrix-cache", error));
        for (int warm = 0; warm < 2 && result == RESULT_OK; ++warm) {
            Row row = child_row(speed, "start", "1k16", m);
            result =
                measure_child(&row, speed->options, 1, 0, "MESA_SHADER_CACHE_DIR", cache, error);
            set_times(&row, table_times(NULL, 0)); // the time of a single step is not meaningful
            row.remark = warm ? "warm" : "cold";
            if (result == RESULT_OK) add_row(speed, &row);
        }
        outfile_remove_scratch_folder(cache);
        TRY(result);
    }
    return RESULT_OK;
}

// --- The command.

static const struct {
    const char *name;
    Result (*run)(Speed *speed, Error *error);
    UseHair *use; // called for all hair, instead of `run`
} PARTS[] = {
    {"memory", run_memory, NULL}, // must be first: other parts divide by its bandwidth
    {"sets", NULL, measure_set},    {"c", NULL, measure_split},
    {"strands", run_strands, NULL}, {"vertices", run_vertices, NULL},
    {"threads", run_threads, NULL}, {"start", run_start, NULL},
};
enum { PART_COUNT = sizeof PARTS / sizeof *PARTS };

Result speed_run(const BenchOptions *options, const Gpu *gpu, Error *error)
{
    Speed speed = {.gpu = gpu, .options = options};
    const char *names[PART_COUNT + 1] = {NULL};
    // If hair is named without a part, only part "sets" runs.
    bool sets = !options->parts && (options->set || options->tfx);
    for (int i = 0; i < PART_COUNT; ++i) names[i] = PARTS[i].name;
    TRY(bench_options_check_parts(options, names, error));
    speed.method_count = trial_list(&options->method, speed.methods);
    Result result = table_open(&speed.table, TABLE_COLUMNS, gpu, &options->output, stdout, error);
    for (int i = 0; i < PART_COUNT; ++i) {
        bool asked = sets ? PARTS[i].use == measure_set : bench_options_part(options, names[i]);
        if (!asked) continue;
        if (PARTS[i].use) THEN(result, for_each(&speed, names[i], PARTS[i].use, error));
        if (PARTS[i].run) THEN(result, PARTS[i].run(&speed, error));
    }
    return table_close(&speed.table, result, error);
}
