// SPDX-License-Identifier: MIT
// A parameter's value in a scene file.
//
// Numbers, true and false are written as such, vectors and sizes as arrays of numbers; what has
// another form as a flag (a color, auto, a unit, a word, WxH) is a string of that form.
#pragma once

#include "base/json.h"
#include "base/params.h"

// Reads `value` into the row's field of `params`. A path that is not absolute is put behind
// `folder` ("" or ended by '/'; NULL leaves paths as they are). RESULT_BAD_INPUT with the place if
// the value has the wrong type or is out of range, RESULT_FAILED when memory is short.
Result scene_param_read(const ParamInfo *info, void *params, const char *folder,
                        const JsonPlace *place, const json_t *value, Error *error);

// `path` behind `folder`, as above; the caller frees it. NULL when memory is short.
char *scene_param_join_path(const char *folder, const char *path);

// The field's value, of a form that scene_param_read reads back to the same bits. NULL when memory
// is short.
json_t *scene_param_write(const ParamInfo *info, const void *params);

// The number, or the array of numbers, as doubles that print as the shortest decimals of the
// floats.
json_t *scene_param_write_float(float value);
json_t *scene_param_write_floats(const float *values, size_t count);

// A string; if it isn't UTF-8, which names of files need not be, with '?' for each byte over 127.
json_t *scene_param_write_text(const char *text);
