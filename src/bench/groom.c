// SPDX-License-Identifier: MIT
#include "bench/bench_commands.h"
#include "bench/groom_stage.h"

#include <math.h>
#include <string.h>

// The bounds that motion.md states for the default variant of every solver with a style:
// displacement at rest, volume at rest, and the share of the swing that remains with a balanced
// groom.
static const double REST_MOST = 0.01, VOXELS_LEAST = 0.95, VOXELS_MOST = 1.05, LIFE_LEAST = 0.7;

// Distances are over the strand lengths; depths are in mm; see groom_stage.h. `life`: the swing
// over the swing with --rest hanging.
// clang-format off
#define ROW(X)                                                                                     \
    X(CHARS, hair, 20) X(TEXT, algo, 9) X(REAL, rate, 4)                                           \
    X(REAL, rest, 8) X(REAL, tips, 8) X(REAL, voxels, 7) X(REAL, jitter, 9)                        \
    X(REAL, swing, 7) X(REAL, life, 6) X(REAL, flare, 6) X(REAL, together, 8)                  \
    X(REAL, deep_rest, 9) X(REAL, deep_shake, 10) X(REAL, groom_deep, 0)                           \
    X(REAL, beyond_rest, 0) X(REAL, beyond_shake, 0)                                               \
    X(REAL, ms_min, 7) X(REAL, ms_median, 9) X(TEXT, verdict, 7)                                   \
    X(TEXT, variant, 0) X(TEXT, settings, 0) X(TEXT, head, 0) X(WHOLE, strands, 0)                 \
    X(WHOLE, particles, 0) X(CHARS, command, 0)
// clang-format on

typedef struct Row {
    ROW(TABLE_FIELD)
} Row;
static const Column COLUMNS[] = {ROW(TABLE_COLUMN)};

typedef struct Groom {
    const BenchOptions *options;
    const Gpu *gpu;
    Table table;
    const char *file;
    Method method;
    double rate;
} Groom;

// --- Rows.

static Row row_of(const Groom *groom)
{
    const BenchOptions *options = groom->options;
    const char *name = strrchr(groom->file, '/');
    Row row = {.algo = groom->method.algo, .rate = groom->rate, .verdict = "", .head = "none"};
    for (size_t i = 0; i < sizeof COLUMNS / sizeof *COLUMNS; ++i)
        if (COLUMNS[i].kind == COLUMN_REAL)
            *(double *)(void *)((char *)&row + COLUMNS[i].place) = NAN;
    row.rate = groom->rate;
    row.variant = trial_variant(&groom->method), row.settings = groom->method.settings;
    char words[512], strands[32] = "";
    trial_format(&groom->method, words, sizeof words);
    if (options->strands) snprintf(strands, sizeof strands, " --strands %d", options->strands);
    snprintf(row.hair, sizeof row.hair, "%s", name ? name + 1 : groom->file);
    snprintf(row.command, sizeof row.command, "tractrix-bench groom %s%s%s %s --rates %.9g%s%s%s%s",
             groom->file, options->mesh ? " --mesh " : "", options->mesh ? options->mesh : "",
             words, groom->rate, strands, options->render ? " --render='" : "",
             options->render ? options->render : "", options->render ? "'" : "");
    return row;
}

static void describe(Row *row, const GroomStage *stage)
{
    row->strands = stage->shape.strand_count;
    row->particles = stage->shape.first[stage->shape.strand_count];
    row->head = *stage->scene.bodies[0].params.mesh    ? "mesh"
                : stage->assets.meshes[0].vertex_count ? "fitted"
                                                       : "none";
}

// --- One method on one file at one rate.

// `locks`: measure how strands stay together during the shake.
static Result open_stage(GroomStage *stage, const Groom *groom, const Method *method, bool shaking,
                         bool locks, Error *error)
{
    const BenchOptions *options = groom->options;
    const GroomSetup setup = {.file = groom->file,
                              .mesh = options->mesh,
                              .flags = options->render ? options->render : "",
                              .method = *method,
                              .rate = groom->rate,
                              .strands = options->strands,
                              .shaking = shaking,
                              .locks = locks};
    return groom_stage_create(stage, groom->gpu, &setup, error);
}

static const double MM = 1e3;

static Result measure_rest(const Groom *groom, Row *row, Error *error)
{
    GroomStage stage;
    GroomRest rest;
    Result result = open_stage(&stage, groom, &groom->method, false, false, error);
    THEN(result, groom_stage_rest(&stage, &rest, error));
    if (result == RESULT_OK) {
        describe(row, &stage);
        row->rest = rest.mean, row->tips = rest.tips, row->voxels = rest.voxels;
        row->jitter = rest.jitter;
        row->deep_rest = MM * rest.deepest, row->beyond_rest = MM * rest.beyond;
    }
    groom_stage_destroy(&stage);
    return result;
}

static Result measure_shake(const Groom *groom, Row *row, bool timed, bool measured, Error *error)
{
    GroomStage stage;
    GroomShake shake;
    Result result = open_stage(&stage, groom, &groom->method, true, measured, error);
    THEN(result, groom_stage_shake(&stage, &shake, error));
    if (result == RESULT_OK) describe(row, &stage);
    if (result == RESULT_OK && timed)
        row->ms_min = shake.step.minimum, row->ms_median = shake.step.median;
    if (result == RESULT_OK && measured) {
        row->swing = shake.swing, row->flare = shake.flare;
        row->together = shake.together;
        row->deep_shake = MM * shake.deepest, row->beyond_shake = MM * shake.beyond;
    }
    groom_stage_destroy(&stage);
    return result;
}

static const SolverType *type_of(const Method *method)
{
    for (const SolverType *const *type = SOLVER_TYPES; *type; ++type)
        if (strcmp((*type)->name, method->algo) == 0) return *type;
    return NULL;
}

// Whether --rest changes the motion of this method.
static bool has_life(const Method *method)
{
    return params_find("rest") && !strstr(method->settings, "--rest ") &&
           !solver_is_static(type_of(method));
}

// Measures the swing with --rest hanging, where the groom is not balanced, and sets row->life.
static Result measure_life(const Groom *groom, Row *row, Error *error)
{
    GroomStage stage;
    GroomShake shake;
    char settings[1024];
    Method hanging = groom->method;
    if (!has_life(&hanging)) return RESULT_OK;
    snprintf(settings, sizeof settings, "%s --rest hanging", hanging.settings);
    hanging.settings = settings;
    Result result = open_stage(&stage, groom, &hanging, true, false, error);
    THEN(result, groom_stage_shake(&stage, &shake, error));
    if (result == RESULT_OK) row->life = row->swing / shake.swing;
    groom_stage_destroy(&stage);
    return result;
}

// --- Bounds.

static bool has_bounds(const Method *method)
{
    return type_of(method)->style && trial_is_default(method);
}

// The worse of two verdicts: "broken" before "holds" before "".
static const char *worse(const char *a, const char *b)
{
    return strcmp(a, "broken") == 0 || !*b ? a : b;
}

static void check_row(Groom *groom, Row *row, bool rest, bool shake)
{
    Table *table = &groom->table;
    if (!has_bounds(&groom->method)) return;
    if (rest) {
        row->verdict =
            worse(row->verdict, table_check(table, row->rest, REST_MOST, "%s, %s, %g Hz, rest",
                                            row->hair, row->algo, row->rate));
        row->verdict = worse(row->verdict, table_check_within(table, row->voxels, VOXELS_LEAST,
                                                              VOXELS_MOST, "%s, %s, %g Hz, voxels",
                                                              row->hair, row->algo, row->rate));
    }
    if (shake && has_life(&groom->method))
        row->verdict = worse(row->verdict, table_check_within(table, row->life, LIFE_LEAST,
                                                              INFINITY, "%s, %s, %g Hz, life",
                                                              row->hair, row->algo, row->rate));
}

// --- All rows.

static Result run_row(Groom *groom, Error *error)
{
    const BenchOptions *options = groom->options;
    bool rest = bench_options_part(options, "rest"), shake = bench_options_part(options, "shake"),
         speed = bench_options_part(options, "speed");
    Row row = row_of(groom);
    if (rest) TRY(measure_rest(groom, &row, error));
    if (shake || speed) TRY(measure_shake(groom, &row, speed, shake, error));
    if (shake) TRY(measure_life(groom, &row, error));
    check_row(groom, &row, rest, shake);
    table_add(&groom->table, &row);
    return RESULT_OK;
}

static Result run_file(Groom *groom, Error *error)
{
    static const double usual[] = {60, 240};
    const BenchOptions *options = groom->options;
    const double *rates = options->rate_count ? options->rates : usual;
    int rate_count = options->rate_count ? options->rate_count : 2;
    Method methods[METHODS_MOST];
    int method_count = trial_list(&options->method, methods);
    for (int m = 0; m < method_count; ++m)
        for (int i = 0; i < rate_count; ++i) {
            groom->method = methods[m], groom->rate = rates[i];
            TRY(run_row(groom, error));
        }
    return RESULT_OK;
}

Result groom_run(const BenchOptions *options, const Gpu *gpu, Error *error)
{
    static const char *const parts[] = {"rest", "shake", "speed", NULL};
    Groom groom = {.options = options, .gpu = gpu};
    TRY(bench_options_check_parts(options, parts, error));
    if (options->file_count == 0)
        return error_set(error, RESULT_USAGE, "groom: expected hair files");
    Result result = table_open(&groom.table, TABLE_COLUMNS, gpu, &options->output, stdout, error);
    for (int i = 0; i < options->file_count && result == RESULT_OK; ++i) {
        groom.file = options->files[i];
        result = run_file(&groom, error);
    }
    return table_close(&groom.table, result, error);
}
