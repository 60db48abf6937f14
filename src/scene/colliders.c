// SPDX-License-Identifier: MIT
#include "scene/colliders.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char *word, *form;
    uint32_t count;
} KINDS[COLLIDER_KINDS] = {
    [COLLIDER_SPHERE] = {"sphere", "sphere:x,y,z,radius", 4},
    [COLLIDER_CAPSULE] = {"capsule", "capsule:x,y,z,radius,x,y,z,radius", 8},
    [COLLIDER_GROUND] = {"ground", "ground:height", 1},
    [COLLIDER_PLANE] = {"plane", "plane:x,y,z,height", 4},
};

static const float FARTHEST = 1e6f;

const char *collider_word(ColliderKind kind)
{
    return KINDS[kind].word;
}

uint32_t collider_numbers(ColliderKind kind)
{
    return KINDS[kind].count;
}

static bool is_flat(ColliderKind kind)
{
    return kind == COLLIDER_GROUND || kind == COLLIDER_PLANE;
}

static Result check_collider(const Collider *collider, Error *error)
{
    const char *word = KINDS[collider->kind].word;
    for (uint32_t i = 0; i < KINDS[collider->kind].count; ++i)
        if (!(fabsf(collider->numbers[i]) <= FARTHEST))
            return error_set(error, RESULT_USAGE, "%s: got %g, expected numbers of at most %g",
                             word, (double)collider->numbers[i], (double)FARTHEST);
    for (uint32_t i = 3; i < KINDS[collider->kind].count && !is_flat(collider->kind); i += 4)
        if (collider->numbers[i] < 0)
            return error_set(error, RESULT_USAGE, "%s: got the radius %g, expected 0 or more", word,
                             (double)collider->numbers[i]);
    return RESULT_OK;
}

static Result normalise_plane(Collider *plane, Error *error)
{
    double x = (double)plane->numbers[0], y = (double)plane->numbers[1];
    double z = (double)plane->numbers[2], length = sqrt(x * x + y * y + z * z);
    if (!(length > 0)) return error_set(error, RESULT_USAGE, "plane: expected a direction");
    for (int k = 0; k < 3; ++k) plane->numbers[k] = (float)((double)plane->numbers[k] / length);
    return RESULT_OK;
}

Result colliders_add(Colliders *colliders, const Collider *collider, Error *error)
{
    Collider added = *collider;
    Result result = check_collider(&added, error);
    if (result == RESULT_OK && added.kind == COLLIDER_PLANE)
        result = normalise_plane(&added, error);
    if (result != RESULT_OK) return result;
    if (is_flat(added.kind)) added.world = true;
    Collider *list = realloc(colliders->list, (colliders->count + (size_t)1) * sizeof *list);
    if (!list) return error_set(error, RESULT_FAILED, "out of memory");
    list[colliders->count++] = added;
    colliders->list = list;
    return RESULT_OK;
}

void colliders_destroy(Colliders *colliders)
{
    free(colliders->list);
    *colliders = (Colliders){0};
}

// --- Text.

static const char *skip_blanks(const char *text)
{
    return text + strspn(text, " \t\r\n");
}

static Result refuse(const char *text, const char *expected, Error *error)
{
    int length = (int)strcspn(text, ";");
    return error_set(error, RESULT_USAGE, "got '%.*s', expected %s", length < 60 ? length : 60,
                     text, expected);
}

// Takes `word` and the ':' behind it from the text if they stand there.
static bool take_word(const char **text, const char *word)
{
    size_t length = strlen(word);
    if (strncmp(*text, word, length) != 0) return false;
    const char *behind = skip_blanks(*text + length);
    if (*behind != ':') return false;
    *text = skip_blanks(behind + 1);
    return true;
}

static Result take_kind(const char **text, ColliderKind *kind, Error *error)
{
    for (*kind = 0; *kind < COLLIDER_KINDS; ++*kind)
        if (take_word(text, KINDS[*kind].word)) return RESULT_OK;
    return refuse(*text, "sphere:, capsule:, ground: or plane: and its numbers", error);
}

// Exactly `count` decimal numbers with commas between them; false if it is anything else.
static bool take_numbers(const char **text, float *numbers, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i) {
        if (i > 0 && *(*text)++ != ',') return false;
        *text = skip_blanks(*text);
        size_t length = strspn(*text, "0123456789+-.eE");
        char *end;
        numbers[i] = (float)strtod(*text, &end);
        if (end == *text || end > *text + length) return false;
        *text = skip_blanks(end);
    }
    return true;
}

static Result take_collider(const char **text, Collider *collider, Error *error)
{
    *collider = (Collider){.world = take_word(text, "world")};
    const char *beginning = *text;
    Result result = take_kind(text, &collider->kind, error);
    if (result != RESULT_OK) return result;
    bool good = take_numbers(text, collider->numbers, KINDS[collider->kind].count);
    return good && (**text == ';' || !**text)
               ? RESULT_OK
               : refuse(beginning, KINDS[collider->kind].form, error);
}

Result colliders_parse(Colliders *colliders, const char *text, Error *error)
{
    text = skip_blanks(text);
    while (*text) {
        Collider collider;
        Result result = take_collider(&text, &collider, error);
        if (result == RESULT_OK) result = colliders_add(colliders, &collider, error);
        if (result != RESULT_OK) return result;
        text = skip_blanks(text + (*text == ';'));
    }
    return RESULT_OK;
}
