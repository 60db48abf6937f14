// SPDX-License-Identifier: MIT
// tractrix-bench: measures the accuracy of the tractrix and of solvers, the speed of solvers and of
// drawing, and compiles all shaders.
#include "base/paths.h"
#include "base/program.h"
#include "base/quote.h"
#include "base/suggest.h"
#include "bench/bench_commands.h"
#include "bench/bench_glsl.h"
#include "bench/stress.h"
#include "bench/test_vectors.h"
#include "draw/renderer.h"
#include "draw/scatter_tables.h"
#include "gen/strands_make.h"
#include "passes/passes.h"
#include "sim/follow.h"
#include "sim/inbetween.h"
#include "sim/pose.h"
#include "sim/simulation.h"
#include "sim/volume.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static Result run_stress(const BenchOptions *arguments, const Gpu *gpu, Error *error)
{
    const char *variant = arguments->method.variant;
    StressOptions options = arguments->stress;
    TRY(bench_options_one_algo(arguments, error));
    options.algo = arguments->method.algo, options.variant = *variant ? variant : NULL;
    if (*arguments->method.settings)
        return error_set(
            error, RESULT_USAGE,
            "stress: %s: the stress test chooses this value at random: expected --case to set it",
            arguments->method.settings);
    return stress_search(gpu, &options, &arguments->output, stdout, error);
}

// --- Compiles every shader variant that the programs can ask for, with warnings as errors. Prints
// a line for each. If some fail, returns RESULT_FAILED with the first message after trying all.

static void report(const char *what, Result result, const Error *why, Result *worst, FILE *stream,
                   Error *error)
{
    fprintf(stream, "%-40s %s\n", what, result == RESULT_OK ? "ok" : why->text);
    if (result == RESULT_OK || *worst != RESULT_OK) return;
    *worst = result;
    *error = *why;
}

// Makes a solver for four strands or, with params->followers, for followers of four strands.
static Result try_hair(const Gpu *gpu, const SectionParams *params, const StrandsRecipe *recipe,
                       const Colliders *colliders, Error *error)
{
    Strands strands = {0};
    Hair hair = {0};
    Solver solver = {0};
    Follow follow = {0};
    Volume volume = {0};
    const SolverSetup setup = {.gpu = gpu,
                               .hair = &hair,
                               .params = params,
                               .colliders = colliders,
                               .sheltered = params->style == 1,
                               .rest_gravity = {0, params->volume > 0 ? -9.81f : 0, 0}};
    Result result = strands_make(&strands, recipe, error);
    THEN(result, hair_create(&hair, &strands, 0, &gpu->limits, error));
    THEN(result, params->followers.value
                     ? follow_create(&follow, gpu, NULL, &hair, &strands, params, 1, error)
                     : solver_create(&solver, &setup, error));
    if (solver.type) THEN(result, volume_create(&volume, gpu, NULL, &hair, &solver, params, error));
    volume_destroy(&volume);
    follow_destroy(&follow);
    solver_destroy(&solver);
    hair_destroy(&hair);
    strands_destroy(&strands);
    return result;
}

// The properties of hair that a solver's programs depend on.
typedef struct SolverShape {
    uint32_t vertices;
    float style, style_of_tip;
    float volume; // > 0: --volume, and the groom is the rest pose
} SolverShape;

static Result try_solver(const Gpu *gpu, const SolverType *type, const char *variant,
                         const SolverShape *shape, Error *error)
{
    StrandsRecipe recipe = strands_make_recipe(STRANDS_STYLE_RANDOM);
    recipe.count = 4, recipe.vertices = shape->vertices;
    float style = shape->style;
    Profile along = {.count = style != shape->style_of_tip ? 2 : 0,
                     .at = {0, 1},
                     .value = {style, shape->style_of_tip}};
    const SectionParams params = {.algo = (char *)type->name,
                                  .variant = (char *)variant,
                                  .style = style,
                                  .style_along = along,
                                  .volume = shape->volume,
                                  .style_stiffness = 200,
                                  .clamped = style < 1 ? 1 : 2,
                                  .youngs_modulus = style < 1 ? 3.5f : 0,
                                  .hair_radius = 35,
                                  .hair_density = 1300};
    return try_hair(gpu, &params, &recipe, NULL, error);
}

// Compiles the collision shaders for the kind of state that the solver has.
static Result try_collide(const Gpu *gpu, const char *algo, const char *shapes, Error *error)
{
    StrandsRecipe recipe = strands_make_recipe(STRANDS_STYLE_RANDOM);
    const SectionParams params = {.algo = (char *)algo, .variant = "", .collide = true};
    Colliders colliders = {0};
    recipe.count = 4;
    Result result = colliders_parse(&colliders, shapes, error);
    THEN(result, try_hair(gpu, &params, &recipe, &colliders, error));
    colliders_destroy(&colliders);
    return result;
}

static void try_collisions(const Gpu *gpu, Result *worst, FILE *stream, Error *error)
{
    static const char *const shapes[] = {"sphere:0,0,0,0.1; capsule:0,0,0,0.1,0,-0.1,0,0.1",
                                         "sphere:0,0,0,0.1; ground:0; plane:0,1,0,0"},
                             *const algos[] = {"chain", "split"};
    for (size_t i = 0; i < 4; ++i) {
        char what[128];
        Error why = {{0}};
        snprintf(what, sizeof what, "%s, %s", algos[i / 2], shapes[i % 2]);
        report(what, try_collide(gpu, algos[i / 2], shapes[i % 2], &why), &why, worst, stream,
               error);
    }
}

static Result try_follow(const Gpu *gpu, FollowMode mode, Error *error)
{
    StrandsRecipe recipe = strands_make_recipe(STRANDS_STYLE_FUR);
    const SectionParams params = {.followers = {.value = 1}, .follow = (int)mode};
    recipe.count = 4;
    return try_hair(gpu, &params, &recipe, NULL, error);
}

static Result try_inbetween(const Gpu *gpu, Error *error)
{
    const Hair bald = {0};
    Inbetween inbetween;
    Result result = inbetween_create(&inbetween, gpu, &bald, NULL, error);
    inbetween_destroy(&inbetween);
    return result;
}

static void try_solvers(const Gpu *gpu, Result *worst, FILE *stream, Error *error)
{
    // With strands in registers and in memory; with each kind of style, including one that varies
    // along the strand; with the groom as the rest pose.
    static const SolverShape shapes[] = {
        {8, 0.5f, 0.5f, 0},  {8, 0, 0, 0},        {8, 1, 1, 0},       {64, 0.5f, 0.5f, 0},
        {8, 0.9f, 0.3f, 1},  {64, 0.9f, 0.3f, 0}, {8, 0.4f, 0.4f, 1}, {64, 0.6f, 0.6f, 1},
        {16, 0.5f, 0.5f, 0}, {16, 0.9f, 0.3f, 0}, {16, 0, 0, 0},      {20, 0.5f, 0.5f, 0},
        {32, 0.5f, 0.5f, 0},
    };
    for (const SolverType *const *type = SOLVER_TYPES; *type; ++type)
        for (int v = 0; v == 0 || (*type)->variants[v]; ++v)
            for (size_t i = 0; i < sizeof shapes / sizeof *shapes; ++i) {
                const char *variant = (*type)->variants[v] ? (*type)->variants[v] : "";
                char what[128];
                Error why = {{0}};
                snprintf(what, sizeof what, "%s %s, %u vertices, style %g:%g, volume %g",
                         (*type)->name, variant, shapes[i].vertices, (double)shapes[i].style,
                         (double)shapes[i].style_of_tip, (double)shapes[i].volume);
                report(what, try_solver(gpu, *type, variant, &shapes[i], &why), &why, worst, stream,
                       error);
            }
}

// Loops over lights and shadow maps are unrolled. Compiles them for the numbers that scenes often
// have, and for the largest.
static Result try_light_counts(LookPrograms *programs, Error *error)
{
    static const struct {
        int lights, maps;
    } counts[] = {{1, 0}, {2, 0}, {2, 1}, {4, 4}};
    static const unsigned features[] = {
        0,
        LOOK_SHADOW_DOM,
        LOOK_SHADOW_DOM | LOOK_SHADOW_BY_MESH | LOOK_LIGHTS,
        LOOK_SHADOW_DOM | LOOK_SHADOW_BY_MESH | LOOK_MARSCHNER | LOOK_SCATTERED,
        LOOK_SHADOW_DOM | LOOK_SHADOW_BY_MESH | LOOK_MARSCHNER | LOOK_LIGHTS | LOOK_WIDE,
        LOOK_MARSCHNER | LOOK_SHADOW_APPROX};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; ++i) {
        look_programs_count(programs, counts[i].lights, counts[i].maps);
        for (size_t k = 0; k < sizeof features / sizeof *features; ++k)
            if (counts[i].maps || !(features[k] & (LOOK_SHADOW_DOM | LOOK_SHADOW_APPROX)))
                TRY(look_programs_build(programs, features[k], error));
    }
    look_programs_count(programs, 0, 0);
    return RESULT_OK;
}

// Compiles every combination of features that hair can be drawn with.
static Result try_looks(Passes *passes, Error *error)
{
    bool quads = passes->options->raster == RASTER_QUADS;
    LookPrograms *programs = quads ? &passes->quads.hair.project : &passes->ribbons.project;
    static const unsigned others[] = {LOOK_SHADOW_APPROX,
                                      LOOK_SHADOW_DOM,
                                      LOOK_SHADOW_APPROX | LOOK_SHADOW_BY_MESH,
                                      LOOK_SHADOW_DOM | LOOK_SHADOW_BY_MESH | LOOK_LIGHTS,
                                      LOOK_SHADOW_DOM | LOOK_SHADOW_BY_MESH | LOOK_MARSCHNER |
                                          LOOK_SCATTERED,
                                      LOOK_WHITE,
                                      LOOK_WHITE | LOOK_PAINT,
                                      LOOK_TANGENT,
                                      LOOK_STRAND,
                                      LOOK_SMOOTH,
                                      LOOK_SMOOTH | LOOK_PAINT};
    // LOOK_GAUSS has no effect without LOOK_MARSCHNER.
    for (unsigned features = 0; features < LOOK_SHADOW_APPROX; ++features)
        if ((features & (LOOK_MARSCHNER | LOOK_GAUSS)) != LOOK_GAUSS)
            TRY(look_programs_build(programs, features, error));
    for (size_t i = 0; i < sizeof others / sizeof *others; ++i)
        TRY(look_programs_build(programs, others[i], error));
    if (passes->options->shadow.kind == SHADOW_NONE) return RESULT_OK;
    return try_light_counts(programs, error);
}

// Compiles the shaders for shadows, floor and culling with these options.
static Result try_shadows(Passes *passes, Error *error)
{
    const RendererOptions *options = passes->options;
    bool shadows = options->shadow.kind != SHADOW_NONE;
    for (unsigned variant = 0; variant < CAST_VARIANTS && shadows; ++variant)
        TRY(hair_shadow_build(&passes->shadow.hair, variant, error));
    for (unsigned i = 0; i < LIGHT_PASSES * CAST_VARIANTS && shadows; ++i)
        TRY(light_pass_build(&passes->scatter.passes.programs, (LightPass)(i / CAST_VARIANTS),
                             i % CAST_VARIANTS, error));
    if (shadows) TRY(shadows_reserve_mesh(&passes->shadow, 1, error));
    for (int count = 0; count <= 2; count += 2) {
        base_layer_count(&passes->base, count, shadows ? count : 0, count > 1, shadows);
        TRY(base_layer_build_light(&passes->base, options->shadow.kind, error));
        for (int mesh = 0; mesh < 2; ++mesh)
            TRY(base_layer_build(&passes->base, mesh, options->floor.kind, options->shadow.kind,
                                 error));
    }
    for (unsigned variant = 0; variant < CULL_VARIANTS && options->raster == RASTER_COMPUTE;
         ++variant)
        TRY(cull_build(&passes->ribbons.cull, variant, error));
    return RESULT_OK;
}

static Result try_renderer(const Gpu *gpu, Raster raster, const RendererOptions *images,
                           Error *error)
{
    Renderer renderer;
    GpuTimer timer;
    float corners[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
          normals[3][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    uint32_t triangle[1][3] = {{0, 1, 2}};
    const Mesh mesh = {.vertex_count = 3,
                       .triangle_count = 1,
                       .position = corners,
                       .normal = normals,
                       .triangle = triangle};
    RendererOptions options = *images;
    options.raster = raster;
    options.width = options.height = 16;
    gpu_timer_create(&timer, false, true);
    TRY(renderer_create(&renderer, gpu, &timer, &options, error));
    Result result = renderer_set_mesh(&renderer, &mesh, (const float[3]){1, 1, 1}, error);
    if (renderer.backend == &DRAW_PASSES) {
        THEN(result, try_looks(renderer.state, error));
        THEN(result, try_shadows(renderer.state, error));
    }
    renderer_destroy(&renderer);
    return result;
}

// Computes the table of Marschner shading.
static void try_tables(const Gpu *gpu, Result *worst, FILE *stream, Error *error)
{
    ScatterTables tables = {.stock = gpu->tables};
    ScatterTable *table;
    Error why = {{0}};
    Result result = scatter_tables_find(&tables, 1.5f, 0.2f, &table, &why);
    report("scatter.comp", result, &why, worst, stream, error);
    scatter_tables_destroy(&tables);
}

static void try_renderers(const Gpu *gpu, Result *worst, FILE *stream, Error *error)
{
    try_tables(gpu, worst, stream, error);
    static const char *const rasters[] = {"", "quads", "blocks", "compute"};
    static const struct {
        const char *name;
        RendererOptions options;
    } images[] = {
        {"opaque", {.background = {0, 0, 0, 1}, .tone = TONE_FILMIC}},
        {"transparent, 2 x 2", {.tone = TONE_REINHARD, .samples = 2}},
        {"16 bits", {.kind = IMAGE_16}},
        {"floats, 2 x 2", {.kind = IMAGE_FLOAT, .samples = 2}},
        {"floor", {.floor = {.kind = FLOOR_PLANE}}},
        {"floor, dom",
         {.shadow = {.kind = SHADOW_DOM, .side = 64, .spacing = 200},
          .floor = {.kind = FLOOR_PLANE}}},
        {"skin", {.mesh_shading = MESH_SKIN}},
        {"skin, dom",
         {.shadow = {.kind = SHADOW_DOM, .side = 64, .spacing = 200}, .mesh_shading = MESH_SKIN}},
        {"catcher, approx",
         {.shadow = {.kind = SHADOW_APPROX, .side = 64, .spacing = 200},
          .floor = {.kind = FLOOR_SHADOW}}},
        {"coverage", {.aov = AOV_COVERAGE}},
        {"depth", {.aov = AOV_DEPTH, .kind = IMAGE_FLOAT}},
        {"tangent", {.aov = AOV_TANGENT, .kind = IMAGE_16}}};
    for (size_t i = 0; i < sizeof images / sizeof *images; ++i)
        for (Raster raster = RASTER_QUADS; raster <= RASTER_COMPUTE; ++raster) {
            char what[128];
            Error why = {{0}};
            snprintf(what, sizeof what, "renderer, %s, %s", rasters[raster], images[i].name);
            report(what, try_renderer(gpu, raster, &images[i].options, &why), &why, worst, stream,
                   error);
        }
}

static Result run_shaders(const BenchOptions *arguments, const Gpu *gpu, Error *error)
{
    FILE *stream = stdout;
    (void)arguments;
    static const ShaderDefine strand[] = {{"GROUP_SIZE", 8}, {"TIP", 0}, {NULL, 0}},
                              tip[] = {{"GROUP_SIZE", 8}, {"TIP", 1}, {NULL, 0}};
    static const struct {
        const char *file;
        const ShaderDefine *defines;
    } checks[] = {{"bench/check_step.comp", NULL},
                  {"bench/check_chain.comp", NULL},
                  {"bench/stress.comp", strand},
                  {"bench/stress.comp", tip}};
    Result worst = RESULT_OK;
    Error why = {{0}};
    shader_add_sources(BENCH_GLSL_SOURCES);
    shader_treat_warnings_as_errors(true);
    for (size_t i = 0; i < sizeof checks / sizeof *checks; ++i) {
        GLuint program = 0;
        Result built = shader_build_compute(&program, checks[i].file, checks[i].defines, &why);
        if (built == RESULT_OK) shader_release(program);
        report(checks[i].file, built, &why, &worst, stream, error);
    }
    report("sim/inbetween.comp", try_inbetween(gpu, &why), &why, &worst, stream, error);
    try_solvers(gpu, &worst, stream, error);
    try_collisions(gpu, &worst, stream, error);
    for (FollowMode mode = FOLLOW_OFFSET; mode <= FOLLOW_INTERPOLATE; ++mode)
        report(mode == FOLLOW_OFFSET ? "followers, offset" : "followers, interpolated",
               try_follow(gpu, mode, &why), &why, &worst, stream, error);
    try_renderers(gpu, &worst, stream, error);
    shader_treat_warnings_as_errors(false);
    return worst;
}

// --- The commands.

static const struct {
    const char *name;
    Result (*run)(const BenchOptions *options, const Gpu *gpu, Error *error);
    const char *help;
} COMMANDS[] = {
    {"step", test_vectors_run_steps,
     "errors of one tractrix step against exact results (--vectors), by the rule of this program "
     "and by that of the thesis"},
    {"chain", test_vectors_run_chains,
     "errors of pulled chains against exact results (--vectors FILE.csv, with FILE_cases.csv "
     "beside it)"},
    {"accuracy", accuracy_run,
     "errors of solvers against exact solutions. Parts: motions, work (time beside error), "
     "pendulum, static, drift, beam, physics, stretch, energy, "
     "rate, scale"},
    {"speed", speed_run,
     "times of the solvers' steps. Parts: memory, sets (--set, --tfx, or all test sets of the "
     "thesis and the named files; with --size also drawing), c (split in plain C), strands, "
     "vertices, threads, start"},
    {"scenes", scenes_run,
     "times of whole frames in several scenes: followers, colliders, sleeping hair, two sections; "
     "--set NAME (default 10k16), --algo"},
    {"stress", run_stress,
     "random cases for every solver; prints the smallest case that breaks a rule"},
    {"image", images_run_one,
     "time of drawing --set NAME or --tfx FILE, and the error against an exact image"},
    {"images", images_run,
     "the same for all rasterisers and presets; parts: straight, curls, fur, files (the named "
     "files)"},
    {"light", light_run,
     "light in hair compared with a path tracer, for each method of computing it: --way, --case, "
     "--picture"},
    {"trace", trace_run,
     "makes a path-traced case of each scene NAME.json: writes NAME.csv beside it; 8 paths a pixel "
     "for each of --frames"},
    {"groom", groom_run,
     "how the hair of files moves at rest and when the head shakes: --mesh, --algo, --rates, "
     "--strands; parts: rest, shake, speed"},
    {"page", page_run,
     "makes a page of rows that --csv wrote, on one machine or several: FILE.csv... --html "
     "FILE.html"},
    {"shaders", run_shaders, "compiles every shader variant with warnings as errors"},
};
enum { COMMAND_COUNT = sizeof COMMANDS / sizeof *COMMANDS };

// Checks that no output overwrites an input or another output.
static Result check_paths(const BenchOptions *options, Error *error)
{
    const PathUse own[] = {{"--csv", options->output.csv, PATH_WRITTEN, NULL},
                           {"--json", options->output.json, PATH_WRITTEN, NULL},
                           {"--html", options->output.html, PATH_WRITTEN, NULL},
                           {"--picture", options->picture, PATH_WRITTEN, NULL},
                           {"--tfx", options->tfx, PATH_READ, NULL},
                           {"--mesh", options->mesh, PATH_READ, NULL},
                           {"--vectors", options->vectors, PATH_READ, NULL},
                           {"--reference", options->reference, PATH_READ, NULL},
                           {"--before", options->before, PATH_READ, NULL}};
    enum { OWN = sizeof own / sizeof *own };
    PathUse *uses = malloc((OWN + (size_t)options->file_count) * sizeof *uses);
    if (!uses) return error_set(error, RESULT_FAILED, "no memory for paths");
    memcpy(uses, own, sizeof own);
    Result result = RESULT_OK;
    for (int i = 0; i < options->file_count; ++i) {
        const char *file = options->files[i];
        uses[OWN + i] = (PathUse){"the file", file, PATH_READ, NULL};
        // Some commands measure for minutes before they read it.
        if (result == RESULT_OK && strcmp(file, "-") != 0 && access(file, R_OK) != 0)
            result = error_set(error, RESULT_BAD_INPUT, "%s: %s", file, strerror(errno));
    }
    THEN(result, paths_claim(uses, OWN + options->file_count, error));
    free(uses);
    return result;
}

static Result run_command(BenchOptions *options, Error *error)
{
    const char *names[COMMAND_COUNT];
    size_t command = 0;
    Gpu gpu;
    if (options->file_count == 0)
        return error_set(error, RESULT_USAGE, "no command: expected one of those in --help");
    const char *word = *options->files++;
    --options->file_count;
    for (size_t i = 0; i < COMMAND_COUNT; ++i) names[i] = COMMANDS[i].name;
    while (command < COMMAND_COUNT && strcmp(names[command], word) != 0) ++command;
    if (command == COMMAND_COUNT) {
        char words[200];
        return error_set(error, RESULT_USAGE, "no command '%s': %s", word,
                         suggest_words(words, sizeof words, word, names, COMMAND_COUNT));
    }
    TRY(check_paths(options, error));
    if (COMMANDS[command].run == page_run) return page_run(options, NULL, error);
    const TableOutput *output = &options->output;
    if (COMMANDS[command].run == run_shaders && (output->csv || output->json || output->html))
        return error_set(
            error, RESULT_USAGE,
            "shaders: --csv, --json and --html have no effect, since this command writes no rows");
    // Mesa does not compile shaders that it finds in its cache, so it would print no warnings for
    // them.
    if (COMMANDS[command].run == run_shaders) setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
    TRY(gpu_create(&gpu, &options->gpu, error));
    fprintf(stderr, "%s, OpenGL %s (%s)\n", quote(gpu.renderer).text, quote(gpu.version).text,
            gpu.path);
    Result result = COMMANDS[command].run(options, &gpu, error);
    gpu_destroy(&gpu);
    return result;
}

static Result run(int argc, char **argv, Error *error)
{
    BenchOptions options;
    const char *help[COMMAND_COUNT + 1][2] = {{NULL}};
    for (size_t i = 0; i < COMMAND_COUNT; ++i)
        help[i][0] = COMMANDS[i].name, help[i][1] = COMMANDS[i].help;
    Result result = bench_options_read(&options, argc, argv, (const char *const(*)[2])help, error);
    if (!options.done) THEN(result, run_command(&options, error));
    bench_options_destroy(&options);
    return result;
}

int main(int argc, char **argv)
{
    Error error = {{0}};
    program_begin(argc, argv);
    Result result = assumptions_take_option(&argc, argv, &error);
    THEN(result, run(argc, argv, &error));
    return program_end("tractrix-bench", result, &error);
}
