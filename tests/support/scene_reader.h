// SPDX-License-Identifier: MIT
// Scenes from command lines and from scene files, for tests.
#pragma once

#include "scene/scene.h"

// Reads a command line of tractrix-render, split at blanks. The test fails unless it is valid.
void assert_read(Scene *scene, const char *line);

// The test fails unless the command line is refused with `expected` and one line that contains
// `message`.
void assert_refused(const char *line, Result expected, const char *message);

// Writes a scene file to the test's folder (temporary.h) and returns its path.
const char *write_scene(void **state, const char *text);
Result read_scene(void **state, Scene *scene, const char *text, Error *error);
