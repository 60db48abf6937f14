// SPDX-License-Identifier: MIT
// The animated parts of a scene file, and its lights.
#pragma once

#include "base/json.h"
#include "scene/scene.h"

// Limits of the values in files: times (s), positions and rotations (m, deg), a light's intensity,
// smallest distance (m) and cone (deg).
#define SCENE_TIME_MAX_S    1e9
#define SCENE_OFFSET_MAX    1e6
#define SCENE_INTENSITY_MAX 1e4
#define SCENE_LIGHT_NEAREST 1e-3
#define SCENE_CONE_MIN      0.1
#define SCENE_CONE_MAX      90.0

// Each function reads the value of the key with its name in the scene file; run/render_help.c
// documents them. RESULT_BAD_INPUT with the place, RESULT_FAILED when memory is short.
Result scene_tracks_read_head(RigidTrack *head, const JsonPlace *place, const json_t *value,
                              Error *error);
Result scene_tracks_read_camera(Scene *scene, const JsonPlace *place, const json_t *value,
                                Error *error);
Result scene_tracks_read_lights(Scene *scene, const JsonPlace *place, const json_t *value,
                                Error *error);

// Reads {"keys": [{"time": s, "value": [x, y, z]}, ...], "interpolation": "smooth" | "linear"} or
// {"formula": [x, y, z]}. The values have the range of the constant parameter `info`.
Result scene_tracks_read_force(Track *track, const ParamInfo *info, const JsonPlace *place,
                               const json_t *value, Error *error);

// The same for a number of a section, whose formula is one text, or for a color: three numbers or
// the form of a flag, without formulas.
Result scene_tracks_read_number(Track *track, const ParamInfo *info, bool color,
                                const JsonPlace *place, const json_t *value, Error *error);

// The words of "interpolation" and of a light's "type", by enumerator, terminated by NULL.
extern const char *const INTERPOLATION_WORDS[];
extern const char *const LIGHT_KIND_WORDS[];
