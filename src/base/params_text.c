// SPDX-License-Identifier: MIT
// The half of params.h that turns values into text and back.
#include "base/params.h"

#include "base/decimal.h"
#include "base/suggest.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The units that have a name, in metres.
static const struct {
    const char *word;
    float metres;
} LENGTH_UNITS[] = {{"m", 1.0f}, {"cm", 0.01f}, {"mm", 0.001f}, {"in", 0.0254f}};
enum { LENGTH_UNIT_COUNT = sizeof LENGTH_UNITS / sizeof LENGTH_UNITS[0] };

// A value on its way in: what the user wrote, and what it should have been.
typedef struct Input {
    const ParamInfo *info;
    const char *text;
    Error *error;
} Input;

static Result refuse(const Input *input, const char *nearest)
{
    char expected[200];
    params_describe(input->info, expected, sizeof expected);
    char got[64];
    snprintf(got, sizeof got, "%s", input->text);
    for (char *at = got; *at; at++) {
        if ((unsigned char)*at < ' ' || *at == 127) *at = '?';
    }
    const char *dots = strlen(input->text) >= sizeof got ? "..." : "";
    if (!nearest)
        return error_set(input->error, RESULT_USAGE, "got '%s%s', expected %s", got, dots,
                         expected);
    return error_set(input->error, RESULT_USAGE, "got '%s%s', expected %s (nearest: %s)", got, dots,
                     expected, nearest);
}

static const char *skip_blanks(const char *text)
{
    return text + strspn(text, " \t");
}

// A decimal number with blanks around it; returns what follows, or NULL if there is none. strtod
// alone would also take hexadecimal, infinity and NaN.
static const char *read_number(const char *text, double *number)
{
    text = skip_blanks(text);
    size_t length = strspn(text, "0123456789+-.eE");
    char *end;
    *number = strtod(text, &end);
    if (end == text || end > text + length) return NULL;
    return skip_blanks(end);
}

// Exactly `count` numbers with `separator` between them, each in the row's range.
static Result read_numbers(const Input *input, int count, char separator, double *numbers)
{
    const char *at = input->text;
    for (int i = 0; i < count; i++) {
        if (i > 0 && *at++ != separator) return refuse(input, NULL);
        at = read_number(at, &numbers[i]);
        if (!at) return refuse(input, NULL);
    }
    if (*at) return refuse(input, NULL);
    for (int i = 0; i < count; i++) {
        double inside = fmin(fmax(numbers[i], input->info->minimum), input->info->maximum);
        if (numbers[i] == inside) continue;
        char nearest[32];
        snprintf(nearest, sizeof nearest, "%.10g", inside);
        return refuse(input, nearest);
    }
    return RESULT_OK;
}

static Result parse_floats(const Input *input, int count, float *value)
{
    double numbers[3];
    Result result = read_numbers(input, count, ',', numbers);
    for (int i = 0; result == RESULT_OK && i < count; i++) value[i] = (float)numbers[i];
    return result;
}

static Result parse_bool(const Input *input, bool *value)
{
    bool yes = strcmp(input->text, "true") == 0;
    if (!yes && strcmp(input->text, "false") != 0) return refuse(input, NULL);
    *value = yes;
    return RESULT_OK;
}

// Integers, too, go through double, which holds all of those that any range allows.
static Result parse_whole(const Input *input, int count, char separator, double *numbers)
{
    if (strpbrk(input->text, ".eE")) return refuse(input, NULL);
    return read_numbers(input, count, separator, numbers);
}

static Result parse_int(const Input *input, int *value)
{
    double number;
    Result result = parse_whole(input, 1, 0, &number);
    if (result == RESULT_OK) *value = (int)number;
    return result;
}

static Result parse_pair(const Input *input, char separator, int value[2])
{
    double numbers[2];
    Result result = parse_whole(input, 2, separator, numbers);
    if (result != RESULT_OK) return result;
    if (input->info->kind == PARAM_PART && numbers[0] > numbers[1]) return refuse(input, NULL);
    for (int i = 0; i < 2; i++) value[i] = (int)numbers[i];
    return RESULT_OK;
}

static Result parse_uint(const Input *input, uint32_t *value)
{
    double number;
    Result result = parse_whole(input, 1, 0, &number);
    if (result == RESULT_OK) *value = (uint32_t)number;
    return result;
}

static Result parse_color(const Input *input, float value[3])
{
    if (input->text[0] != '#') return parse_floats(input, 3, value);
    const char *digits = input->text + 1;
    if (strlen(digits) != 6 || strspn(digits, "0123456789abcdefABCDEF") != 6)
        return refuse(input, NULL);
    unsigned long rgb = strtoul(digits, NULL, 16);
    for (int i = 0; i < 3; i++) value[i] = (float)(rgb >> (16 - 8 * i) & 255) / 255.0f;
    return RESULT_OK;
}

static Result parse_background(const Input *input, float value[4])
{
    if (strcmp(input->text, "transparent") == 0) {
        memset(value, 0, 4 * sizeof value[0]);
        return RESULT_OK;
    }
    Result result = parse_color(input, value);
    if (result == RESULT_OK) value[3] = 1.0f;
    return result;
}

static Result parse_auto_int(const Input *input, AutoInt *value)
{
    AutoInt parsed = {.automatic = strcmp(input->text, "auto") == 0};
    Result result = parsed.automatic ? RESULT_OK : parse_int(input, &parsed.value);
    if (result == RESULT_OK) *value = parsed;
    return result;
}

static Result parse_auto_float(const Input *input, AutoFloat *value)
{
    AutoFloat parsed = {.automatic = strcmp(input->text, "auto") == 0};
    Result result = parsed.automatic ? RESULT_OK : parse_floats(input, 1, &parsed.value);
    if (result == RESULT_OK) *value = parsed;
    return result;
}

static Result parse_auto_vec3(const Input *input, AutoVec3 *value)
{
    AutoVec3 parsed = {.automatic = strcmp(input->text, "auto") == 0};
    Result result = parsed.automatic ? RESULT_OK : parse_floats(input, 3, parsed.value);
    if (result == RESULT_OK) *value = parsed;
    return result;
}

static Result parse_unit(const Input *input, AutoFloat *value)
{
    for (int i = 0; i < LENGTH_UNIT_COUNT; i++) {
        if (strcmp(input->text, LENGTH_UNITS[i].word) != 0) continue;
        *value = (AutoFloat){.value = LENGTH_UNITS[i].metres};
        return RESULT_OK;
    }
    return parse_auto_float(input, value);
}

static Result parse_choice(const Input *input, int *value)
{
    const char *const *choices = input->info->choices;
    int count = 0;
    for (; choices[count]; count++) {
        if (strcmp(input->text, choices[count]) != 0) continue;
        *value = count;
        return RESULT_OK;
    }
    return refuse(input, suggest_nearest(input->text, choices, (size_t)count));
}

static Result parse_text(const Input *input, char **value)
{
    char *copy = strdup(input->text);
    if (!copy) return error_set(input->error, RESULT_FAILED, "out of memory");
    free(*value);
    *value = copy;
    return RESULT_OK;
}

Result params_parse(const ParamInfo *info, void *params, const char *text, Error *error)
{
    void *field = (char *)params + info->offset;
    Input input = {info, text, error};
    switch (info->kind) {
    case PARAM_BOOL:
        return parse_bool(&input, field);
    case PARAM_INT:
        return parse_int(&input, field);
    case PARAM_UINT:
        return parse_uint(&input, field);
    case PARAM_FLOAT:
        return parse_floats(&input, 1, field);
    case PARAM_VEC3:
        return parse_floats(&input, 3, field);
    case PARAM_COLOR:
        return parse_color(&input, field);
    case PARAM_BACKGROUND:
        return parse_background(&input, field);
    case PARAM_AUTO_INT:
        return parse_auto_int(&input, field);
    case PARAM_AUTO_FLOAT:
        return parse_auto_float(&input, field);
    case PARAM_AUTO_VEC3:
        return parse_auto_vec3(&input, field);
    case PARAM_UNIT:
        return parse_unit(&input, field);
    case PARAM_SIZE:
        return parse_pair(&input, 'x', field);
    case PARAM_PART:
        return parse_pair(&input, '/', field);
    case PARAM_CHOICE:
        return parse_choice(&input, field);
    case PARAM_TEXT:
    case PARAM_PATH:
        return parse_text(&input, field);
    }
    return error_set(error, RESULT_FAILED, "parameter %s is of no kind", info->name);
}

static char *format_floats(const float *value, int count)
{
    char number[3][24];
    for (int i = 0; i < count; i++) decimal_format(value[i], number[i], sizeof number[i]);
    if (count == 1) return strdup(number[0]);
    char *text = NULL;
    return asprintf(&text, "%s,%s,%s", number[0], number[1], number[2]) < 0 ? NULL : text;
}

static char *format_color(const float value[3])
{
    unsigned level[3];
    for (int i = 0; i < 3; i++) {
        level[i] = (unsigned)lroundf(value[i] * 255.0f);
        if ((float)level[i] / 255.0f != value[i]) return format_floats(value, 3);
    }
    char *text = NULL;
    return asprintf(&text, "#%02x%02x%02x", level[0], level[1], level[2]) < 0 ? NULL : text;
}

static char *format_unit(const AutoFloat *value)
{
    for (int i = 0; i < LENGTH_UNIT_COUNT; i++) {
        if (value->value == LENGTH_UNITS[i].metres) return strdup(LENGTH_UNITS[i].word);
    }
    return value->automatic ? strdup("auto") : format_floats(&value->value, 1);
}

static char *format_pair(const int value[2], char separator)
{
    char *text = NULL;
    return asprintf(&text, "%d%c%d", value[0], separator, value[1]) < 0 ? NULL : text;
}

static char *format_whole(long long value)
{
    char *text = NULL;
    return asprintf(&text, "%lld", value) < 0 ? NULL : text;
}

char *params_format(const ParamInfo *info, const void *params)
{
    const void *field = (const char *)params + info->offset;
    const AutoInt *whole = field;
    const AutoFloat *number = field;
    const AutoVec3 *vector = field;
    const float *floats = field;
    switch (info->kind) {
    case PARAM_BOOL:
        return strdup(*(const bool *)field ? "true" : "false");
    case PARAM_INT:
        return format_whole(*(const int *)field);
    case PARAM_UINT:
        return format_whole(*(const uint32_t *)field);
    case PARAM_FLOAT:
        return format_floats(floats, 1);
    case PARAM_VEC3:
        return format_floats(floats, 3);
    case PARAM_COLOR:
        return format_color(floats);
    case PARAM_BACKGROUND:
        return floats[3] == 0 ? strdup("transparent") : format_color(floats);
    case PARAM_AUTO_INT:
        return whole->automatic ? strdup("auto") : format_whole(whole->value);
    case PARAM_AUTO_FLOAT:
        return number->automatic ? strdup("auto") : format_floats(&number->value, 1);
    case PARAM_AUTO_VEC3:
        return vector->automatic ? strdup("auto") : format_floats(vector->value, 3);
    case PARAM_UNIT:
        return format_unit(number);
    case PARAM_SIZE:
        return format_pair(field, 'x');
    case PARAM_PART:
        return format_pair(field, '/');
    case PARAM_CHOICE:
        return strdup(info->choices[*(const int *)field]);
    case PARAM_TEXT:
    case PARAM_PATH:
        return strdup(*(char *const *)field);
    }
    return NULL;
}

// "a, b or c".
static void describe_choices(const ParamInfo *info, char *text, size_t size)
{
    size_t length = 0;
    for (int i = 0; info->choices[i] && length < size; i++) {
        const char *between = i == 0 ? "" : info->choices[i + 1] ? ", " : " or ";
        length += (size_t)snprintf(text + length, size - length, "%s%s", between, info->choices[i]);
    }
}

// What a value of each kind is: before and behind its range; without the second it has none.
static const char *const FORMS[][2] = {
    [PARAM_BOOL] = {"true or false", NULL},
    [PARAM_INT] = {"a whole number ", ""},
    [PARAM_UINT] = {"a whole number ", ""},
    [PARAM_FLOAT] = {"a number ", ""},
    [PARAM_VEC3] = {"three numbers x,y,z ", ""},
    [PARAM_COLOR] = {"#rrggbb or r,g,b ", ""},
    [PARAM_BACKGROUND] = {"#rrggbb, r,g,b ", ", or transparent"},
    [PARAM_AUTO_INT] = {"auto or a whole number ", ""},
    [PARAM_AUTO_FLOAT] = {"auto or a number ", ""},
    [PARAM_AUTO_VEC3] = {"auto or three numbers x,y,z ", ""},
    [PARAM_UNIT] = {"auto, m, cm, mm, in or a number ", ""},
    [PARAM_SIZE] = {"WxH, each ", ""},
    [PARAM_PART] = {"I/N, each ", " and I at most N"},
    [PARAM_TEXT] = {"a name", NULL},
    [PARAM_PATH] = {"a path", NULL},
};

void params_describe(const ParamInfo *info, char *text, size_t size)
{
    if (info->kind == PARAM_CHOICE) {
        describe_choices(info, text, size);
        return;
    }
    const char *const *form = FORMS[info->kind];
    const char *open = info->unit[0] ? " (" : "", *close = info->unit[0] ? ")" : "";
    if (!form[1])
        snprintf(text, size, "%s", form[0]);
    else
        snprintf(text, size, "%sfrom %.10g to %.10g%s%s%s%s", form[0], info->minimum, info->maximum,
                 open, info->unit, close, form[1]);
}
