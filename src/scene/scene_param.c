// SPDX-License-Identifier: MIT
#include "scene/scene_param.h"

#include "base/decimal.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TEXT_SIZE = 512, NUMBERS_MAX = 3 };

// The JSON types that a kind's value may have.
typedef struct Form {
    bool boolean, number, string;
    size_t numbers; // length of an array of numbers; 0 if no array is allowed
    bool points;    // an array of points [place, value]
} Form;

static const Form FORMS[] = {
    [PARAM_BOOL] = {.boolean = true},
    [PARAM_INT] = {.number = true},
    [PARAM_UINT] = {.number = true},
    [PARAM_FLOAT] = {.number = true},
    [PARAM_PROFILE] = {.number = true, .points = true},
    [PARAM_RATE] = {.string = true, .number = true},
    [PARAM_TURN] = {.number = true},
    [PARAM_VEC3] = {.numbers = 3},
    [PARAM_COLOR] = {.string = true, .numbers = 3},
    [PARAM_BACKGROUND] = {.string = true, .numbers = 3},
    [PARAM_AUTO_INT] = {.string = true, .number = true},
    [PARAM_AUTO_FLOAT] = {.string = true, .number = true},
    [PARAM_AUTO_VEC3] = {.string = true, .numbers = 3},
    [PARAM_AUTO_COLOR] = {.string = true, .numbers = 3},
    [PARAM_UNIT] = {.string = true, .number = true},
    [PARAM_SIZE] = {.string = true, .numbers = 2},
    [PARAM_PART] = {.string = true},
    [PARAM_CHOICE] = {.string = true},
    [PARAM_TEXT] = {.string = true},
    [PARAM_PATH] = {.string = true},
};

// Writes the number like the value of a flag. Returns its length.
static int number_to_text(const json_t *value, char *text, size_t size)
{
    if (json_is_integer(value))
        return snprintf(text, size, "%" JSON_INTEGER_FORMAT, json_integer_value(value));
    return snprintf(text, size, "%.17g", json_real_value(value));
}

// Writes an array of numbers like the value of a flag; false if the value is anything else.
static bool array_to_text(const json_t *value, size_t count, char separator, char text[TEXT_SIZE])
{
    if (!json_is_array(value) || json_array_size(value) != count || count > NUMBERS_MAX)
        return false;
    int length = 0;
    for (size_t i = 0; i < count; i++) {
        const json_t *number = json_array_get(value, i);
        if (!json_is_number(number)) return false;
        if (i > 0) text[length++] = separator;
        length += number_to_text(number, text + length, TEXT_SIZE - (size_t)length);
    }
    return true;
}

// Writes an array of points [place, value] like the value of a flag: value@place:value@place.
static bool points_to_text(const json_t *value, char text[TEXT_SIZE])
{
    size_t count = json_array_size(value);
    int length = 0;
    if (!json_is_array(value) || !count || count > PROFILE_MOST) return false;
    for (size_t i = 0; i < count; i++) {
        const json_t *point = json_array_get(value, i), *place = json_array_get(point, 0),
                     *number = json_array_get(point, 1);
        if (json_array_size(point) != 2 || !json_is_number(place) || !json_is_number(number))
            return false;
        if (i > 0) text[length++] = ':';
        length += number_to_text(number, text + length, TEXT_SIZE - (size_t)length);
        text[length++] = '@';
        length += number_to_text(place, text + length, TEXT_SIZE - (size_t)length);
    }
    return true;
}

// The value as the text of a flag, in `buffer` or in the JSON value itself; NULL if its type is
// wrong for the kind.
static const char *value_to_text(ParamKind kind, const json_t *value, char buffer[TEXT_SIZE])
{
    const Form *form = &FORMS[kind];
    if (form->boolean && json_is_boolean(value)) return json_is_true(value) ? "true" : "false";
    if (form->string && json_is_string(value)) return json_string_value(value);
    if (form->number && json_is_number(value)) {
        number_to_text(value, buffer, TEXT_SIZE);
        return buffer;
    }
    if (form->points && points_to_text(value, buffer)) return buffer;
    char separator = kind == PARAM_SIZE ? 'x' : ',';
    return form->numbers && array_to_text(value, form->numbers, separator, buffer) ? buffer : NULL;
}

// Like params_describe, but for JSON.
static void describe_value(const ParamInfo *info, char *text, size_t size)
{
    char flag[160];
    params_describe(info, flag, sizeof flag);
    const Form *form = &FORMS[info->kind];
    if (form->points) {
        snprintf(text, size,
                 "a number from %.10g to %.10g, or points along the strand, "
                 "[[place, number], ...]",
                 info->minimum, info->maximum);
        return;
    }
    bool vector = form->numbers == 3 && info->kind != PARAM_COLOR &&
                  info->kind != PARAM_AUTO_COLOR && info->kind != PARAM_BACKGROUND;
    snprintf(text, size, "%s%s%s",
             form->string && !form->number && !form->numbers ? "a string: " : "", flag,
             vector ? ", as an array" : "");
}

char *scene_param_join_path(const char *folder, const char *path)
{
    if (!folder || path[0] == '/' || !path[0]) return strdup(path);
    char *joined = NULL;
    return asprintf(&joined, "%s%s", folder, path) < 0 ? NULL : joined;
}

Result scene_param_read(const ParamInfo *info, void *params, const char *folder,
                        const JsonPlace *place, const json_t *value, Error *error)
{
    char buffer[TEXT_SIZE];
    const char *text = value_to_text(info->kind, value, buffer);
    if (!text) {
        char expected[200];
        describe_value(info, expected, sizeof expected);
        return json_refuse(place, value, expected, error);
    }
    char *path = NULL;
    if (info->kind == PARAM_PATH) {
        path = scene_param_join_path(folder, text);
        if (!path) return error_set(error, RESULT_FAILED, "out of memory");
    }
    Error why = {{0}};
    Result result = params_parse(info, params, path ? path : text, &why);
    free(path);
    if (result == RESULT_USAGE) return json_fail(place, error, "%s", why.text);
    return result == RESULT_OK ? result : error_set(error, result, "%s", why.text);
}

json_t *scene_param_write_float(float value)
{
    char text[32];
    decimal_format(value, text, sizeof text);
    return json_real(strtod(text, NULL));
}

json_t *scene_param_write_floats(const float *values, size_t count)
{
    json_t *array = json_array();
    for (size_t i = 0; i < count; i++) {
        if (json_array_append_new(array, scene_param_write_float(values[i])) == 0) continue;
        json_decref(array);
        return NULL;
    }
    return array;
}

json_t *scene_param_write_text(const char *text)
{
    json_t *string = json_string(text);
    if (string) return string;
    char *copy = strdup(text);
    for (char *at = copy; at && *at; at++) {
        if ((unsigned char)*at >= 128) *at = '?';
    }
    string = copy ? json_string(copy) : NULL;
    free(copy);
    return string;
}

static json_t *write_profile(const ProfileNumber *number)
{
    if (!number->along.count) return scene_param_write_float(number->mean);
    json_t *points = json_array();
    for (uint32_t i = 0; i < number->along.count; i++) {
        const float point[2] = {number->along.at[i], number->along.value[i]};
        json_t *pair = scene_param_write_floats(point, 2);
        if (pair && json_array_append_new(points, pair) == 0) continue;
        json_decref(points);
        return NULL;
    }
    return points;
}

json_t *scene_param_write(const ParamInfo *info, const void *params)
{
    const void *field = (const char *)params + info->offset;
    const AutoInt *whole = field;
    const AutoFloat *number = field;
    const AutoVec3 *vector = field;
    const int *size = field;
    switch (info->kind) {
    case PARAM_BOOL:
        return json_boolean(*(const bool *)field);
    case PARAM_INT:
        return json_integer(*(const int *)field);
    case PARAM_UINT:
        return json_integer(*(const uint32_t *)field);
    case PARAM_FLOAT:
    case PARAM_TURN:
        return scene_param_write_float(*(const float *)field);
    case PARAM_RATE:
        return json_real(*(const double *)field);
    case PARAM_PROFILE:
        return write_profile(field);
    case PARAM_VEC3:
        return scene_param_write_floats(field, 3);
    case PARAM_AUTO_INT:
        return whole->automatic ? json_string("auto") : json_integer(whole->value);
    case PARAM_AUTO_FLOAT:
    case PARAM_UNIT:
        return number->automatic ? json_string("auto") : scene_param_write_float(number->value);
    case PARAM_AUTO_VEC3:
        return vector->automatic ? json_string("auto") : scene_param_write_floats(vector->value, 3);
    case PARAM_SIZE:
        return json_pack("[i, i]", size[0], size[1]);
    // These are written like flags; a color without whole levels becomes "r,g,b".
    case PARAM_PART:
    case PARAM_COLOR:
    case PARAM_AUTO_COLOR:
    case PARAM_BACKGROUND:
    case PARAM_CHOICE:
    case PARAM_TEXT:
    case PARAM_PATH:
        break;
    }
    char *text = params_format(info, params);
    json_t *value = text ? scene_param_write_text(text) : NULL;
    free(text);
    return value;
}
