// SPDX-License-Identifier: MIT
#include "scene/colliders.h"
#include "scene/scene_param.h"

#include <cglm/cglm.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FRAME_any, FRAME_world };

static const struct {
    const char *name, *numbers; // "sphere", "x,y,z,radius"
    bool world;                 // always fixed to the world
} TABLE[COLLIDER_KINDS] = {
#define ROW(kind, name, numbers, frame) {#name, COLLIDER_STRING numbers, FRAME_##frame},
    COLLIDERS(ROW, ROW)
#undef ROW
};

static const char *const FRAME_WORDS[] = {"head", "world", NULL};
static const float FARTHEST = (float)COLLIDERS_FARTHEST;

// The name of number `i` of a kind and of those that follow; NULL if there is no such number.
static const char *number_name(ColliderKind kind, uint32_t i)
{
    const char *at = TABLE[kind].numbers;
    while (at && i--) at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL;
    return at;
}

static uint32_t count_numbers(ColliderKind kind)
{
    uint32_t count = 0;
    while (number_name(kind, count)) ++count;
    return count;
}

static bool is_named(ColliderKind kind, uint32_t i, const char *name)
{
    return strncmp(number_name(kind, i), name, strlen(name)) == 0;
}

Result colliders_add(Colliders *colliders, const Collider *collider, Error *error)
{
    Collider added = *collider;
    const char *name = TABLE[added.kind].name;
    added.world = added.world || TABLE[added.kind].world;
    for (uint32_t i = 0; i < count_numbers(added.kind); ++i) {
        float *number = &added.numbers[i];
        if (!(fabsf(*number) <= FARTHEST))
            return error_set(error, RESULT_USAGE,
                             "%s: got %.6g, expected numbers from %.10g to %.10g", name,
                             (double)*number, -(double)FARTHEST, (double)FARTHEST);
        if (is_named(added.kind, i, "radius") && *number < 0)
            return error_set(error, RESULT_USAGE,
                             "%s: got the radius %.6g, expected a number from 0 to %.10g", name,
                             (double)*number, (double)FARTHEST);
        if (!is_named(added.kind, i, "nx")) continue;
        double x = (double)number[0], y = (double)number[1], z = (double)number[2];
        double length = sqrt(x * x + y * y + z * z);
        if (!(length > 0))
            return error_set(error, RESULT_USAGE,
                             "%s: the direction is 0,0,0: expected another one", name);
        for (int k = 0; k < 3; ++k) number[k] = (float)((double)number[k] / length);
    }
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

static Result refuse(const char *text, Error *error, const char *form, const char *name)
{
    char expected[200];
    int length = (int)strcspn(text, ";");
    snprintf(expected, sizeof expected, form, name);
    return error_set(error, RESULT_USAGE, "got '%.*s', expected %s", length < 60 ? length : 60,
                     text, expected);
}

// Skips `word` and the ':' after it, if the text begins with them.
static bool take_word(const char **text, const char *word)
{
    size_t length = strlen(word);
    if (strncmp(*text, word, length) != 0) return false;
    const char *behind = skip_blanks(*text + length);
    if (*behind != ':') return false;
    *text = skip_blanks(behind + 1);
    return true;
}

// Reads exactly `count` decimal numbers separated by commas; false otherwise.
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
    while (!take_word(text, TABLE[collider->kind].name))
        if (++collider->kind == COLLIDER_KINDS)
            return refuse(beginning, error, "one of %s", &COLLIDER_FORMS[2]);
    bool good = take_numbers(text, collider->numbers, count_numbers(collider->kind));
    if (good && (**text == ';' || !**text)) return RESULT_OK;
    char form[80];
    snprintf(form, sizeof form, "%s:%s", TABLE[collider->kind].name, TABLE[collider->kind].numbers);
    return refuse(beginning, error, "%s", form);
}

Result colliders_parse(Colliders *colliders, const char *text, Error *error)
{
    text = skip_blanks(text);
    while (*text) {
        Collider collider;
        TRY(take_collider(&text, &collider, error));
        TRY(colliders_add(colliders, &collider, error));
        text = skip_blanks(text + (*text == ';'));
    }
    return RESULT_OK;
}

// --- JSON.

// Turns the error of a value into an error at its place.
static Result at_place(const JsonPlace *place, Result result, const Error *why, Error *error)
{
    if (result == RESULT_USAGE) return json_fail(place, error, "%s", why->text);
    return result == RESULT_OK ? result : error_set(error, result, "%s", why->text);
}

// Finds the only key of the object that names a shape.
static Result find_kind(ColliderKind *found, const JsonPlace *place, const json_t *value,
                        Error *error)
{
    const char *names[COLLIDER_KINDS + 2] = {0};
    char list[200] = "";
    int count = 0;
    for (ColliderKind kind = 0; kind < COLLIDER_KINDS; ++kind) {
        names[kind] = TABLE[kind].name;
        snprintf(list + strlen(list), sizeof list - strlen(list), "%s%s", kind ? ", " : "",
                 names[kind]);
        if (json_object_get(value, names[kind])) *found = kind, ++count;
    }
    names[COLLIDER_KINDS] = "frame";
    TRY(json_check_object(place, value, names, error));
    return count == 1 ? RESULT_OK : json_fail(place, error, "expected one key of %s", list);
}

static Result read_collider(Colliders *colliders, const JsonPlace *place, const json_t *value,
                            Error *error)
{
    Collider collider = {0};
    TRY(find_kind(&collider.kind, place, value, error));
    const char *name = TABLE[collider.kind].name;
    JsonPlace numbers = {.parent = place, .key = name}, frame = {.parent = place, .key = "frame"};
    const json_t *at = json_object_get(value, name), *word = json_object_get(value, "frame");
    uint32_t count = count_numbers(collider.kind);
    double number = 0;
    char expected[48];
    if (count == 1) {
        snprintf(expected, sizeof expected, "a %s", TABLE[collider.kind].numbers);
        TRY(json_read_number(&numbers, at, -(double)FARTHEST, (double)FARTHEST, expected, &number,
                             error));
        collider.numbers[0] = (float)number;
    } else {
        snprintf(expected, sizeof expected, "an array of %u numbers", count);
        TRY(json_read_vector(&numbers, at, count, -(double)FARTHEST, (double)FARTHEST, expected,
                             collider.numbers, error));
    }
    if (word && TABLE[collider.kind].world)
        return json_fail(&frame, error, "a %s cannot move with the head: expected no key 'frame'",
                         name);
    int index = 0;
    if (word) TRY(json_read_choice(&frame, word, FRAME_WORDS, &index, error));
    collider.world = index == 1;
    Error why = {{0}};
    return at_place(place, colliders_add(colliders, &collider, &why), &why, error);
}

Result colliders_from_json(Colliders *colliders, const JsonPlace *place, const json_t *value,
                           Error *error)
{
    Error why = {{0}};
    if (json_is_string(value))
        return at_place(place, colliders_parse(colliders, json_string_value(value), &why), &why,
                        error);
    if (!json_is_array(value)) return json_refuse(place, value, "an array of shapes", error);
    for (size_t i = 0; i < json_array_size(value); ++i) {
        JsonPlace element = {.parent = place, .index = i};
        TRY(read_collider(colliders, &element, json_array_get(value, i), error));
    }
    return RESULT_OK;
}

json_t *colliders_to_json(const Colliders *colliders)
{
    json_t *array = json_array();
    bool good = array != NULL;
    for (uint32_t i = 0; i < colliders->count; ++i) {
        const Collider *collider = &colliders->list[i];
        json_t *object = json_object();
        uint32_t count = count_numbers(collider->kind);
        json_t *numbers = count == 1 ? scene_param_write_float(collider->numbers[0])
                                     : scene_param_write_floats(collider->numbers, count);
        good = json_object_set_new(object, TABLE[collider->kind].name, numbers) == 0 && good;
        if (!TABLE[collider->kind].world)
            good = json_object_set_new(object, "frame",
                                       json_string(FRAME_WORDS[collider->world])) == 0 &&
                   good;
        good = json_array_append_new(array, object) == 0 && good;
    }
    if (good) return array;
    json_decref(array);
    return NULL;
}

// --- For the GPU.

enum { CONES = 0 COLLIDERS(COLLIDER_ONE, COLLIDER_NONE) };

static bool is_cone(ColliderKind kind)
{
    return (int)kind < CONES;
}

uint32_t colliders_group(ColliderKind kind)
{
    return is_cone(kind) ? 0 : 1 + kind - CONES;
}

// If one end sphere of a cone lies inside the other, the cone is that other sphere.
static void pack_cone(const Collider *collider, const float rotation[4], const float translation[3],
                      float texel[COLLIDER_TEXELS][4])
{
    const float *a = collider->numbers;
    const float *b = collider->kind == COLLIDER_CAPSULE ? a + 4 : a;
    vec3 axis;
    glm_vec3_sub((float *)b, (float *)a, axis);
    float length = glm_vec3_norm(axis), more = b[3] - a[3];
    if (length <= fabsf(more)) {
        if (more > 0) a = b;
        length = 0;
    }
    glm_quat_rotatev((float *)rotation, (float *)a, texel[0]);
    glm_vec3_add(texel[0], (float *)translation, texel[0]);
    texel[0][3] = a[3];
    if (!(length > 0)) return;
    glm_vec3_scale(axis, 1 / length, axis);
    glm_quat_rotatev((float *)rotation, axis, texel[1]);
    texel[1][3] = length;
    double grow = (double)more / (double)length;
    texel[2][0] = (float)grow;
    texel[2][1] = (float)(grow / sqrt(1 - grow * grow));
}

void colliders_pack(const Collider *collider, const float rotation[4], const float translation[3],
                    float texel[COLLIDER_TEXELS][4])
{
    memset(texel, 0, COLLIDER_TEXELS * sizeof *texel);
    if (is_cone(collider->kind)) {
        pack_cone(collider, rotation, translation, texel);
        return;
    }
    float *to = texel[0], *begin = to;
    const float *from = collider->numbers;
    if (is_named(collider->kind, 0, "height")) memcpy(to, (vec3){0, 1, 0}, sizeof(vec3)), to += 3;
    for (uint32_t i = 0; i < count_numbers(collider->kind);) {
        bool point = is_named(collider->kind, i, "x,y,z");
        if (!point && !is_named(collider->kind, i, "nx")) {
            *to++ = from[i++];
            continue;
        }
        while ((to - begin) % 4) ++to;
        memcpy(to, from + i, sizeof(vec3));
        if (!collider->world) {
            glm_quat_rotatev((float *)rotation, (float *)from + i, to);
            if (point) glm_vec3_add(to, (float *)translation, to);
        }
        to += 3, i += 3;
    }
}

bool colliders_reach(const Collider *collider, const float texel[COLLIDER_TEXELS][4],
                     const float centre[3], float radius)
{
    const float *first = texel[0], *axis = texel[1];
    if (is_cone(collider->kind)) {
        vec3 middle;
        glm_vec3_copy((float *)first, middle);
        glm_vec3_muladds((float *)axis, 0.5f * axis[3], middle);
        float largest = fmaxf(first[3], first[3] + texel[2][0] * axis[3]);
        return glm_vec3_distance(middle, (float *)centre) < radius + largest + 0.5f * axis[3];
    }
    if (!is_named(collider->kind, 0, "x,y,z"))
        return glm_vec3_dot((float *)first, (float *)centre) - first[3] < radius;
    for (uint32_t i = 3; i < count_numbers(collider->kind); ++i)
        radius += fabsf(collider->numbers[i]);
    return glm_vec3_distance((float *)first, (float *)centre) < radius;
}
