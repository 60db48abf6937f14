// SPDX-License-Identifier: MIT
#include "scene/scene_colliders.h"
#include "scene/scene_param.h"

#include <string.h>

static const double NUMBER_MAX = 1e6;
static const char *const FRAME_WORDS[] = {"head", "world", NULL};

// The one of the object's keys that is a shape; COLLIDER_KINDS if there is none or there are two.
static ColliderKind find_kind(const json_t *value)
{
    ColliderKind found = COLLIDER_KINDS;
    int count = 0;
    for (ColliderKind kind = 0; kind < COLLIDER_KINDS; ++kind)
        if (json_object_get(value, collider_word(kind))) found = kind, ++count;
    return count == 1 ? found : COLLIDER_KINDS;
}

static Result read_frame(Collider *collider, const JsonPlace *parent, const json_t *object,
                         Error *error)
{
    const json_t *value = json_object_get(object, "frame");
    if (!value) return RESULT_OK;
    JsonPlace place = {.parent = parent, .key = "frame"};
    int index = 0;
    if (collider->kind == COLLIDER_GROUND || collider->kind == COLLIDER_PLANE)
        return json_fail(&place, error, "a %s always stands in the world",
                         collider_word(collider->kind));
    Result result = json_read_choice(&place, value, FRAME_WORDS, &index, error);
    collider->world = index == 1;
    return result;
}

static Result read_collider(Scene *scene, const JsonPlace *place, const json_t *value, Error *error)
{
    const char *names[COLLIDER_KINDS + 2] = {0};
    for (ColliderKind kind = 0; kind < COLLIDER_KINDS; ++kind) names[kind] = collider_word(kind);
    names[COLLIDER_KINDS] = "frame";
    Result result = json_check_object(place, value, names, error);
    if (result != RESULT_OK) return result;
    Collider collider = {.kind = find_kind(value)};
    if (collider.kind == COLLIDER_KINDS)
        return json_fail(place, error, "expected one key of sphere, capsule, ground and plane");
    const char *word = collider_word(collider.kind);
    JsonPlace numbers = {.parent = place, .key = word};
    const json_t *at = json_object_get(value, word);
    uint32_t count = collider_numbers(collider.kind);
    char expected[48];
    snprintf(expected, sizeof expected, "an array of %u numbers", count);
    double number = 0;
    result = count == 1 ? json_read_number(&numbers, at, -NUMBER_MAX, NUMBER_MAX, "a height",
                                           &number, error)
                        : json_read_vector(&numbers, at, count, -NUMBER_MAX, NUMBER_MAX, expected,
                                           collider.numbers, error);
    if (count == 1) collider.numbers[0] = (float)number;
    if (result == RESULT_OK) result = read_frame(&collider, place, value, error);
    if (result != RESULT_OK) return result;
    Error why = {{0}};
    result = colliders_add(&scene->colliders, &collider, &why);
    if (result == RESULT_OK) return result;
    return result == RESULT_USAGE ? json_fail(place, error, "%s", why.text)
                                  : error_set(error, result, "%s", why.text);
}

Result scene_read_colliders(Scene *scene, const JsonPlace *place, const json_t *value, Error *error)
{
    if (json_is_string(value)) {
        Error why = {{0}};
        Result result = colliders_parse(&scene->colliders, json_string_value(value), &why);
        if (result == RESULT_USAGE) return json_fail(place, error, "%s", why.text);
        return result == RESULT_OK ? result : error_set(error, result, "%s", why.text);
    }
    if (!json_is_array(value)) return json_refuse(place, value, "an array of shapes", error);
    Result result = RESULT_OK;
    for (size_t i = 0; i < json_array_size(value) && result == RESULT_OK; ++i) {
        JsonPlace element = {.parent = place, .index = i};
        result = read_collider(scene, &element, json_array_get(value, i), error);
    }
    return result;
}

static json_t *write_collider(const Collider *collider)
{
    json_t *object = json_object();
    uint32_t count = collider_numbers(collider->kind);
    json_t *numbers = count == 1 ? scene_write_float(collider->numbers[0])
                                 : scene_write_floats(collider->numbers, count);
    bool flat = collider->kind == COLLIDER_GROUND || collider->kind == COLLIDER_PLANE;
    bool good = json_object_set_new(object, collider_word(collider->kind), numbers) == 0;
    if (!flat)
        good =
            json_object_set_new(object, "frame", json_string(FRAME_WORDS[collider->world])) == 0 &&
            good;
    if (good) return object;
    json_decref(object);
    return NULL;
}

json_t *scene_write_colliders(const Colliders *colliders)
{
    json_t *array = json_array();
    bool good = array != NULL;
    for (uint32_t i = 0; i < colliders->count; ++i)
        good = json_array_append_new(array, write_collider(&colliders->list[i])) == 0 && good;
    if (good) return array;
    json_decref(array);
    return NULL;
}
