// SPDX-License-Identifier: MIT
#include "base/clock.h"
#include "bench/bench_commands.h"
#include "gen/strands_make.h"
#include "sim/simulation.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_SECTIONS = 2, FPS = 60, LATEST_SLEEP_S = 60, RINGS = 36 };

// Whether a section moves in every frame, falls asleep (the positions may be wrong by the strand
// length), or has no solver.
typedef enum Rest { MOVES, SLEEPS, STATIC } Rest;

typedef struct SceneKind {
    const char *name;
    int sections;
    Rest rest[MOST_SECTIONS];
    int followers;
    FollowMode mode;
    const char *colliders; // value of --colliders; NULL for none
    bool mesh;             // collide with the sphere that the hair grows on, as a mesh
} SceneKind;

#define SPHERE "sphere:0,0,0,0.1"
#define SHOULDERS                                                                                  \
    "capsule:-0.2,-0.2,0,0.05,-0.05,-0.15,0,0.07;capsule:0.05,-0.15,0,0.07,0.2,-0.2,0,0.05"

static const SceneKind SCENES[] = {
    {.name = "one section", .sections = 1},
    {.name = "4 followers", .sections = 1, .followers = 4},
    {.name = "16 followers", .sections = 1, .followers = 16},
    {.name = "4 interpolated", .sections = 1, .followers = 4, .mode = FOLLOW_INTERPOLATE},
    {.name = "16 interpolated", .sections = 1, .followers = 16, .mode = FOLLOW_INTERPOLATE},
    {.name = "far colliders", .sections = 1, .colliders = "ground:-2; world:sphere:0,2,0,0.5"},
    {.name = "3 capsules", .sections = 1, .colliders = SPHERE ";" SHOULDERS},
    {.name = "mesh", .sections = 1, .mesh = true},
    {.name = "mesh, 2 capsules", .sections = 1, .mesh = true, .colliders = SHOULDERS},
    {.name = "asleep", .sections = 1, .rest = {SLEEPS}},
    {.name = "moving + moving", .sections = 2},
    {.name = "moving + asleep", .sections = 2, .rest = {MOVES, SLEEPS}},
    {.name = "moving + static", .sections = 2, .rest = {MOVES, STATIC}},
};

// clang-format off
#define ROW(X)                                                                                     \
    X(TEXT, scene, 16) X(TEXT, algo, 9) X(TEXT, variant, 9) X(TEXT, set, 5) X(WHOLE, guides, 7)    \
    X(WHOLE, followers, 9) X(REAL, ms_min, 9) X(REAL, ms_q1, 9) X(REAL, ms_median, 9)              \
    X(REAL, ms_q3, 9) X(CHARS, command, 0)
// clang-format on

typedef struct Row {
    ROW(TABLE_FIELD)
    Method method;
} Row;
static const Column COLUMNS[] = {ROW(TABLE_COLUMN)};

static Result add_section(Scene *scene, Strands *strands, const SceneKind *kind, int i,
                          const Row *row, Error *error)
{
    const Method still = {"none", "", ""};
    SectionParams params;
    Result result =
        trial_params(&params, kind->rest[i] == STATIC ? &still : &row->method, "", error);
    params.sleep = kind->rest[i] == SLEEPS ? 1 : 0;
    params.followers = (AutoInt){.value = kind->followers};
    params.follow = (int)kind->mode;
    THEN(result, strands_make_set(strands, row->set, 1, error));
    THEN(result, scene_add_section(scene, row->set, &params, error));
    params_destroy_section(&params);
    return result;
}

static double frame_ms(Simulation *simulation)
{
    double begin = clock_ms();
    simulation_advance(simulation);
    simulation_pose(simulation);
    glFinish();
    return clock_ms() - begin;
}

// Measures frames after all hair that can fall asleep sleeps.
static Result measure_frames(Row *row, Simulation *simulation, const SceneKind *kind,
                             const BenchOptions *options, Error *error)
{
    for (int i = 0; i < kind->sections; ++i)
        while (kind->rest[i] == SLEEPS && !simulation->sections[i].sleep.asleep) {
            if (simulation->frame > LATEST_SLEEP_S * FPS)
                return error_set(error, RESULT_FAILED,
                                 "%s: hair is still awake after %d s: expected it to sleep",
                                 kind->name, LATEST_SLEEP_S);
            frame_ms(simulation);
        }
    double *samples = calloc((size_t)options->steps, sizeof *samples);
    if (!samples)
        return error_set(error, RESULT_FAILED, "no memory for %d samples", options->steps);
    for (int i = -options->warm_up; i < options->steps; ++i) {
        double ms = frame_ms(simulation);
        if (i >= 0) samples[i] = ms;
    }
    Times times = table_times(samples, options->steps);
    row->ms_min = times.minimum, row->ms_median = times.median;
    row->ms_q1 = times.lower_quartile, row->ms_q3 = times.upper_quartile;
    free(samples);
    for (int i = 0; i < kind->sections; ++i) {
        row->guides += simulation->sections[i].hair.strand_count;
        row->followers += simulation->sections[i].follow.hair.strand_count;
    }
    return RESULT_OK;
}

static Result measure_scene(Row *row, const Gpu *gpu, const SceneKind *kind,
                            const BenchOptions *options, Error *error)
{
    Scene scene;
    Strands strands[MOST_SECTIONS] = {{0}};
    Mesh mesh = {0};
    GpuTimer timer;
    Simulation simulation = {0};
    gpu_timer_create(&timer, false, true);
    Result result = scene_create(&scene, error);
    for (int i = 0; i < kind->sections; ++i)
        THEN(result, add_section(&scene, &strands[i], kind, i, row, error));
    if (kind->colliders)
        THEN(result, colliders_parse(&scene.bodies[0].colliders, kind->colliders, error));
    if (kind->mesh) THEN(result, scalp_make_mesh(&mesh, SCALP_SPHERE, RINGS, error));
    scene.bodies[0].params.collide_mesh = kind->mesh;
    scene.run.sdf_cache = false;
    THEN(result, simulation_create(&simulation, gpu, &timer, &scene, strands, &mesh, error));
    THEN(result, measure_frames(row, &simulation, kind, options, error));
    if (simulation.scene) simulation_destroy(&simulation);
    gpu_timer_destroy(&timer);
    for (int i = 0; i < MOST_SECTIONS; ++i) strands_destroy(&strands[i]);
    mesh_destroy(&mesh);
    scene_destroy(&scene);
    return result;
}

Result scenes_run(const BenchOptions *options, const Gpu *gpu, Error *error)
{
    Table table;
    Method method = options->method;
    char words[160];
    TRY(bench_options_one_algo(options, error));
    if (!method.algo) method.algo = "split";
    trial_format(&method, words, sizeof words);
    Result result = table_open(&table, TABLE_COLUMNS, gpu, &options->output, stdout, error);
    for (size_t i = 0; i < sizeof SCENES / sizeof *SCENES && result == RESULT_OK; ++i) {
        Row row = {.scene = SCENES[i].name, .variant = trial_variant(&method), .method = method};
        row.algo = method.algo;
        row.set = options->set ? options->set : "10k16";
        snprintf(row.command, sizeof row.command, "tractrix-bench scenes %s --set %s", words,
                 row.set);
        result = measure_scene(&row, gpu, &SCENES[i], options, error);
        if (result == RESULT_OK) table_add(&table, &row);
    }
    return table_close(&table, result, error);
}
