// SPDX-License-Identifier: MIT
#include "run/run_paths.h"
#include "base/paths.h"
#include "formats/format.h"
#include "run/record.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

// The parameters that name outputs; all other path parameters name inputs.
static const char *const WRITTEN[] = {"output", "cache", "export", "stats"};
enum { WRITTEN_COUNT = sizeof WRITTEN / sizeof *WRITTEN };

static const char *path_of(const ParamInfo *info, const void *params)
{
    return *(char *const *)((const char *)params + info->offset);
}

static bool is_written(const ParamInfo *info)
{
    for (int i = 0; i < WRITTEN_COUNT; ++i)
        if (strcmp(info->name, WRITTEN[i]) == 0) return true;
    return false;
}

// --- Where a scene file may write.

static Result check_allowance(const Scene *scene, Error *error)
{
    size_t allow = (size_t)(params_find("allow_paths") - PARAM_TABLE);
    if (!scene->file || !scene->run.allow_paths || scene->origin[allow] == ORIGIN_FLAG)
        return RESULT_OK;
    return error_set(error, RESULT_BAD_INPUT,
                     "%.300s: allow_paths: expected this option on the command line only",
                     scene->file);
}

// The scene file if it, not the command line, names this output. Such an output must stay in the
// scene file's folder.
static const char *find_home(const Scene *scene, const char *param)
{
    const ParamInfo *info = params_find(param);
    bool own = scene->origin[info - PARAM_TABLE] == ORIGIN_SHARED_KEY;
    return own && !scene->run.allow_paths ? scene->file : NULL;
}

// --- What a scene file may read: any regular file, but no device or pipe, whose reading might
// never end.

static Result check_input(const Scene *scene, const char *path, Error *error)
{
    struct stat status;
    if (!*path || stat(path, &status) != 0 || S_ISREG(status.st_mode) || S_ISDIR(status.st_mode))
        return RESULT_OK; // the reader reports missing files and folders
    return error_set(error, RESULT_BAD_INPUT,
                     "%.300s: %.300s is a device or pipe: expected a plain file", scene->file,
                     path);
}

static Result check_inputs(const Scene *scene, Error *error)
{
    for (uint32_t i = 0; scene->file && i < scene->section_count; ++i)
        TRY(check_input(scene, scene->sections[i].file, error));
    for (size_t row = 0; scene->file && row < PARAM_COUNT; ++row) {
        const ParamInfo *info = &PARAM_TABLE[row];
        if (info->kind != PARAM_PATH || is_written(info)) continue;
        for (uint32_t i = 0; i < scene_count(scene, info->scope); ++i)
            if (scene_origins(scene, info->scope, i)[row] != ORIGIN_FLAG)
                TRY(check_input(scene, path_of(info, scene_params(scene, info->scope, i)), error));
    }
    return RESULT_OK;
}

// --- All paths of a run.

typedef struct List {
    PathUse *uses;
    char (*names)[64];
    int count;
} List;

static void add(List *list, const char *name, const char *path, PathRole role, const char *home)
{
    snprintf(list->names[list->count], sizeof *list->names, "%s", name);
    list->uses[list->count] = (PathUse){list->names[list->count], path, role, home};
    ++list->count;
}

static PathRole role_of(const ParamInfo *info)
{
    if (!is_written(info)) return PATH_READ;
    if (strcmp(info->name, "cache") == 0) return PATH_KEPT;
    return strcmp(info->name, "stats") == 0 ? PATH_WRITTEN : PATH_TARGET;
}

// Adds the parameters of this scope that are paths (rows of PARAM_TABLE), of one element of it.
static void add_params(List *list, const Scene *scene, ParamScope scope, uint32_t element)
{
    const void *params = scene_params(scene, scope, element);
    for (size_t i = 0; i < PARAM_COUNT; ++i) {
        const ParamInfo *info = &PARAM_TABLE[i];
        char flag[64] = "--";
        if (info->kind != PARAM_PATH || info->scope != scope) continue;
        for (size_t k = 0; k < sizeof flag - 3 && info->name[k]; ++k)
            flag[k + 2] = info->name[k] == '_' ? '-' : info->name[k];
        add(list, flag, path_of(info, params), role_of(info),
            is_written(info) ? find_home(scene, info->name) : NULL);
    }
}

// The path of the record file, which is written beside numbered files of formats without texts.
// NULL if there is none.
static char *find_record(const char *path,
                         Result (*parse)(Target *target, const char *text, Error *error))
{
    Target target = {0};
    bool known = *path && parse(&target, path, NULL) == RESULT_OK;
    bool texts = parse == target_parse && target.format != TARGET_PFM;
    char *record = known && !texts ? record_path(&target) : NULL;
    target_destroy(&target);
    return record;
}

// The names in `list` must live as long as the claims, until the program ends.
Result run_paths_claim(const Scene *scene, Error *error)
{
    enum { RUN_PATHS = 16, BODY_PATHS = 2, SECTION_PATHS = 4 };
    static List list;
    size_t room = RUN_PATHS + (size_t)scene->body_count * BODY_PATHS +
                  (size_t)scene->section_count * SECTION_PATHS;
    TRY(check_allowance(scene, error));
    TRY(check_inputs(scene, error));
    char *state = NULL; // the state file that --cache writes beside the cache
    char *records[2] = {find_record(scene->run.output, target_parse),
                        find_record(scene->run.export, format_target)};
    free(list.names);
    list =
        (List){.uses = calloc(room, sizeof *list.uses), .names = calloc(room, sizeof *list.names)};
    bool there = list.uses && list.names &&
                 asprintf(&state, "%s%s", scene->run.cache, *scene->run.cache ? ".state" : "") >= 0;
    Result result = there ? RESULT_OK : error_set(error, RESULT_FAILED, "no memory for paths");
    if (result == RESULT_OK) {
        add(&list, "the scene file", scene->file, PATH_READ, NULL);
        add_params(&list, scene, SCOPE_RUN, 0);
        for (uint32_t b = 0; b < scene->body_count; ++b) add_params(&list, scene, SCOPE_BODY, b);
        add(&list, "--cache's state", state, PATH_KEPT, find_home(scene, "cache"));
        add(&list, "--output's record", records[0], PATH_KEPT, find_home(scene, "output"));
        add(&list, "--export's record", records[1], PATH_KEPT, find_home(scene, "export"));
        for (uint32_t i = 0; i < scene->section_count; ++i) {
            add(&list, "the hair file", scene->sections[i].file, PATH_READ, NULL);
            add_params(&list, scene, SCOPE_SECTION, i);
        }
        result = paths_claim(list.uses, list.count, error);
    }
    free(list.uses);
    list.uses = NULL;
    free(state);
    free(records[0]);
    free(records[1]);
    return result;
}
