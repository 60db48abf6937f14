// SPDX-License-Identifier: MIT
#include "support/scene_reader.h"
#include "support/temporary.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

enum { ARGUMENTS_MAX = 32 };

// Reads a command line, given as one text that is split at blanks, without the program's name.
static Result read_arguments(Scene *scene, const char *line, Error *error)
{
    char copy[2000];
    snprintf(copy, sizeof copy, "%s", line);
    char *argv[ARGUMENTS_MAX + 1] = {"tractrix-render"};
    int argc = 1;
    char *rest = copy;
    for (char *word; (word = strsep(&rest, " "));)
        if (*word) argv[argc++] = word;
    return scene_from_arguments(scene, argc, argv, error);
}

void assert_read(Scene *scene, const char *line)
{
    Error error = {{0}};
    if (read_arguments(scene, line, &error) != RESULT_OK) fail_msg("%s: %s", line, error.text);
}

void assert_refused(const char *line, Result expected, const char *message)
{
    Scene scene;
    Error error = {{0}};
    Result result = read_arguments(&scene, line, &error);
    scene_destroy(&scene);
    if (result != expected || !strstr(error.text, message))
        fail_msg("%s: status %d, '%s' lacks '%s'", line, result, error.text, message);
    assert_null(strchr(error.text, '\n'));
}

const char *write_scene(void **state, const char *text)
{
    temporary_write(state, "scene.json", text, 0644);
    return temporary_path(state, "scene.json");
}

Result read_scene(void **state, Scene *scene, const char *text, Error *error)
{
    return scene_read(scene, write_scene(state, text), error);
}
