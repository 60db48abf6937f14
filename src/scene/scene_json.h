// SPDX-License-Identifier: MIT
// The inner half of reading a scene file.
#pragma once

#include "scene/scene.h"

// As scene_read, but without scene_check, so that flags may still mend a combination.
Result scene_read_unchecked(Scene *scene, const char *path, const char *quality, Error *error);
