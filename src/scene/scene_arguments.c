// SPDX-License-Identifier: MIT
#include "base/options.h"
#include "base/target.h"
#include "scene/effects.h"
#include "scene/scene.h"

#include <stdlib.h>
#include <string.h>

static const ParamInfo *info_of(const OptionsArgument *argument)
{
    return &PARAM_TABLE[argument->option - OPTIONS_OF_PARAMS];
}

// What the first pass over the command line finds.
typedef struct Found {
    const char **files; // [file_count] owned; hair files or one scene file
    size_t file_count;
    SceneOverrides overrides;
} Found;

static void note(SceneOverrides *overrides, const char *name, const char *text)
{
    if (strcmp(name, "look") == 0) overrides->presets.look = text;
    if (strcmp(name, "quality") == 0) overrides->presets.quality = text;
    if (strcmp(name, "algo") == 0) overrides->algo = text;
}

// Collects the files; reports unknown flags and handles requests such as --help.
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

static Result apply_flag(Scene *scene, const OptionsArgument *argument, Error *error)
{
    Result result = scene_set(scene, -1, info_of(argument), argument->text, error);
    return result == RESULT_OK ? result : error_prefix(error, result, "%s: ", argument->flag);
}

// The second pass, when the sections exist.
static Result apply_flags(Scene *scene, OptionsWalk walk, Error *error)
{
    for (OptionsArgument argument;;) {
        TRY(options_next(&walk, &argument, error));
        if (argument.found == OPTIONS_END) return RESULT_OK;
        if (argument.found == OPTIONS_OPTION) TRY(apply_flag(scene, &argument, error));
    }
}

// A name without a number (x.png) means one frame, --first, unless the command line gives a number
// of frames or another output needs all of them.
static Result choose_still(Scene *scene, Error *error)
{
    RunParams *run = &scene->run;
    Target target;
    bool sheet = run->contact_sheet[0] > 1 || run->contact_sheet[1] > 1;
    bool counted = scene->origin[params_find("frames") - PARAM_TABLE] == ORIGIN_FLAG;
    if (counted || sheet || run->part[1] > 1 || !scene_has_default(scene, "last") || *run->cache ||
        *run->export)
        return RESULT_OK;
    Error unused = {{0}}; // whoever opens the file reports a wrong name
    Result result = target_parse(&target, run->output, &unused);
    if (result == RESULT_FAILED) return error_set(error, result, "%s", unused.text);
    if (result == RESULT_OK && target.kind == TARGET_STILL) run->last = run->first;
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
    if (run)
        THEN(result, scene_open(scene, found.files, found.file_count, &found.overrides, error));
    free(found.files);
    if (run) THEN(result, apply_flags(scene, walk, error));
    scene_settle(scene);
    if (run) THEN(result, scene_choose_turn(scene, error));
    if (run) THEN(result, choose_still(scene, error));
    if (run && result == RESULT_OK) scene_set_lights(scene);
    if (run) THEN(result, check_arguments(scene, error));
    return result;
}
