// SPDX-License-Identifier: MIT
// The value of a parameter in a scene file.
//
// Numbers, true and false are written as JSON values, vectors and sizes as arrays of numbers.
// Values that have another form as a flag (a color, auto, a unit, a word, WxH) are strings of that
// form.
#pragma once

#include "base/json.h"
#include "base/params.h"

// Reads `value` into the parameter's field of `params`. A relative path is put behind `folder` (""
// or ending in '/'; NULL leaves paths unchanged). RESULT_BAD_INPUT with the place if the value has
// the wrong type or is out of range, RESULT_FAILED when memory is short.
Result scene_param_read(const ParamInfo *info, void *params, const char *folder,
                        const JsonPlace *place, const json_t *value, Error *error);

// Joins `path` to `folder` as above; the caller frees the result. NULL when memory is short.
char *scene_param_join_path(const char *folder, const char *path);

// The field's value in a form that scene_param_read reads back exactly. NULL when memory is short.
json_t *scene_param_write(const ParamInfo *info, const void *params);

// A number, or an array of numbers, as doubles that print as the shortest decimals of the floats.
json_t *scene_param_write_float(float value);
json_t *scene_param_write_floats(const float *values, size_t count);

// A string. If it is not UTF-8, which file names need not be, each byte over 127 becomes '?'.
json_t *scene_param_write_text(const char *text);
