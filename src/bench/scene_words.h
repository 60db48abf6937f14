// SPDX-License-Identifier: MIT
// A scene by words of tractrix-render's command line, as a row of a table states them.
#pragma once

#include "scene/scene.h"

enum { SCENE_WORDS_FLAGS = 4 };

// Reads a scene file, or hair: `names` are words that are taken as they are (the file, a flag and a
// path), ended by NULL; `flags` texts of words with blanks between them. *words has to outlive the
// scene and is the caller's in either case. RESULT_USAGE for flags that ask for help; errors of
// scene_from_arguments. The scene may be destroyed in either case.
Result scene_words_read(Scene *scene, char **words, const char *const *names,
                        const char *const flags[SCENE_WORDS_FLAGS], Error *error);
