// SPDX-License-Identifier: MIT
#include "base/options.h"
#include "base/target.h"
#include "scene/effects.h"
#include "scene/scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { TURN_SECONDS = 6, TURN_FPS = 30 };

static const ParamInfo *info_of(const OptionsArgument *argument)
{
    return &PARAM_TABLE[argument->option - OPTIONS_OF_PARAMS];
}

// A scene file is named .json, or is text that begins with '{', which no hair file does.
static bool is_scene_file(const char *path)
{
    size_t length = strlen(path);
    if (length >= 5 && strcmp(path + length - 5, ".json") == 0) return true;
    struct stat status;
    if (stat(path, &status) != 0 || !S_ISREG(status.st_mode)) return false;
    FILE *file = fopen(path, "rb");
    if (!file) return false;
    char beginning[257];
    size_t size = fread(beginning, 1, sizeof beginning - 1, file);
    fclose(file);
    beginning[size] = 0;
    bool binary = memchr(beginning, 0, size) != NULL;
    const char *text = beginning + (strncmp(beginning, "\xef\xbb\xbf", 3) == 0 ? 3 : 0);
    return !binary && text[strspn(text, " \t\r\n")] == '{';
}

// What the first walk along the command line finds.
typedef struct Found {
    const char **files; // [file_count] owned; names of hair files or of the scene file
    size_t file_count;
    SceneOverrides overrides;
} Found;

static void note(SceneOverrides *overrides, const char *name, const char *text)
{
    if (strcmp(name, "look") == 0) overrides->presets.look = text;
    if (strcmp(name, "quality") == 0) overrides->presets.quality = text;
    if (strcmp(name, "algo") == 0) overrides->algo = text;
}

// Finds unknown flags, requests and the files.
static Result find_files(Scene *scene, OptionsWalk walk, Found *found, Error *error)
{
    OptionsArgument argument;
    for (;;) {
        TRY(options_next(&walk, &argument, error));
        switch (argument.found) {
        case OPTIONS_END:
            return RESULT_OK;
        case OPTIONS_OPERAND:
            found->files[found->file_count++] = argument.text;
            break;
        case OPTIONS_OPTION:
            note(&found->overrides, argument.option->name, argument.text);
            break;
        case OPTIONS_HELP:
        case OPTIONS_VERSION:
            scene->request = argument.found == OPTIONS_HELP ? REQUEST_HELP : REQUEST_VERSION;
            scene->topic = argument.text;
            return RESULT_OK;
        }
    }
}

static Result add_sections(Scene *scene, const Found *found, Error *error)
{
    SectionParams defaults;
    const Presets *presets = &found->overrides.presets;
    Result result = params_create_section(&defaults, error);
    THEN(result, scene_apply_presets(presets, SCOPE_RUN, &scene->run, error));
    THEN(result, scene_apply_presets(presets, SCOPE_SECTION, &defaults, error));
    for (size_t i = 0; i < found->file_count; i++)
        THEN(result, scene_add_section(scene, found->files[i], &defaults, error));
    params_destroy_section(&defaults);
    return result;
}

static Result open_files(Scene *scene, const Found *found, Error *error)
{
    const char *scene_file = NULL;
    for (size_t i = 0; i < found->file_count; i++) {
        if (!found->files[i][0])
            return error_set(error, RESULT_USAGE, "the name of a file is empty");
        if (is_scene_file(found->files[i])) scene_file = found->files[i];
    }
    if (!scene_file) return add_sections(scene, found, error);
    if (found->file_count > 1)
        return error_set(error, RESULT_USAGE,
                         "%.200s is a scene file: expected no other file beside it "
                         "(name hair in its 'sections')",
                         scene_file);
    scene_destroy(scene);
    return scene_read_unchecked(scene, scene_file, &found->overrides, error);
}

// A value given as a flag also replaces the scene file's keyframes of that name.
static void drop_keyframes(Scene *scene, const char *name)
{
    const struct {
        const char *name;
        Keyframes *keys;
    } tracks[] = {{"gravity", &scene->gravity},
                  {"wind", &scene->wind},
                  {"eye", &scene->eye},
                  {"target", &scene->target},
                  {"fov", &scene->fov}};
    for (size_t i = 0; i < sizeof tracks / sizeof tracks[0]; i++) {
        if (strcmp(name, tracks[i].name) == 0) keyframes_destroy(tracks[i].keys);
    }
}

static Result apply_flag(Scene *scene, const OptionsArgument *argument, Error *error)
{
    const ParamInfo *info = info_of(argument);
    size_t row = (size_t)(info - PARAM_TABLE);
    Result result = RESULT_OK;
    if (info->scope == SCOPE_RUN) {
        drop_keyframes(scene, info->name);
        scene->origin[row] = ORIGIN_FLAG;
        result = params_parse(info, &scene->run, argument->text, error);
        if (result == RESULT_OK && strcmp(info->name, "colliders") == 0) {
            colliders_destroy(&scene->colliders);
            result = colliders_parse(&scene->colliders, scene->run.colliders, error);
        }
    }
    for (uint32_t i = 0; info->scope == SCOPE_SECTION && i < scene->section_count; i++) {
        scene->sections[i].origin[row] = ORIGIN_FLAG;
        section_tracks_drop(&scene->sections[i].tracks, info);
        THEN(result, params_parse(info, &scene->sections[i].params, argument->text, error));
    }
    return result == RESULT_OK ? result : error_prefix(error, result, "%s: ", argument->flag);
}

// The second walk, once the sections are there.
static Result apply_flags(Scene *scene, OptionsWalk walk, Error *error)
{
    for (OptionsArgument argument;;) {
        TRY(options_next(&walk, &argument, error));
        if (argument.found == OPTIONS_END) return RESULT_OK;
        if (argument.found == OPTIONS_OPTION) TRY(apply_flag(scene, &argument, error));
    }
}

static bool is_default(const Scene *scene, const char *name)
{
    return scene->origin[params_find(name) - PARAM_TABLE] == ORIGIN_DEFAULT;
}

// A turntable lasts 6 s at 30 frames a second where nothing is said of either, with the step that
// other sequences have.
static Result choose_turn(Scene *scene, Error *error)
{
    RunParams *run = &scene->run;
    if (run->turntable == 0 || !is_default(scene, "frames") || !is_default(scene, "fps"))
        return RESULT_OK;
    if (is_default(scene, "sim_rate") && is_default(scene, "speed"))
        TRY(params_parse(params_find("sim_rate"), run, params_find("fps")->default_text, error));
    run->frames = TURN_SECONDS * TURN_FPS;
    run->fps = TURN_FPS;
    return RESULT_OK;
}

// One name without a number (x.png) holds one frame, --first, unless the command line says how many
// frames there are or something else than images needs all of them.
static Result choose_still(Scene *scene, Error *error)
{
    RunParams *run = &scene->run;
    Target target;
    bool sheet = run->contact_sheet[0] > 1 || run->contact_sheet[1] > 1;
    bool counted = scene->origin[params_find("frames") - PARAM_TABLE] == ORIGIN_FLAG;
    if (counted || sheet || run->part[1] > 1 || !is_default(scene, "last") || *run->cache ||
        *run->export)
        return RESULT_OK;
    Error unused = {{0}}; // a wrong name is reported by what opens it
    Result result = target_parse(&target, run->output, &unused);
    if (result == RESULT_FAILED) return error_set(error, result, "%s", unused.text);
    if (result == RESULT_OK && target.kind == TARGET_STILL) {
        run->last = run->first;
        if (run->frames <= run->first && is_default(scene, "frames")) run->frames = run->first + 1;
    }
    target_destroy(&target);
    return RESULT_OK;
}

static Result check_arguments(const Scene *scene, Error *error)
{
    const RunParams *run = &scene->run;
    TRY(scene_check(scene, error));
    TRY(effects_check(scene, error));
    bool asks = run->check || run->list_devices || run->platform;
    if (!run->output[0] && !run->cache[0] && !run->export[0] && !asks)
        return error_set(error, RESULT_USAGE,
                         "no output: expected -o DIR/, -o FILE_%%04d.png or -o FILE.mp4");
    return RESULT_OK;
}

Result scene_from_arguments(Scene *scene, int argc, char **argv, Error *error)
{
    TRY(scene_create(scene, error));
    const OptionsWalk walk = {OPTIONS_OF_PARAMS, PARAM_COUNT, argc, argv, 0, NULL, false};
    Found found = {.files = calloc((size_t)argc + 1, sizeof *found.files)};
    if (!found.files) return error_set(error, RESULT_FAILED, "out of memory");
    Result result = find_files(scene, walk, &found, error);
    bool run = scene->request == REQUEST_RUN;
    if (run) THEN(result, open_files(scene, &found, error));
    free(found.files);
    if (run) THEN(result, apply_flags(scene, walk, error));
    scene_settle_colors(scene);
    if (run) THEN(result, choose_turn(scene, error));
    if (run) THEN(result, choose_still(scene, error));
    if (run && result == RESULT_OK) scene_set_lights(scene);
    if (run) THEN(result, check_arguments(scene, error));
    return result;
}
