// SPDX-License-Identifier: MIT
#include "bench/bench_scenes.h"
#include "base/clock.h"
#include "bench/bench_speed.h"
#include "gen/strands_make.h"
#include "sim/simulation.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_SECTIONS = 2, FPS = 60, LATEST_SLEEP_S = 60, RINGS = 36 };

// A section that steps for ever, one that falls asleep (it may be off by its whole length), one
// that has no solver.
typedef enum Rest { MOVES, SLEEPS, STATIC } Rest;

typedef struct Row {
    const char *name;
    int sections;
    Rest rest[MOST_SECTIONS];
    int followers;
    FollowMode mode;
    const char *colliders; // as --colliders; NULL: none
    bool mesh;             // collides with the sphere that the hair grows on, as a mesh
} Row;

#define SPHERE "sphere:0,0,0,0.1"
#define SHOULDERS                                                                                  \
    "capsule:-0.2,-0.2,0,0.05,-0.05,-0.15,0,0.07;capsule:0.05,-0.15,0,0.07,0.2,-0.2,0,0.05"

static const Row ROWS[] = {
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

typedef struct World {
    Scene scene;
    Strands strands[MOST_SECTIONS];
    Mesh mesh;
    GpuTimer timer;
    Simulation simulation;
} World;

static void world_destroy(World *world)
{
    if (world->simulation.scene) simulation_destroy(&world->simulation);
    gpu_timer_destroy(&world->timer);
    for (int i = 0; i < MOST_SECTIONS; ++i) strands_destroy(&world->strands[i]);
    mesh_destroy(&world->mesh);
    scene_destroy(&world->scene);
}

static const char *algo_of(const BenchOptions *options)
{
    return options->method.algo ? options->method.algo : "split";
}

static Result add_section(World *world, const Row *row, int i, const BenchOptions *options,
                          Error *error)
{
    SectionParams params;
    const char *set = options->set ? options->set : "10k16";
    Method method = {"none", "", ""};
    if (row->rest[i] != STATIC)
        method = (Method){algo_of(options), options->method.variant, options->method.settings};
    Result result = method_params(&params, &method, "", error);
    params.sleep = row->rest[i] == SLEEPS ? 1 : 0;
    params.followers = row->followers;
    params.follow = (int)row->mode;
    if (result == RESULT_OK) result = strands_make_set(&world->strands[i], set, 1, error);
    if (result == RESULT_OK) result = scene_add_section(&world->scene, set, &params, error);
    params_destroy_section(&params);
    return result;
}

static Result world_create(World *world, const Gpu *gpu, const Row *row,
                           const BenchOptions *options, Error *error)
{
    *world = (World){0};
    gpu_timer_create(&world->timer, false, true);
    Result result = scene_create(&world->scene, error);
    for (int i = 0; i < row->sections && result == RESULT_OK; ++i)
        result = add_section(world, row, i, options, error);
    if (result == RESULT_OK && row->colliders)
        result = colliders_parse(&world->scene.colliders, row->colliders, error);
    if (result == RESULT_OK && row->mesh)
        result = scalp_make_mesh(&world->mesh, SCALP_SPHERE, RINGS, error);
    world->scene.run.collide_mesh = row->mesh;
    world->scene.run.sdf_cache = false;
    return result == RESULT_OK
               ? simulation_create(&world->simulation, gpu, &world->timer, &world->scene,
                                   world->strands, &world->mesh, error)
               : result;
}

static double frame_ms(Simulation *simulation)
{
    double begin = clock_ms();
    simulation_advance(simulation);
    simulation_pose(simulation);
    glFinish();
    return clock_ms() - begin;
}

// Until all that may sleep does.
static Result wait_for_sleep(Simulation *simulation, const Row *row, Error *error)
{
    for (int i = 0; i < row->sections; ++i)
        while (row->rest[i] == SLEEPS && !simulation->sections[i].sleep.asleep) {
            if (simulation->frame > LATEST_SLEEP_S * FPS)
                return error_set(error, RESULT_FAILED, "%s: still awake after %d s", row->name,
                                 LATEST_SLEEP_S);
            frame_ms(simulation);
        }
    return RESULT_OK;
}

static Result measure_frames(Times *times, Simulation *simulation, const Row *row,
                             const BenchOptions *options, Error *error)
{
    double *samples = calloc((size_t)options->steps, sizeof *samples);
    if (!samples)
        return error_set(error, RESULT_FAILED, "no memory for %d samples", options->steps);
    Result result = wait_for_sleep(simulation, row, error);
    for (int i = -options->warm_up; i < options->steps && result == RESULT_OK; ++i) {
        double ms = frame_ms(simulation);
        if (i >= 0) samples[i] = ms;
    }
    *times = table_times(samples, result == RESULT_OK ? options->steps : 0);
    free(samples);
    return result;
}

// --- Rows.

typedef struct Line {
    const char *scene, *algo, *variant, *set;
    long guides, followers;
    Times times;
    char command[256];
} Line;

#define AT(member) offsetof(Line, member)
static const Column COLUMNS[] = {
    {"scene", COLUMN_TEXT, AT(scene), 16},
    {"algo", COLUMN_TEXT, AT(algo), 9},
    {"variant", COLUMN_TEXT, AT(variant), 9},
    {"set", COLUMN_TEXT, AT(set), 5},
    {"guides", COLUMN_WHOLE, AT(guides), 7},
    {"followers", COLUMN_WHOLE, AT(followers), 9},
    {"ms_min", COLUMN_REAL, AT(times.minimum), 9},
    {"ms_q1", COLUMN_REAL, AT(times.lower_quartile), 9},
    {"ms_median", COLUMN_REAL, AT(times.median), 9},
    {"ms_q3", COLUMN_REAL, AT(times.upper_quartile), 9},
    {"command", COLUMN_CHARS, AT(command), 0},
};

static void add_line(Table *table, const Row *row, const BenchOptions *options, const World *world,
                     const Times *times)
{
    const Method method = {algo_of(options), options->method.variant, options->method.settings};
    char words[160];
    Line line = {.scene = row->name,
                 .algo = method.algo,
                 .variant = method_variant(&method),
                 .set = options->set ? options->set : "10k16",
                 .times = *times};
    for (int i = 0; i < row->sections; ++i) {
        line.guides += world->simulation.sections[i].hair.strand_count;
        line.followers += world->simulation.sections[i].follow.hair.strand_count;
    }
    method_format(&method, words, sizeof words);
    snprintf(line.command, sizeof line.command, "tractrix-bench scenes %s --set %s", words,
             line.set);
    table_add(table, &line);
}

static Result measure_row(const Gpu *gpu, const Row *row, const BenchOptions *options, Table *table,
                          Error *error)
{
    World world;
    Times times = {0};
    Result result = world_create(&world, gpu, row, options, error);
    if (result == RESULT_OK)
        result = measure_frames(&times, &world.simulation, row, options, error);
    if (result == RESULT_OK) add_line(table, row, options, &world, &times);
    world_destroy(&world);
    return result;
}

Result scenes_run(const BenchOptions *options, const Gpu *gpu, Error *error)
{
    Table table;
    Result result = table_open(&table, COLUMNS, sizeof COLUMNS / sizeof *COLUMNS, gpu,
                               &options->output, stdout, error);
    for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS && result == RESULT_OK; ++i)
        result = measure_row(gpu, &ROWS[i], options, &table, error);
    return table_close(&table, result, error);
}
