// SPDX-License-Identifier: MIT
// The inner half of reading a scene file.
#pragma once

#include "scene/scene.h"

// What the command line says of values that others depend on; NULL: nothing.
typedef struct SceneOverrides {
    const char *quality; // counts instead of the file's
    const char *algo;    // whose parameters are right in any section
} SceneOverrides;

// As scene_read, but without scene_check, so that flags may still mend a combination.
Result scene_read_unchecked(Scene *scene, const char *path, const SceneOverrides *overrides,
                            Error *error);
