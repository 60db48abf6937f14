// SPDX-License-Identifier: MIT
// A scene from words of tractrix-render's command line, as a table's row states them.
#pragma once

#include "scene/scene.h"

enum { SCENE_WORDS_FLAGS = 4 };

// Reads a scene file, or hair. `names`: words that are taken unchanged (the file, a flag and a
// path), NULL-terminated; `flags`: texts of words separated by blanks. *words must outlive the
// scene and belongs to the caller in either case. RESULT_USAGE for flags that ask for help; errors
// of scene_from_arguments. The scene may be destroyed in either case.
Result scene_words_read(Scene *scene, char **words, const char *const *names,
                        const char *const flags[SCENE_WORDS_FLAGS], Error *error);
