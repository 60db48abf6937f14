// SPDX-License-Identifier: MIT
#include "base/suggest.h"
#include "scene/scene_json.h"
#include "scene/scene_quality.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

// One step through the command line.
typedef struct Argument {
    const ParamInfo *info; // NULL: not a flag
    const char *value;     // the flag's value as text; if not a flag, the argument
    char name[80];         // the flag as the user wrote it, for messages
} Argument;

// A walk through argv. In a group of letters such as -qv, `letters` is what is left of it.
typedef struct Walk {
    int argc, next;
    char **argv;
    const char *letters;
    bool flags_ended; // after --
    SceneRequest request;
} Walk;

typedef enum StepResult { STEP_TAKEN, STEP_END, STEP_REQUEST, STEP_ERROR } StepResult;

static StepResult fail(Error *error, const char *name, const char *text)
{
    error_set(error, RESULT_USAGE, "%.80s: %s", name, text);
    return STEP_ERROR;
}

static StepResult refuse_unknown(const char *flag, size_t length, Error *error)
{
    const char **names = calloc(PARAM_COUNT + 2, sizeof names[0]);
    if (!names) return fail(error, flag, "out of memory");
    for (size_t i = 0; i < PARAM_COUNT; i++) names[i] = PARAM_TABLE[i].name;
    names[PARAM_COUNT] = "help";
    names[PARAM_COUNT + 1] = "version";
    char word[80], nearest[80];
    snprintf(word, sizeof word, "%.*s", (int)(length < sizeof word ? length : sizeof word), flag);
    bool negated = strncmp(word, "no-", 3) == 0;
    snprintf(nearest, sizeof nearest, "%s",
             suggest_nearest(negated ? word + 3 : word, names, PARAM_COUNT + 2));
    free(names);
    for (char *at = nearest; *at; at++) {
        if (*at == '_') *at = '-';
    }
    error_set(error, RESULT_USAGE, "unknown flag --%s (nearest: --%s; --help lists all)", word,
              nearest);
    return STEP_ERROR;
}

// The value of a flag that has none of its own: the next argument.
static StepResult take_value(Walk *walk, Argument *argument, Error *error)
{
    if (walk->next == walk->argc) return fail(error, argument->name, "expected a value");
    argument->value = walk->argv[walk->next++];
    bool text = argument->info->kind == PARAM_TEXT || argument->info->kind == PARAM_PATH;
    if (text && strncmp(argument->value, "--", 2) == 0)
        return fail(error, argument->name, "expected a value before the next flag");
    return STEP_TAKEN;
}

static StepResult take_help(Walk *walk, const char *form, Error *error)
{
    static const char *const FORMS[] = {"text", "man", "markdown", "bash"};
    for (int i = 0; i < 4; i++) {
        if (strcmp(form, FORMS[i]) != 0) continue;
        walk->request = (SceneRequest)(REQUEST_HELP + i);
        return STEP_REQUEST;
    }
    return fail(error, "--help", "expected text, man, markdown or bash");
}

static StepResult step_letter(Walk *walk, Argument *argument, Error *error)
{
    char letter = *walk->letters++;
    if (letter == 'h') return take_help(walk, "text", error);
    argument->info = params_find_letter(letter);
    snprintf(argument->name, sizeof argument->name, "-%c", letter);
    if (!argument->info) return fail(error, argument->name, "unknown flag (--help lists all)");
    argument->value = "true";
    if (argument->info->kind == PARAM_BOOL) return STEP_TAKEN;
    argument->value = walk->letters;
    walk->letters = "";
    return *argument->value ? STEP_TAKEN : take_value(walk, argument, error);
}

// `flag` is what follows "--": name, name=value, or no-name for a BOOL.
static StepResult step_flag(Walk *walk, const char *flag, Argument *argument, Error *error)
{
    size_t length = strcspn(flag, "=");
    const char *value = flag[length] ? flag + length + 1 : NULL;
    char name[64];
    snprintf(name, sizeof name, "%.*s", (int)(length < sizeof name ? length : sizeof name), flag);
    snprintf(argument->name, sizeof argument->name, "--%s", name);
    if (strcmp(name, "help") == 0) return take_help(walk, value ? value : "text", error);
    if (strcmp(name, "version") == 0 && !value) {
        walk->request = REQUEST_VERSION;
        return STEP_REQUEST;
    }
    argument->info = params_find(name);
    if (argument->info) {
        argument->value = value ? value : "true";
        return value || argument->info->kind == PARAM_BOOL ? STEP_TAKEN
                                                           : take_value(walk, argument, error);
    }
    argument->info = strncmp(name, "no-", 3) == 0 ? params_find(name + 3) : NULL;
    if (!argument->info) return refuse_unknown(flag, length, error);
    if (argument->info->kind != PARAM_BOOL)
        return fail(error, argument->name, "only flags without a value can be negated");
    if (value) return fail(error, argument->name, "takes no value");
    argument->value = "false";
    return STEP_TAKEN;
}

// The next flag with its value, or the next argument that is no flag.
static StepResult walk_step(Walk *walk, Argument *argument, Error *error)
{
    *argument = (Argument){0};
    if (walk->letters && *walk->letters) return step_letter(walk, argument, error);
    if (walk->next >= walk->argc) return STEP_END;
    const char *word = walk->argv[walk->next++];
    if (walk->flags_ended || word[0] != '-' || !word[1]) {
        argument->value = word;
        return STEP_TAKEN;
    }
    if (word[1] != '-') {
        walk->letters = word + 1;
        return step_letter(walk, argument, error);
    }
    if (word[2]) return step_flag(walk, word + 2, argument, error);
    walk->flags_ended = true;
    return walk_step(walk, argument, error);
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
    return !binary && beginning[strspn(beginning, " \t\r\n")] == '{';
}

// First pass: finds unknown flags, requests and the files, whose names go into `files`.
static Result find_files(Scene *scene, Walk walk, const char **files, size_t *count,
                         const char **quality, Error *error)
{
    Argument argument;
    StepResult step;
    *count = 0;
    while ((step = walk_step(&walk, &argument, error)) == STEP_TAKEN) {
        if (!argument.info) files[(*count)++] = argument.value;
        if (argument.info && strcmp(argument.info->name, "quality") == 0) *quality = argument.value;
    }
    if (step == STEP_REQUEST) scene->request = walk.request;
    return step == STEP_ERROR ? RESULT_USAGE : RESULT_OK;
}

static Result add_sections(Scene *scene, const char *const *files, size_t count,
                           const char *quality, Error *error)
{
    SectionParams defaults;
    Quality preset = QUALITY_NORMAL;
    Result result = params_create_section(&defaults, error);
    if (result == RESULT_OK && quality) {
        result = quality_parse(&preset, quality, error);
        if (result != RESULT_OK) error_prefix(error, result, "--quality: ");
    }
    if (result == RESULT_OK) result = quality_apply(preset, SCOPE_RUN, &scene->run, error);
    if (result == RESULT_OK) result = quality_apply(preset, SCOPE_SECTION, &defaults, error);
    for (size_t i = 0; result == RESULT_OK && i < count; i++)
        result = scene_add_section(scene, files[i], &defaults, error);
    params_destroy_section(&defaults);
    return result;
}

static Result open_files(Scene *scene, const char *const *files, size_t count, const char *quality,
                         Error *error)
{
    const char *scene_file = NULL;
    for (size_t i = 0; i < count; i++) {
        if (!files[i][0]) return error_set(error, RESULT_USAGE, "the name of a file is empty");
        if (is_scene_file(files[i])) scene_file = files[i];
    }
    if (!scene_file) return add_sections(scene, files, count, quality, error);
    if (count > 1)
        return error_set(error, RESULT_USAGE,
                         "%.200s is a scene file: expected no other file beside it "
                         "(name hair in its 'sections')",
                         scene_file);
    scene_destroy(scene);
    return scene_read_unchecked(scene, scene_file, quality, error);
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

static Result apply_flag(Scene *scene, const Argument *argument, Error *error)
{
    Result result = RESULT_OK;
    if (argument->info->scope == SCOPE_RUN) {
        drop_keyframes(scene, argument->info->name);
        result = params_parse(argument->info, &scene->run, argument->value, error);
        if (result == RESULT_OK && strcmp(argument->info->name, "colliders") == 0) {
            colliders_destroy(&scene->colliders);
            result = colliders_parse(&scene->colliders, scene->run.colliders, error);
        }
    }
    for (uint32_t i = 0; argument->info->scope == SCOPE_SECTION && i < scene->section_count; i++) {
        result = params_parse(argument->info, &scene->sections[i].params, argument->value, error);
        if (result != RESULT_OK) break;
    }
    return result == RESULT_OK ? result : error_prefix(error, result, "%s: ", argument->name);
}

// Second pass, once the sections are there.
static Result apply_flags(Scene *scene, Walk walk, Error *error)
{
    Argument argument;
    Result result = RESULT_OK;
    while (result == RESULT_OK && walk_step(&walk, &argument, error) == STEP_TAKEN) {
        if (argument.info) result = apply_flag(scene, &argument, error);
    }
    return result;
}

static Result check_arguments(const Scene *scene, Error *error)
{
    const RunParams *run = &scene->run;
    Result result = scene_check(scene, error);
    if (result == RESULT_OK && !run->output[0] && !run->cache[0] && !run->export[0] &&
        !run->check && !run->list_devices)
        return error_set(error, RESULT_USAGE,
                         "no output: expected -o DIR/, -o FILE_%%04d.png or -o FILE.mp4");
    return result;
}

Result scene_from_arguments(Scene *scene, int argc, char **argv, Error *error)
{
    Result result = scene_create(scene, error);
    if (result != RESULT_OK) return result;
    const char **files = calloc((size_t)argc + 1, sizeof files[0]);
    if (!files) return error_set(error, RESULT_FAILED, "out of memory");
    Walk walk = {.argc = argc, .next = 1, .argv = argv};
    size_t count;
    const char *quality = NULL;
    result = find_files(scene, walk, files, &count, &quality, error);
    bool run = result == RESULT_OK && scene->request == REQUEST_RUN;
    if (run) result = open_files(scene, files, count, quality, error);
    free(files);
    if (run && result == RESULT_OK) result = apply_flags(scene, walk, error);
    if (run && result == RESULT_OK) result = check_arguments(scene, error);
    return result;
}
