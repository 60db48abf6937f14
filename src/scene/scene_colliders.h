// SPDX-License-Identifier: MIT
// The colliders of a scene file.
#pragma once

#include "base/json.h"
#include "scene/scene.h"

// Reads the value of "colliders": an array of {"sphere": [x, y, z, radius], "frame": "head" or
// "world"} and of other shapes (colliders.h), or a text as the flag has it. RESULT_BAD_INPUT with
// the place, RESULT_FAILED when memory is short.
Result scene_read_colliders(Scene *scene, const JsonPlace *place, const json_t *value,
                            Error *error);

// The array that scene_read_colliders reads back. NULL when memory is short.
json_t *scene_write_colliders(const Colliders *colliders);
