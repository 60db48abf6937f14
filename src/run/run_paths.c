// SPDX-License-Identifier: MIT
#include "run/run_paths.h"
#include "base/paths.h"
#include "run/record.h"
#include "strands/formats/format.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

// The parameters that name what is written; all other paths are read.
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

// The deepest folder of `path` that exists, links resolved, and what follows it in `path`. NULL
// when memory is short.
static char *find_folder(const char *path, const char **rest)
{
    char *name = strdup(path), *found = NULL;
    *rest = path;
    for (char *slash = name ? strrchr(name, '/') : NULL; slash && !found;
         slash = strrchr(name, '/')) {
        *rest = path + (slash - name) + 1;
        *slash = 0;
        found = realpath(*name ? name : "/", NULL);
    }
    if (name && !found) {
        *rest = path;
        found = realpath(".", NULL);
    }
    free(name);
    return found;
}

static bool is_within(const char *folder, const char *path)
{
    size_t length = strlen(folder);
    bool root = strcmp(folder, "/") == 0;
    return root ||
           (strncmp(path, folder, length) == 0 && (path[length] == '/' || path[length] == 0));
}

static bool climbs(const char *path)
{
    for (const char *at = strstr(path, ".."); at; at = strstr(at + 1, ".."))
        if ((at == path || at[-1] == '/') && (at[2] == '/' || at[2] == 0)) return true;
    return false;
}

static Result check_place(const Scene *scene, const ParamInfo *info, const char *path, Error *error)
{
    const char *rest, *unused;
    char *home = find_folder(scene->file, &unused), *there = find_folder(path, &rest);
    char *target = realpath(path, NULL); // of a link, which may lead elsewhere
    Result result = RESULT_OK;
    if (!home || !there)
        result = error_set(error, RESULT_FAILED, "no memory for paths");
    else if (!is_within(home, target ? target : there) || (!target && climbs(rest)))
        result = error_set(error, RESULT_BAD_INPUT,
                           "%.300s: %s: %.300s is outside the scene file's folder: expected "
                           "--allow-paths, or the path on the command line",
                           scene->file, info->name, path);
    free(home);
    free(there);
    free(target);
    return result;
}

static Result check_places(const Scene *scene, Error *error)
{
    size_t allow = (size_t)(params_find("allow_paths") - PARAM_TABLE);
    if (!scene->file) return RESULT_OK;
    if (scene->run.allow_paths && scene->origin[allow] != ORIGIN_FLAG)
        return error_set(error, RESULT_BAD_INPUT,
                         "%.300s: allow_paths: expected it on the command line only", scene->file);
    for (int i = 0; i < WRITTEN_COUNT && !scene->run.allow_paths; ++i) {
        const ParamInfo *info = params_find(WRITTEN[i]);
        const char *path = path_of(info, &scene->run);
        if (*path && scene->origin[info - PARAM_TABLE] == ORIGIN_SHARED_KEY)
            TRY(check_place(scene, info, path, error));
    }
    return RESULT_OK;
}

// --- What a scene file may read: any file, but nothing that may never end.

static Result check_input(const Scene *scene, const char *path, Error *error)
{
    struct stat status;
    if (!*path || stat(path, &status) != 0 || S_ISREG(status.st_mode) || S_ISDIR(status.st_mode))
        return RESULT_OK; // what is missing or a folder is reported by its reader
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
        if (info->scope == SCOPE_RUN && scene->origin[row] != ORIGIN_FLAG)
            TRY(check_input(scene, path_of(info, &scene->run), error));
        for (uint32_t i = 0; info->scope == SCOPE_SECTION && i < scene->section_count; ++i)
            if (scene->sections[i].origin[row] != ORIGIN_FLAG)
                TRY(check_input(scene, path_of(info, &scene->sections[i].params), error));
    }
    return RESULT_OK;
}

// --- All of them.

typedef struct List {
    PathUse *uses;
    char (*names)[64];
    int count;
} List;

static void add(List *list, const char *name, const char *path, PathRole role)
{
    snprintf(list->names[list->count], sizeof *list->names, "%s", name);
    list->uses[list->count] = (PathUse){list->names[list->count], path, role};
    ++list->count;
}

// The rows of PARAM_TABLE that are paths of this scope.
static void add_params(List *list, ParamScope scope, const void *params)
{
    for (size_t i = 0; i < PARAM_COUNT; ++i) {
        const ParamInfo *info = &PARAM_TABLE[i];
        char flag[64] = "--";
        if (info->kind != PARAM_PATH || info->scope != scope) continue;
        for (size_t k = 0; k < sizeof flag - 3 && info->name[k]; ++k)
            flag[k + 2] = info->name[k] == '_' ? '-' : info->name[k];
        add(list, flag, path_of(info, params), is_written(info) ? PATH_WRITTEN : PATH_READ);
    }
}

// What is written beside numbered files that have no texts. NULL: nothing.
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

Result run_paths_check(const Scene *scene, Error *error)
{
    enum { RUN_PATHS = 16, SECTION_PATHS = 4 };
    size_t room = RUN_PATHS + (size_t)scene->section_count * SECTION_PATHS;
    List list = {.uses = calloc(room, sizeof *list.uses),
                 .names = calloc(room, sizeof *list.names)};
    char *state = NULL; // what --cache writes beside the cache
    char *records[2] = {find_record(scene->run.output, target_parse),
                        find_record(scene->run.export, format_target)};
    Result result = check_places(scene, error);
    THEN(result, check_inputs(scene, error));
    bool there = list.uses && list.names &&
                 asprintf(&state, "%s%s", scene->run.cache, *scene->run.cache ? ".state" : "") >= 0;
    if (result == RESULT_OK && !there)
        result = error_set(error, RESULT_FAILED, "no memory for paths");
    if (result == RESULT_OK) {
        add(&list, "the scene file", scene->file, PATH_READ);
        add_params(&list, SCOPE_RUN, &scene->run);
        add(&list, "--cache's state", state, PATH_WRITTEN);
        add(&list, "--output's record", records[0], PATH_WRITTEN);
        add(&list, "--export's record", records[1], PATH_WRITTEN);
        for (uint32_t i = 0; i < scene->section_count; ++i) {
            add(&list, "the hair file", scene->sections[i].file, PATH_READ);
            add_params(&list, SCOPE_SECTION, &scene->sections[i].params);
        }
        result = paths_check(list.uses, list.count, error);
    }
    free(list.uses);
    free(list.names);
    free(state);
    free(records[0]);
    free(records[1]);
    return result;
}
