// SPDX-License-Identifier: MIT
// The parts of a scene file that change over time, and its lights.
#pragma once

#include "base/json.h"
#include "scene/scene.h"

// Ranges of what these parts hold, as files have it: times (s), places and turns (m, deg), a
// light's intensity, its least distance (m) and its cone (deg).
#define SCENE_TIME_MAX_S    1e9
#define SCENE_OFFSET_MAX    1e6
#define SCENE_INTENSITY_MAX 1e4
#define SCENE_LIGHT_NEAREST 1e-3
#define SCENE_CONE_MIN      0.1
#define SCENE_CONE_MAX      90.0

// Each reads the value of the key that its name has in the scene file; run/render_help.c
// explains them to users. RESULT_BAD_INPUT with the place, RESULT_FAILED when memory is short.
Result scene_tracks_read_head(Scene *scene, const JsonPlace *place, const json_t *value,
                              Error *error);
Result scene_tracks_read_camera(Scene *scene, const JsonPlace *place, const json_t *value,
                                Error *error);
Result scene_tracks_read_lights(Scene *scene, const JsonPlace *place, const json_t *value,
                                Error *error);

// {"keys": [{"time": s, "value": [x, y, z]}, ...], "interpolation": "smooth" | "linear"} into
// `keys`, whose numbers have the range of the constant parameter `info`.
Result scene_tracks_read_keys(Keyframes *keys, const ParamInfo *info, const JsonPlace *place,
                              const json_t *value, Error *error);

// The same of one number of a section, or of a color: three numbers or what colors have for flags.
Result scene_tracks_read_numbers(Keyframes *keys, const ParamInfo *info, bool color,
                                 const JsonPlace *place, const json_t *value, Error *error);

// The words of "interpolation" and of a light's "type", by enumerator, ended by NULL.
extern const char *const INTERPOLATION_WORDS[];
extern const char *const LIGHT_KIND_WORDS[];

extern const double DEGREE; // in radians
