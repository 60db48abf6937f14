// SPDX-License-Identifier: MIT
#include "scene/scene.h"

#include "base/bytes.h"

#include <string.h>

bool scene_is_file(const char *path)
{
    size_t length = strlen(path);
    if (length >= 5 && strcmp(path + length - 5, ".json") == 0) return true;
    char beginning[257];
    size_t size = bytes_peek(path, beginning, sizeof beginning - 1);
    beginning[size] = 0;
    bool binary = memchr(beginning, 0, size) != NULL;
    const char *text = beginning + (strncmp(beginning, "\xef\xbb\xbf", 3) == 0 ? 3 : 0);
    return !binary && text[strspn(text, " \t\r\n")] == '{';
}

static Result add_sections(Scene *scene, const char *const *files, size_t count,
                           const Presets *presets, Error *error)
{
    SectionParams defaults;
    Result result = params_create_section(&defaults, error);
    THEN(result, scene_apply_presets(presets, SCOPE_RUN, &scene->run, error));
    THEN(result, scene_apply_presets(presets, SCOPE_SECTION, &defaults, error));
    for (size_t i = 0; i < count; i++)
        THEN(result, scene_add_section(scene, files[i], &defaults, error));
    params_destroy_section(&defaults);
    return result;
}

Result scene_open(Scene *scene, const char *const *files, size_t count,
                  const SceneOverrides *overrides, Error *error)
{
    const char *scene_file = NULL;
    for (size_t i = 0; i < count; i++) {
        if (!files[i][0])
            return error_set(error, RESULT_USAGE,
                             "got an empty name, expected the name of a hair or scene file");
        if (scene_is_file(files[i])) scene_file = files[i];
    }
    if (!scene_file) return add_sections(scene, files, count, &overrides->presets, error);
    if (count > 1)
        return error_set(error, RESULT_USAGE,
                         "%.200s is a scene file: expected no other file with it (hair files "
                         "belong in its 'sections')",
                         scene_file);
    scene_destroy(scene);
    return scene_read_unchecked(scene, scene_file, overrides, error);
}
