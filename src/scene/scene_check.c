// SPDX-License-Identifier: MIT
// What is wrong with a scene as a whole, before anything is loaded.
#include "scene/scene.h"
#include "scene/schedule.h"

#include <string.h>
#include <strings.h>

// Whether a file may have frames with numbers of its own, so that the number of the first frame is
// known only when it is read.
static bool may_have_numbers(const Scene *scene)
{
    static const char *const suffixes[] = {".usda", ".abc", ".npz"};
    for (uint32_t b = 0; b < scene->body_count; b++)
        if (*scene->bodies[b].params.mesh) return true;
    for (uint32_t i = 0; i < scene->section_count; i++) {
        const char *file = scene->sections[i].file, *suffix = strrchr(file, '.');
        if (strchr(file, '%')) return true;
        for (int k = 0; suffix && k < 3; k++)
            if (strcasecmp(suffix, suffixes[k]) == 0) return true;
    }
    return false;
}

Result scene_number_frames(Scene *scene, Error *error)
{
    RunParams *run = &scene->run;
    int number = run->frame_number.value, end = number + run->frames - 1;
    bool given = !scene_has_default(scene, "first");
    if (given && (run->first < number || run->first > end))
        return error_set(error, RESULT_USAGE, "--first %d: expected %d to %d, since --frames is %d",
                         run->first, number, end, run->frames);
    int first = given ? run->first : number;
    if (run->last >= 0 && (run->last < first || run->last > end))
        return error_set(error, RESULT_USAGE,
                         "--last %d: expected %d to %d (or -1), since --frames is %d", run->last,
                         first, end, run->frames);
    run->first = first - number;
    if (run->last >= 0) run->last -= number;
    return RESULT_OK;
}

static Result check_frames(const Scene *scene, Error *error)
{
    const RunParams *run = &scene->run;
    const float slowest = 1e-4f;
    if (run->speed > 0 && run->speed < slowest)
        return error_set(error, RESULT_USAGE, "--speed %g: expected 0 or at least %g",
                         (double)run->speed, (double)slowest);
    if (run->last >= 0 && run->last < run->first)
        return error_set(error, RESULT_USAGE, "--last %d: expected %d or more, since --first is %d",
                         run->last, run->first, run->first);
    if (run->frame_number.automatic && may_have_numbers(scene)) return RESULT_OK;
    Scene numbered = *scene; // only its numbers change
    return scene_number_frames(&numbered, error);
}

static bool is_same_point(const float a[3], const float b[3])
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

static Result check_camera(const Scene *scene, Error *error)
{
    const RunParams *run = &scene->run;
    const float *up = run->camera_up;
    if (up[0] == 0 && up[1] == 0 && up[2] == 0)
        return error_set(error, RESULT_USAGE, "--camera-up: got 0,0,0, expected a direction");
    if (run->ease_in + run->ease_out > 1.000001f)
        return error_set(error, RESULT_USAGE,
                         "--ease-in %g and --ease-out %g: expected a sum of at most 1",
                         (double)run->ease_in, (double)run->ease_out);
    bool fixed_eye = !track_is_given(&scene->eye) && !run->eye.automatic;
    bool fixed_target = !track_is_given(&scene->target) && !run->target.automatic;
    if (fixed_eye && fixed_target && is_same_point(run->eye.value, run->target.value))
        return error_set(error, RESULT_USAGE,
                         "--eye and --target: the same point: expected two points");
    return RESULT_OK;
}

static Result check_conflicts(const RunParams *run, Error *error)
{
    const char *pair = NULL;
    if (run->quiet && run->verbose) pair = "--quiet and --verbose";
    if (*run->cache && *run->from_cache) pair = "--cache and --from-cache";
    if (run->software && run->require_hardware) pair = "--software and --require-hardware";
    if (run->backend == BACKEND_OSMESA) {
        if (run->require_hardware) pair = "--backend osmesa and --require-hardware";
        if (*run->device) pair = "--backend osmesa and --device";
    }
    if (run->raster == RASTER_BLOCKS && run->oit != OIT_AUTO) pair = "--raster blocks and --oit";
    if (run->raster == RASTER_BLOCKS && run->oit_layers > 0)
        pair = "--raster blocks and --oit-layers";
    if (run->raster == RASTER_COMPUTE && run->oit != OIT_AUTO) pair = "--raster compute and --oit";
    if (run->raster == RASTER_COMPUTE && run->oit_layers > 0)
        pair = "--raster compute and --oit-layers";
    if (pair) return error_set(error, RESULT_USAGE, "%s: expected only one of them", pair);
    if (run->lod_end > 0 && run->lod_end <= run->lod_start)
        return error_set(error, RESULT_USAGE,
                         "--lod-end %g m: expected more than --lod-start, %g m",
                         (double)run->lod_end, (double)run->lod_start);
    return RESULT_OK;
}

static bool ends_with(const char *text, const char *end)
{
    size_t length = strlen(text), end_length = strlen(end);
    return length >= end_length && strcmp(text + length - end_length, end) == 0;
}

static Result check_heads(const Scene *scene, double time, Error *error)
{
    for (uint32_t i = 0; i < scene->body_count; ++i) {
        Result result = rigid_track_check(&scene->bodies[i].head, time, error);
        if (result == RESULT_OK) continue;
        return error_prefix(error, result, "%shead.", scene_body_place(scene, i, ".").text);
    }
    return RESULT_OK;
}

static Result check_sections(const Scene *scene, double time, Error *error)
{
    for (uint32_t i = 0; i < scene->section_count; ++i) {
        Result result = section_tracks_check(&scene->sections[i].tracks, time, error);
        if (result != RESULT_OK)
            return error_prefix(error, result, "%s.", scene_section_place(scene, i).text);
    }
    return RESULT_OK;
}

static Result check_tracks(const Scene *scene, double time, Error *error)
{
    TRY(check_heads(scene, time, error));
    TRY(check_sections(scene, time, error));
    TRY(track_check(&scene->gravity, "gravity.formula", time, error));
    TRY(track_check(&scene->wind, "wind.formula", time, error));
    TRY(track_check(&scene->eye, "camera.eye", time, error));
    TRY(track_check(&scene->target, "camera.target", time, error));
    return track_check(&scene->fov, "camera.fov", time, error);
}

static bool has_formulas(const Scene *scene)
{
    const Track *tracks[] = {&scene->gravity, &scene->wind, &scene->eye, &scene->target,
                             &scene->fov};
    bool any = false;
    for (size_t i = 0; i < sizeof tracks / sizeof *tracks; ++i) any |= track_has_formula(tracks[i]);
    for (uint32_t b = 0; b < scene->body_count; ++b)
        any |= track_has_formula(&scene->bodies[b].head.translation) ||
               track_has_formula(&scene->bodies[b].head.rotation);
    for (uint32_t i = 0; i < scene->section_count; ++i)
        for (uint32_t k = 0; k < scene->sections[i].tracks.count; ++k)
            any |= track_has_formula(&scene->sections[i].tracks.list[k].track);
    return any;
}

// Evaluates all formulas at the times of all frames, at most a million, so that errors are found
// before anything runs.
static Result check_formulas(const Scene *scene, Error *error)
{
    const int most = 1000000;
    if (!has_formulas(scene)) return RESULT_OK;
    int frames = scene->run.frames < most ? scene->run.frames : most;
    for (int frame = 0; frame < frames; ++frame)
        TRY(check_tracks(scene, schedule_frame_time(&scene->run, frame), error));
    return RESULT_OK;
}

bool scene_draws_floats(const RunParams *run)
{
    return ends_with(run->output, ".pfm") || ends_with(run->output, ".exr");
}

// Checks that options for tone mapping and levels are not combined with output that has linear
// light or data instead of colours.
static Result check_depth(const Scene *scene, Error *error)
{
    const RunParams *run = &scene->run;
    size_t row = (size_t)(params_find("tone_map") - PARAM_TABLE);
    bool tones = run->tone_map != TONE_NONE && scene->origin[row] == ORIGIN_FLAG;
    bool video = ends_with(run->output, ".mp4") || ends_with(run->output, ".webm") ||
                 ends_with(run->output, ".gif") || ends_with(run->output, ".y4m");
    bool jpeg = ends_with(run->output, ".jpg") || ends_with(run->output, ".jpeg");
    const char *pair = NULL;
    if (run->depth == DEPTH_16 && jpeg) pair = "--depth 16 and .jpg files";
    if (run->aov != AOV_NONE && jpeg) pair = "--aov and .jpg files";
    if (run->depth == DEPTH_16 && scene_draws_floats(run))
        pair = "--depth 16 and .pfm or .exr files";
    if (run->depth == DEPTH_16 && video) pair = "--depth 16 and a video";
    if (tones && scene_draws_floats(run)) pair = "--tone-map and .pfm or .exr files";
    if (tones && run->aov != AOV_NONE) pair = "--tone-map and --aov";
    if (*run->caption && scene_draws_floats(run)) pair = "--caption and .pfm or .exr files";
    if (*run->caption && run->aov != AOV_NONE) pair = "--caption and --aov";
    if (pair) return error_set(error, RESULT_USAGE, "%s: expected only one of them", pair);
    return RESULT_OK;
}

static Result check_floor(const RunParams *run, Error *error)
{
    if (run->floor != FLOOR_SHADOW || run->shadow != SHADOW_NONE) return RESULT_OK;
    return error_set(
        error, RESULT_USAGE,
        "--floor shadow: has no effect without shadows: expected --shadow dom or approx");
}

Result scene_check(const Scene *scene, Error *error)
{
    const RunParams *run = &scene->run;
    if (scene->section_count == 0 && !run->list_devices && !run->platform)
        return error_set(error, RESULT_USAGE, "no hair: expected a hair file or a scene file");
    TRY(check_frames(scene, error));
    TRY(check_camera(scene, error));
    TRY(check_conflicts(run, error));
    TRY(check_depth(scene, error));
    TRY(check_floor(run, error));
    return check_formulas(scene, error);
}
