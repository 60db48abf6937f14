// SPDX-License-Identifier: MIT
#include "base/params.h"

#include "base/colors.h"
#include "base/decimal.h"
#include "base/rate.h"
#include "base/suggest.h"
#include "glsl/common/collider_table.h"

#include <assert.h>
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CHOICE_WORD(value, word) word,
#define ROW_STRUCT_RUN           RunParams
#define ROW_STRUCT_BODY          BodyParams
#define ROW_STRUCT_SECTION       SectionParams
#define PARAM(scope_, KIND, GROUP, owner_, field, letter_, default_, minimum_, maximum_, unit_,    \
              CHOICES, help_)                                                                      \
    {.name = #field,                                                                               \
     .scope = SCOPE_##scope_,                                                                      \
     .kind = PARAM_##KIND,                                                                         \
     .group = GROUP_##GROUP,                                                                       \
     .owner = owner_,                                                                              \
     .letter = letter_,                                                                            \
     .offset = offsetof(ROW_STRUCT_##scope_, field),                                               \
     .default_text = default_,                                                                     \
     .minimum = minimum_,                                                                          \
     .maximum = maximum_,                                                                          \
     .unit = unit_,                                                                                \
     .choices = (const char *const[]){CHOICES(CHOICE_WORD) NULL},                                  \
     .help = help_},
const ParamInfo PARAM_TABLE[] = {
#include "base/params.def"
};
#undef PARAM

const size_t PARAM_COUNT = sizeof PARAM_TABLE / sizeof PARAM_TABLE[0];

#define GROUP_TITLE(group, title) title,
const char *const GROUP_TITLES[GROUP_COUNT] = {PARAM_GROUPS(GROUP_TITLE)};

// --- The structs.

static bool owns_text(const ParamInfo *info, ParamScope scope)
{
    return info->scope == scope && (info->kind == PARAM_TEXT || info->kind == PARAM_PATH);
}

static char **text_field(const ParamInfo *info, void *params)
{
    return (char **)(void *)((char *)params + info->offset);
}

static Result set_defaults(ParamScope scope, void *params, Error *error)
{
    for (size_t i = 0; i < PARAM_COUNT; i++) {
        if (PARAM_TABLE[i].scope != scope) continue;
        Result result = params_parse(&PARAM_TABLE[i], params, PARAM_TABLE[i].default_text, error);
        assert(result != RESULT_USAGE);
        if (result != RESULT_OK) return result;
    }
    return RESULT_OK;
}

static void free_texts(ParamScope scope, void *params)
{
    for (size_t i = 0; i < PARAM_COUNT; i++)
        if (owns_text(&PARAM_TABLE[i], scope)) free(*text_field(&PARAM_TABLE[i], params));
}

Result params_create_run(RunParams *params, Error *error)
{
    *params = (RunParams){0};
    return set_defaults(SCOPE_RUN, params, error);
}

Result params_create_body(BodyParams *params, Error *error)
{
    *params = (BodyParams){0};
    return set_defaults(SCOPE_BODY, params, error);
}

Result params_create_section(SectionParams *params, Error *error)
{
    *params = (SectionParams){0};
    return set_defaults(SCOPE_SECTION, params, error);
}

void params_destroy_run(RunParams *params)
{
    free_texts(SCOPE_RUN, params);
    *params = (RunParams){0};
}

void params_destroy_body(BodyParams *params)
{
    free_texts(SCOPE_BODY, params);
    *params = (BodyParams){0};
}

void params_destroy_section(SectionParams *params)
{
    free_texts(SCOPE_SECTION, params);
    *params = (SectionParams){0};
}

// Replaces the texts of `params`, which is a copy of another struct, by copies of its own.
static Result own_texts(ParamScope scope, void *params, Error *error)
{
    bool copied = true;
    for (size_t i = 0; i < PARAM_COUNT; i++) {
        if (!owns_text(&PARAM_TABLE[i], scope)) continue;
        char **text = text_field(&PARAM_TABLE[i], params);
        // After one failure set the remaining copies to NULL, so that no text is shared.
        *text = copied ? strdup(*text) : NULL;
        copied = *text != NULL;
    }
    if (copied) return RESULT_OK;
    free_texts(scope, params);
    return error_set(error, RESULT_FAILED, "out of memory");
}

Result params_copy_body(BodyParams *to, const BodyParams *from, Error *error)
{
    *to = *from;
    Result result = own_texts(SCOPE_BODY, to, error);
    if (result != RESULT_OK) *to = (BodyParams){0};
    return result;
}

Result params_copy_section(SectionParams *to, const SectionParams *from, Error *error)
{
    *to = *from;
    Result result = own_texts(SCOPE_SECTION, to, error);
    if (result != RESULT_OK) *to = (SectionParams){0};
    return result;
}

// --- Finding parameters.

static bool names_equal(const char *a, const char *b)
{
    for (; *a && *b; a++, b++) {
        if ((*a == '-' ? '_' : *a) != (*b == '-' ? '_' : *b)) return false;
    }
    return *a == *b;
}

const char *params_also(const ParamInfo *info)
{
    return strcmp(info->name, "color") == 0 ? "albedo" : NULL;
}

const ParamInfo *params_find(const char *name)
{
    for (size_t i = 0; i < PARAM_COUNT; i++)
        if (names_equal(PARAM_TABLE[i].name, name)) return &PARAM_TABLE[i];
    for (size_t i = 0; i < PARAM_COUNT; i++) {
        const char *also = params_also(&PARAM_TABLE[i]);
        if (also && names_equal(also, name)) return &PARAM_TABLE[i];
    }
    return NULL;
}

bool params_owned_by(const ParamInfo *info, const char *solver)
{
    size_t length = strlen(solver);
    if (!*info->owner) return true;
    for (const char *at = info->owner; *at; at += strcspn(at, " "), at += *at == ' ')
        if (strncmp(at, solver, length) == 0 && (!at[length] || at[length] == ' ')) return true;
    return false;
}

// --- Values from and to text.

const LengthUnit LENGTH_UNITS[LENGTH_UNIT_COUNT] = {
    {"m", 1.0f}, {"cm", 0.01f}, {"mm", 0.001f}, {"in", 0.0254f}};

// The text form of each kind: `count` numbers of a type, separated by `separator`, or a form of its
// own. The description of the kind is `before`, the range, `behind`; `behind` is NULL if there is
// no range.
typedef enum NumberType { NO_NUMBER, NUMBER_INT, NUMBER_UINT, NUMBER_FLOAT } NumberType;
static const struct Form {
    const char *before, *behind;
    NumberType type;
    int count;
    char separator;
    bool automatic; // "auto" is allowed, too
} FORMS[] = {
    [PARAM_BOOL] = {"true or false", NULL, NO_NUMBER, 0, 0, false},
    [PARAM_INT] = {"a whole number ", "", NUMBER_INT, 1, 0, false},
    [PARAM_UINT] = {"a whole number ", "", NUMBER_UINT, 1, 0, false},
    [PARAM_FLOAT] = {"a number ", "", NUMBER_FLOAT, 1, 0, false},
    [PARAM_PROFILE] = {"a number ", ", or two such numbers, ROOT:TIP", NUMBER_FLOAT, 1, 0, false},
    [PARAM_RATE] = {"a number ", ", or a fraction, 24000/1001", NO_NUMBER, 0, 0, false},
    [PARAM_TURN] = {"a number ", "", NUMBER_FLOAT, 1, 0, false},
    [PARAM_VEC3] = {"three numbers x,y,z ", "", NUMBER_FLOAT, 3, ',', false},
    [PARAM_COLOR] = {"a name (--help colors), #rrggbb or r,g,b ", "", NUMBER_FLOAT, 3, ',', false},
    [PARAM_BACKGROUND] = {"a name (--help colors), #rrggbb, r,g,b ", ", or transparent",
                          NUMBER_FLOAT, 3, ',', false},
    [PARAM_AUTO_INT] = {"auto or a whole number ", "", NUMBER_INT, 1, 0, true},
    [PARAM_AUTO_FLOAT] = {"auto or a number ", "", NUMBER_FLOAT, 1, 0, true},
    [PARAM_AUTO_VEC3] = {"auto or three numbers x,y,z ", "", NUMBER_FLOAT, 3, ',', true},
    [PARAM_AUTO_COLOR] = {"auto, a name (--help colors), #rrggbb or r,g,b ", "", NUMBER_FLOAT, 3,
                          ',', false},
    [PARAM_UNIT] = {"auto, m, cm, mm, in or a number ", "", NUMBER_FLOAT, 1, 0, true},
    [PARAM_SIZE] = {"WxH, each ", "", NUMBER_INT, 2, 'x', false},
    [PARAM_PART] = {"I/N, each ", " and I at most N", NUMBER_INT, 2, '/', false},
    [PARAM_TEXT] = {"a name", NULL, NO_NUMBER, 0, 0, false},
    [PARAM_PATH] = {"a path", NULL, NO_NUMBER, 0, 0, false},
};

// Offset of the numbers within a field that also has a flag `automatic`.
enum { AUTO_OFFSET = offsetof(AutoFloat, value) };
_Static_assert(offsetof(AutoInt, value) == AUTO_OFFSET && offsetof(AutoVec3, value) == AUTO_OFFSET,
               "all Auto structs begin alike");
_Static_assert(offsetof(SectionParams, style_along) - offsetof(SectionParams, style) ==
                   offsetof(ProfileNumber, along),
               "the two fields of a profile lie as a ProfileNumber");

// A value being parsed: its parameter, and the user's text for the message.
typedef struct Input {
    const ParamInfo *info;
    const char *text;
    Error *error;
} Input;

// The words that a value of this kind may be: choices, "auto", units, names of colours.
enum { WORDS_MOST = COLOR_NAME_COUNT + LENGTH_UNIT_COUNT + 2 };
static size_t list_words(const ParamInfo *info, const char *words[WORDS_MOST])
{
    ParamKind kind = info->kind;
    size_t count = 0;
    for (; info->choices[count]; count++) {
        assert(count < WORDS_MOST);
        words[count] = info->choices[count];
    }
    if (FORMS[kind].automatic || kind == PARAM_AUTO_COLOR) words[count++] = "auto";
    if (kind == PARAM_BACKGROUND) words[count++] = "transparent";
    if (kind == PARAM_BOOL) words[count++] = "true", words[count++] = "false";
    if (kind == PARAM_UNIT)
        for (int i = 0; i < LENGTH_UNIT_COUNT; i++) words[count++] = LENGTH_UNITS[i].word;
    if (kind == PARAM_COLOR || kind == PARAM_BACKGROUND || kind == PARAM_AUTO_COLOR)
        for (int i = 0; i < COLOR_NAME_COUNT; i++) words[count++] = COLOR_NAMES[i].name;
    return count;
}

// `nearest`: the nearest permitted number; NULL: the nearest permitted word, if one is near.
static Result refuse(const Input *input, const char *nearest)
{
    const char *words[WORDS_MOST];
    if (!nearest) nearest = suggest_nearest(input->text, words, list_words(input->info, words));
    char expected[200];
    params_describe(input->info, expected, sizeof expected);
    char got[64];
    snprintf(got, sizeof got, "%s", input->text);
    const char *dots = strlen(input->text) >= sizeof got ? "..." : "";
    if (!nearest)
        return error_set(input->error, RESULT_USAGE, "got '%s%s', expected %s", got, dots,
                         expected);
    return error_set(input->error, RESULT_USAGE, "got '%s%s', expected %s (nearest: %s)", got, dots,
                     expected, nearest);
}

// Integers also go through double, which represents every integer in any range.
static Result read_numbers(const Input *input, const struct Form *form, double *numbers)
{
    const ParamInfo *info = input->info;
    const char *at = input->text;
    if (form->type != NUMBER_FLOAT && strpbrk(at, ".eE")) return refuse(input, NULL);
    for (int i = 0; i < form->count; i++) {
        if (i > 0 && *at++ != form->separator) return refuse(input, NULL);
        at = decimal_read(at, &numbers[i]);
        if (!at) return refuse(input, NULL);
    }
    if (*at) return refuse(input, NULL);
    for (int i = 0; i < form->count; i++) {
        double inside = fmin(fmax(numbers[i], info->minimum), info->maximum);
        if (numbers[i] == inside) continue;
        char nearest[32];
        snprintf(nearest, sizeof nearest, "%.10g", inside);
        return refuse(input, nearest);
    }
    if (info->kind == PARAM_PART && numbers[0] > numbers[1]) return refuse(input, NULL);
    return RESULT_OK;
}

static Result parse_numbers(const Input *input, void *field)
{
    const struct Form *form = &FORMS[input->info->kind];
    double numbers[3] = {0};
    bool automatic = form->automatic && strcmp(input->text, "auto") == 0;
    if (!automatic) TRY(read_numbers(input, form, numbers));
    if (form->automatic) *(bool *)field = automatic;
    char *at = (char *)field + (form->automatic ? AUTO_OFFSET : 0);
    for (int i = 0; i < form->count; i++, at += 4) {
        if (form->type == NUMBER_INT) *(int *)(void *)at = (int)numbers[i];
        if (form->type == NUMBER_UINT) *(uint32_t *)(void *)at = (uint32_t)numbers[i];
        if (form->type == NUMBER_FLOAT) *(float *)(void *)at = (float)numbers[i];
    }
    return RESULT_OK;
}

static Result parse_color(const Input *input, float value[3])
{
    const char *text = input->text;
    if (isalpha((unsigned char)text[0])) {
        bool seen = input->info->group == GROUP_HAIR && input->info->kind == PARAM_COLOR;
        text = colors_find(text, seen);
        if (!text) return refuse(input, NULL);
    }
    if (text[0] != '#') return parse_numbers(input, value);
    const char *digits = text + 1;
    if (strlen(digits) != 6 || strspn(digits, "0123456789abcdefABCDEF") != 6)
        return refuse(input, NULL);
    unsigned long rgb = strtoul(digits, NULL, 16);
    for (int i = 0; i < 3; i++) value[i] = (float)(rgb >> (16 - 8 * i) & 255) / 255.0f;
    return RESULT_OK;
}

// Removed words of choices and their replacements.
static const struct {
    const char *name, *word, *instead;
} REPLACED[] = {{"scatter", "dual", "grid"}};

static Result parse_choice(const Input *input, int *value)
{
    const char *const *choices = input->info->choices;
    for (int i = 0; choices[i]; i++) {
        if (strcmp(input->text, choices[i]) != 0) continue;
        *value = i;
        return RESULT_OK;
    }
    for (size_t i = 0; i < sizeof REPLACED / sizeof *REPLACED; i++)
        if (strcmp(input->info->name, REPLACED[i].name) == 0 &&
            strcmp(input->text, REPLACED[i].word) == 0)
            return error_set(input->error, RESULT_USAGE, "'%s' was removed: use '%s' instead",
                             input->text, REPLACED[i].instead);
    return refuse(input, NULL);
}

static Result parse_rate(const Input *input, double *rate)
{
    double number;
    if (!rate_parse(input->text, &number)) return refuse(input, NULL);
    double inside = fmin(fmax(number, input->info->minimum), input->info->maximum);
    char nearest[32];
    snprintf(nearest, sizeof nearest, "%.10g", inside);
    if (number != inside) return refuse(input, nearest);
    *rate = number;
    return RESULT_OK;
}

static Result parse_profile(const Input *input, ProfileNumber *number)
{
    const ParamInfo *info = input->info;
    // The error message for a plain number suggests the nearest permitted number.
    if (!strpbrk(input->text, ":@")) {
        TRY(parse_numbers(input, &number->mean));
        number->along = (Profile){0};
        return RESULT_OK;
    }
    return profile_parse(number, input->text, info->minimum, info->maximum) ? RESULT_OK
                                                                            : refuse(input, NULL);
}

Result params_parse(const ParamInfo *info, void *params, const char *text, Error *error)
{
    void *field = (char *)params + info->offset;
    float *floats = field;
    Input input = {info, text, error};
    switch (info->kind) {
    case PARAM_BOOL:
        if (strcmp(text, "true") != 0 && strcmp(text, "false") != 0) return refuse(&input, NULL);
        *(bool *)field = *text == 't';
        return RESULT_OK;
    case PARAM_COLOR:
        return parse_color(&input, floats);
    case PARAM_AUTO_COLOR: {
        AutoVec3 color = {.automatic = strcmp(text, "auto") == 0};
        if (!color.automatic) TRY(parse_color(&input, color.value));
        *(AutoVec3 *)field = color;
        return RESULT_OK;
    }
    case PARAM_BACKGROUND:
        if (strcmp(text, "transparent") == 0) {
            memset(floats, 0, 4 * sizeof *floats);
            return RESULT_OK;
        }
        TRY(parse_color(&input, floats));
        floats[3] = 1.0f;
        return RESULT_OK;
    case PARAM_UNIT:
        for (int i = 0; i < LENGTH_UNIT_COUNT; i++) {
            if (strcmp(text, LENGTH_UNITS[i].word) != 0) continue;
            *(AutoFloat *)field = (AutoFloat){.value = LENGTH_UNITS[i].metres};
            return RESULT_OK;
        }
        return parse_numbers(&input, field);
    case PARAM_CHOICE:
        return parse_choice(&input, field);
    case PARAM_TEXT:
    case PARAM_PATH: {
        char *copy = strdup(text);
        if (!copy) return error_set(error, RESULT_FAILED, "out of memory");
        free(*(char **)field);
        *(char **)field = copy;
        return RESULT_OK;
    }
    case PARAM_PROFILE:
        return parse_profile(&input, field);
    case PARAM_RATE:
        return parse_rate(&input, field);
    case PARAM_TURN:
        if (!*text) input.text = "360";
        return parse_numbers(&input, field);
    default:
        return parse_numbers(&input, field);
    }
}

static char *format_numbers(const struct Form *form, const void *field)
{
    char text[3 * 24] = "";
    if (form->automatic && *(const bool *)field) return strdup("auto");
    const char *at = (const char *)field + (form->automatic ? AUTO_OFFSET : 0);
    for (int i = 0; i < form->count; i++, at += 4) {
        size_t length = strlen(text);
        if (i > 0) text[length++] = form->separator;
        if (form->type == NUMBER_FLOAT)
            decimal_format(*(const float *)(const void *)at, text + length, sizeof text - length);
        else
            snprintf(text + length, sizeof text - length, "%lld",
                     form->type == NUMBER_INT ? (long long)*(const int *)(const void *)at
                                              : (long long)*(const uint32_t *)(const void *)at);
    }
    return strdup(text);
}

static char *format_color(const struct Form *form, const float value[3])
{
    unsigned level[3];
    for (int i = 0; i < 3; i++) {
        level[i] = (unsigned)lroundf(value[i] * 255.0f);
        if ((float)level[i] / 255.0f != value[i]) return format_numbers(form, value);
    }
    char *text = NULL;
    return asprintf(&text, "#%02x%02x%02x", level[0], level[1], level[2]) < 0 ? NULL : text;
}

char *params_format(const ParamInfo *info, const void *params)
{
    const void *field = (const char *)params + info->offset;
    const struct Form *form = &FORMS[info->kind];
    const float *floats = field;
    char profile[400];
    switch (info->kind) {
    case PARAM_BOOL:
        return strdup(*(const bool *)field ? "true" : "false");
    case PARAM_COLOR:
        return format_color(form, floats);
    case PARAM_AUTO_COLOR:
        return *(const bool *)field ? strdup("auto")
                                    : format_color(form, ((const AutoVec3 *)field)->value);
    case PARAM_BACKGROUND:
        return floats[3] == 0 ? strdup("transparent") : format_color(form, floats);
    case PARAM_UNIT:
        for (int i = 0; i < LENGTH_UNIT_COUNT; i++)
            if (((const AutoFloat *)field)->value == LENGTH_UNITS[i].metres)
                return strdup(LENGTH_UNITS[i].word);
        return format_numbers(form, field);
    case PARAM_RATE:
        rate_format(*(const double *)field, profile, sizeof profile);
        return strdup(profile);
    case PARAM_PROFILE:
        profile_format(field, profile, sizeof profile);
        return strdup(profile);
    case PARAM_CHOICE:
        return strdup(info->choices[*(const int *)field]);
    case PARAM_TEXT:
    case PARAM_PATH:
        return strdup(*(char *const *)field);
    default:
        return format_numbers(form, field);
    }
}

void params_describe(const ParamInfo *info, char *text, size_t size)
{
    const struct Form *form = &FORMS[info->kind];
    const char *open = info->unit[0] ? " (" : "", *close = info->unit[0] ? ")" : "";
    size_t length = 0;
    for (int i = 0; info->choices[i] && length < size; i++) {
        const char *between = i == 0 ? "" : info->choices[i + 1] ? ", " : " or ";
        length += (size_t)snprintf(text + length, size - length, "%s%s", between, info->choices[i]);
    }
    if (info->kind == PARAM_CHOICE) return;
    if (!form->behind)
        snprintf(text, size, "%s", form->before);
    else
        snprintf(text, size, "%sfrom %.10g to %.10g%s%s%s%s", form->before, info->minimum,
                 info->maximum, open, info->unit, close, form->behind);
}
