// SPDX-License-Identifier: MIT
#include "bench/scene_words.h"

#include <stdio.h>
#include <string.h>

enum { MOST_WORDS = 64 };

Result scene_words_read(Scene *scene, char **words, const char *const *names,
                        const char *const flags[SCENE_WORDS_FLAGS], Error *error)
{
    char *argv[MOST_WORDS] = {"tractrix-render"}, *rest;
    int argc = 1;
    *scene = (Scene){0};
    if (asprintf(words, "%s %s %s %s", flags[0], flags[1], flags[2], flags[3]) < 0) {
        *words = NULL;
        return error_set(error, RESULT_FAILED, "no memory for flags");
    }
    while (*names) argv[argc++] = (char *)*names++;
    for (char *word = strtok_r(*words, " ", &rest); word; word = strtok_r(NULL, " ", &rest)) {
        if (argc == MOST_WORDS)
            return error_set(error, RESULT_USAGE, "too many options: expected at most %d words",
                             MOST_WORDS);
        argv[argc++] = word;
    }
    TRY(scene_from_arguments(scene, argc, argv, error));
    return scene->request == REQUEST_RUN
               ? RESULT_OK
               : error_set(
                     error, RESULT_USAGE,
                     "got an option that only prints, such as --help: expected options of a run");
}
