// SPDX-License-Identifier: MIT
// jansson's functions accept NULL for a value and then fail. So a failed allocation needs to be
// checked only where a value is put into its parent: json_pack returns NULL, put() clears its flag.
#include "scene/scene_schema.h"

#include "base/colors.h"
#include "scene/scene_param.h"
#include "scene/scene_tracks.h"

#include "glsl/common/collider_table.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

// Patterns of a flag's value: numbers as text, with optional blanks.
#define BLANKS      "[ \\t]*"
#define WHOLE_TEXT  BLANKS "[+-]?[0-9]+" BLANKS
#define NUMBER_TEXT BLANKS "[+-]?([0-9]+\\.?[0-9]*|\\.[0-9]+)([eE][+-]?[0-9]+)?" BLANKS
#define THREE_TEXT  NUMBER_TEXT "," NUMBER_TEXT "," NUMBER_TEXT
#define PLACE(name) "#/definitions/" name

enum { TEXT_SIZE = 1200, PATTERN_SIZE = 4000 };

// Puts `value` under `key` and takes over its reference. Clears *good if either is NULL.
static void put(json_t *object, const char *key, json_t *value, bool *good)
{
    *good = json_object_set_new(object, key, value) == 0 && *good;
}

static void append(json_t *array, json_t *value, bool *good)
{
    *good = json_array_append_new(array, value) == 0 && *good;
}

// Returns `json` if all went well, otherwise frees it.
static json_t *finish(json_t *json, bool good)
{
    if (json && good) return json;
    json_decref(json);
    return NULL;
}

static json_t *reference(const char *name)
{
    return json_pack("{s:s+}", "$ref", PLACE(""), name);
}

static json_t *words(const char *const *list)
{
    json_t *array = json_array();
    bool good = array;
    for (; *list; ++list) append(array, json_string(*list), &good);
    return json_pack("{s:o}", "enum", finish(array, good));
}

static json_t *pattern(const char *text)
{
    return json_pack("{s:s, s:s++}", "type", "string", "pattern", "^", text, "$");
}

static json_t *real(double minimum, double maximum)
{
    return json_pack("{s:s, s:f, s:f}", "type", "number", "minimum", minimum, "maximum", maximum);
}

static json_t *whole(double minimum, double maximum)
{
    return json_pack("{s:s, s:I, s:I}", "type", "integer", "minimum", (json_int_t)minimum,
                     "maximum", (json_int_t)maximum);
}

// The schema of an array of exactly `count` values like `item`.
static json_t *vector(json_t *item, int count)
{
    return json_pack("{s:s, s:o, s:i, s:i}", "type", "array", "items", item, "minItems", count,
                     "maxItems", count);
}

// The schema of a value that matches one of two or three schemas.
static json_t *either(json_t *a, json_t *b)
{
    return json_pack("{s:[o, o]}", "anyOf", a, b);
}

static json_t *either_of_three(json_t *a, json_t *b, json_t *c)
{
    return json_pack("{s:[o, o, o]}", "anyOf", a, b, c);
}

static json_t *automatic(void)
{
    return json_pack("{s:s}", "const", "auto");
}

// --- Parameters.

// "([Rr][Ee][Dd]|...)": the names of colors, case-insensitive.
static json_t *color_text(void)
{
    char text[PATTERN_SIZE] = "(#[0-9a-fA-F]{6}|" THREE_TEXT;
    size_t length = strlen(text);
    for (size_t i = 0; i < COLOR_NAME_COUNT; ++i) {
        text[length++] = '|';
        for (const char *at = COLOR_NAMES[i].name; *at && length + 8 < sizeof text; ++at)
            length += (size_t)snprintf(text + length, sizeof text - length,
                                       isalpha((unsigned char)*at) ? "[%c%c]" : "%c",
                                       isalpha((unsigned char)*at) ? toupper(*at) : *at, *at);
    }
    snprintf(text + length, sizeof text - length, ")");
    return pattern(text);
}

static json_t *color_names(void)
{
    const char *names[COLOR_NAME_COUNT + 1] = {NULL};
    for (size_t i = 0; i < COLOR_NAME_COUNT; ++i) names[i] = COLOR_NAMES[i].name;
    return words(names);
}

// The names come first, because editors offer the first alternative.
static json_t *color(void)
{
    return json_pack("{s:[o, o, o]}", "anyOf", color_names(), color_text(), vector(real(0, 1), 3));
}

// The schema of points along the strand, [place, number].
static json_t *points(double minimum, double maximum)
{
    json_t *point = json_pack("{s:s, s:[o, o], s:b, s:i}", "type", "array", "items", real(0, 1),
                              real(minimum, maximum), "additionalItems", 0, "minItems", 2);
    return json_pack("{s:s, s:o, s:i, s:i}", "type", "array", "items", point, "minItems", 2,
                     "maxItems", PROFILE_MOST);
}

static json_t *unit(double minimum, double maximum)
{
    static const char *const UNITS[] = {"auto", "m", "cm", "mm", "in", NULL};
    return either_of_three(words(UNITS), real(minimum, maximum), pattern(NUMBER_TEXT));
}

static json_t *text(const ParamInfo *info, const SchemaSolver *solvers)
{
    if (strcmp(info->name, "caption") == 0)
        return pattern("((frame|time|file|solver)(,(frame|time|file|solver))*)?");
    if (strcmp(info->name, "algo") != 0) return json_pack("{s:s}", "type", "string");
    json_t *array = json_array();
    bool good = array;
    for (; solvers->name; ++solvers) append(array, json_string(solvers->name), &good);
    return json_pack("{s:o}", "enum", finish(array, good));
}

// The schema of the parameter's value.
static json_t *value_of(const ParamInfo *info, const SchemaSolver *solvers)
{
    double least = info->minimum, most = info->maximum;
    switch (info->kind) {
    case PARAM_BOOL:
        return json_pack("{s:s}", "type", "boolean");
    case PARAM_INT:
    case PARAM_UINT:
        return whole(least, most);
    case PARAM_FLOAT:
    case PARAM_TURN:
        return real(least, most);
    case PARAM_RATE:
        return either(real(least, most), pattern(NUMBER_TEXT "(/" NUMBER_TEXT ")?"));
    case PARAM_PROFILE:
        return either(real(least, most), points(least, most));
    case PARAM_VEC3:
        return vector(real(least, most), 3);
    case PARAM_COLOR:
        return reference("colorValue");
    case PARAM_BACKGROUND:
        return either(json_pack("{s:s}", "const", "transparent"), reference("colorValue"));
    case PARAM_AUTO_COLOR:
        return either(automatic(), reference("colorValue"));
    case PARAM_AUTO_INT:
        return either_of_three(automatic(), whole(least, most), pattern(WHOLE_TEXT));
    case PARAM_AUTO_FLOAT:
        return either_of_three(automatic(), real(least, most), pattern(NUMBER_TEXT));
    case PARAM_AUTO_VEC3:
        return either_of_three(automatic(), vector(real(least, most), 3), pattern(THREE_TEXT));
    case PARAM_UNIT:
        return unit(least, most);
    case PARAM_SIZE:
        return either(vector(whole(least, most), 2), pattern(WHOLE_TEXT "x" WHOLE_TEXT));
    case PARAM_PART:
        return pattern(WHOLE_TEXT "/" WHOLE_TEXT);
    case PARAM_CHOICE:
        return words(info->choices);
    case PARAM_TEXT:
        return text(info, solvers);
    case PARAM_PATH:
        break;
    }
    return json_pack("{s:s}", "type", "string");
}

static json_t *closed(json_t *properties)
{
    return json_pack("{s:s, s:o, s:b}", "type", "object", "properties", properties,
                     "additionalProperties", 0);
}

// The schema of an object with "keys", an array of {"time": s, ...members}, "interpolation" and
// `others`, which may be NULL.
static json_t *track(json_t *members, json_t *others)
{
    bool good = members;
    put(members, "time", real(-SCENE_TIME_MAX_S, SCENE_TIME_MAX_S), &good);
    json_t *key = closed(finish(members, good));
    put(key, "required", json_pack("[s]", "time"), &good);
    put(key, "minProperties", json_integer(2), &good);
    json_t *properties = others ? others : json_object();
    put(properties, "keys",
        json_pack("{s:s, s:o, s:i}", "type", "array", "items", key, "minItems", 1), &good);
    json_t *between = words(INTERPOLATION_WORDS);
    put(between, "default", json_string(INTERPOLATION_WORDS[INTERPOLATION_SMOOTH]), &good);
    put(properties, "interpolation", between, &good);
    return finish(closed(properties), good);
}

// The schema of one formula of time.
static json_t *formula(void)
{
    return json_pack("{s:[s, s]}", "type", "number", "string");
}

// Either "keys" or "formula".
static void put_alternatives(json_t *track, bool *good)
{
    put(track, "oneOf",
        json_pack("[{s:[s]}, {s:[s], s:{s:b, s:b}}]", "required", "keys", "required", "formula",
                  "properties", "keys", 0, "interpolation", 0),
        good);
}

// At least one of "keys" and the formulas with these names; "interpolation" only beside "keys".
static void put_choice(json_t *track, const char *const names[3], bool *good)
{
    json_t *any = json_pack("[{s:[s]}]", "required", "keys");
    for (int i = 0; i < 3 && names[i]; ++i)
        append(any, json_pack("{s:[s]}", "required", names[i]), good);
    put(track, "anyOf", any, good);
    put(track, "dependencies", json_pack("{s:[s]}", "interpolation", "keys"), good);
}

// The schema of a track for a section's number or color.
static json_t *number_track(const ParamInfo *info)
{
    bool color = section_tracks_is_color(info), good = true;
    json_t *value = color ? reference("colorValue") : real(info->minimum, info->maximum);
    json_t *result = track(json_pack("{s:o}", "value", value),
                           color ? NULL : json_pack("{s:o}", "formula", formula()));
    if (color)
        put(result, "required", json_pack("[s]", "keys"), &good);
    else
        put_alternatives(result, &good);
    return finish(result, good);
}

// The help text, the unit and the solvers that have the parameter.
static json_t *description_of(const ParamInfo *info)
{
    char line[TEXT_SIZE];
    const char *unit_text = *info->unit ? info->unit : NULL;
    int length = snprintf(line, sizeof line, "%s%s%s%s", info->help, unit_text ? " (" : "",
                          unit_text ? unit_text : "", unit_text ? ")" : "");
    if (*info->owner && (size_t)length < sizeof line)
        snprintf(line + length, sizeof line - (size_t)length, "; only for algo: %s", info->owner);
    return json_string(line);
}

// The schema of a parameter. `defaults` is the struct of the parameter's scope.
static json_t *parameter(const ParamInfo *info, const SchemaSolver *solvers, const void *defaults)
{
    json_t *value = value_of(info, solvers);
    bool good = value;
    if (json_object_get(value, "$ref")) // keywords beside $ref are ignored
        value = json_pack("{s:[o]}", "allOf", value);
    bool moves = strcmp(info->name, "gravity") == 0 || strcmp(info->name, "wind") == 0;
    if (moves) value = either(value, reference("forceTrack"));
    if (!section_tracks_refusal(info)) value = either(value, number_track(info));
    put(value, "description", description_of(info), &good);
    put(value, "default", scene_param_write(info, defaults), &good);
    return finish(value, good);
}

static bool is_key(const ParamInfo *info)
{
    return strcmp(info->name, "colliders") != 0; // colliders have a schema of their own
}

// --- Tracks and lights.

static json_t *offsets(void)
{
    return vector(real(-SCENE_OFFSET_MAX, SCENE_OFFSET_MAX), 3);
}

static json_t *force_track(void)
{
    const ParamInfo *wind = params_find("wind");
    json_t *result =
        track(json_pack("{s:o}", "value", vector(real(wind->minimum, wind->maximum), 3)),
              json_pack("{s:o}", "formula", vector(formula(), 3)));
    bool good = result;
    put_alternatives(result, &good);
    return finish(result, good);
}

static json_t *camera_track(void)
{
    const ParamInfo *eye = params_find("eye"), *fov = params_find("fov");
    json_t *result =
        track(json_pack("{s:o, s:o, s:o}", "eye", vector(real(eye->minimum, eye->maximum), 3),
                        "target", vector(real(eye->minimum, eye->maximum), 3), "fov",
                        real(fov->minimum, fov->maximum)),
              json_pack("{s:o, s:o, s:o}", "eye", vector(formula(), 3), "target",
                        vector(formula(), 3), "fov", formula()));
    bool good = result;
    put_choice(result, (const char *const[3]){"eye", "target", "fov"}, &good);
    return finish(result, good);
}

// The schema of the head's track: keys, or formulas of time.
static json_t *head_track(void)
{
    json_t *formulas = vector(formula(), 3);
    json_t *result = track(json_pack("{s:o, s:o}", "translate", offsets(), "rotate", offsets()),
                           json_pack("{s:o, s:O, s:O}", "pivot", offsets(), "translate", formulas,
                                     "rotate", formulas));
    bool good = result;
    json_decref(formulas);
    put_choice(result, (const char *const[3]){"translate", "rotate"}, &good);
    return finish(result, good);
}

// The schema of one kind of light: the common members, and position or direction or both.
static json_t *light(LightKind kind)
{
    json_t *properties = json_object(), *needed = json_array();
    bool good = properties && needed, far = kind == LIGHT_DIRECTIONAL;
    put(properties, "type", json_pack("{s:s}", "const", LIGHT_KIND_WORDS[kind]), &good);
    if (!far) {
        put(properties, "position", offsets(), &good);
        put(properties, "distance", real(SCENE_LIGHT_NEAREST, SCENE_OFFSET_MAX), &good);
        append(needed, json_string("position"), &good);
    }
    if (kind != LIGHT_POINT) {
        put(properties, "direction", offsets(), &good);
        append(needed, json_string("direction"), &good);
    }
    if (kind == LIGHT_SPOT) {
        put(properties, "inner", real(0, SCENE_CONE_MAX), &good);
        put(properties, "outer", real(SCENE_CONE_MIN, SCENE_CONE_MAX), &good);
    }
    put(properties, "color", reference("colorValue"), &good);
    put(properties, "intensity", real(0, SCENE_INTENSITY_MAX), &good);
    put(properties, "radius",
        real(0, kind == LIGHT_DIRECTIONAL ? SCENE_WIDE_MOST : SCENE_OFFSET_MAX), &good);
    put(properties, "shadow", json_pack("{s:s}", "type", "boolean"), &good);
    json_t *object = closed(properties);
    put(object, "required", needed, &good);
    return finish(object, good);
}

static json_t *lights(void)
{
    json_t *kinds = json_array();
    bool good = kinds;
    for (LightKind kind = LIGHT_DIRECTIONAL; LIGHT_KIND_WORDS[kind]; ++kind) {
        json_t *when =
            json_pack("{s:{s:{s:s}}}", "properties", "type", "const", LIGHT_KIND_WORDS[kind]);
        if (kind != LIGHT_DIRECTIONAL) // the default if "type" is missing
            put(when, "required", json_pack("[s]", "type"), &good);
        append(kinds, json_pack("{s:o, s:o}", "if", when, "then", light(kind)), &good);
    }
    json_t *item = json_pack("{s:s, s:{s:o}, s:o}", "type", "object", "properties", "type",
                             words(LIGHT_KIND_WORDS), "allOf", finish(kinds, good));
    return json_pack("{s:s, s:o, s:i}", "type", "array", "items", item, "maxItems",
                     SCENE_MAX_LIGHTS);
}

// --- Colliders.

// The schema of a shape's numbers, "x,y,z,radius".
static json_t *shape_numbers(const char *names)
{
    json_t *items = json_array();
    bool good = items;
    int count = 0;
    for (const char *at = names; at; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL, ++count)
        append(items,
               real(strncmp(at, "radius", 6) == 0 ? 0 : -COLLIDERS_FARTHEST, COLLIDERS_FARTHEST),
               &good);
    if (count == 1) {
        json_t *only = json_incref(json_array_get(items, 0));
        json_decref(items);
        return only;
    }
    return json_pack("{s:s, s:o, s:b, s:i, s:s}", "type", "array", "items", finish(items, good),
                     "additionalItems", 0, "minItems", count, "description", names);
}

static json_t *shape(const char *name, const char *numbers, bool anywhere)
{
    json_t *properties = json_object();
    bool good = properties;
    put(properties, name, shape_numbers(numbers), &good);
    if (anywhere)
        put(properties, "frame",
            json_pack("{s:[s, s], s:s}", "enum", "head", "world", "default", "head"), &good);
    json_t *object = closed(properties);
    put(object, "required", json_pack("[s]", name), &good);
    return finish(object, good);
}

static json_t *colliders(void)
{
    json_t *shapes = json_array();
    bool good = shapes;
    enum { FRAME_any, FRAME_world };
#define SHAPE(kind, name, numbers, frame)                                                          \
    append(shapes, shape(#name, COLLIDER_STRING numbers, (int)FRAME_##frame == (int)FRAME_any),    \
           &good);
    COLLIDERS(SHAPE, SHAPE)
#undef SHAPE
    return either(
        json_pack("{s:s, s:{s:o}}", "type", "array", "items", "anyOf", finish(shapes, good)),
        json_pack("{s:s}", "type", "string"));
}

// --- The whole schema.

// The rule for a section with this solver: it has the solver's variants and no parameters of other
// solvers.
static json_t *rule_of(const SchemaSolver *solver)
{
    json_t *properties = json_object();
    json_t *variants = words(solver->variants);
    bool good = properties;
    append(json_object_get(variants, "enum"), json_string(""), &good);
    put(properties, "variant", variants, &good);
    for (size_t i = 0; i < PARAM_COUNT; ++i)
        if (!params_owned_by(&PARAM_TABLE[i], solver->name))
            put(properties, PARAM_TABLE[i].name, json_false(), &good);
    return json_pack("{s:{s:{s:{s:s}}, s:[s]}, s:{s:o}}", "if", "properties", "algo", "const",
                     solver->name, "required", "algo", "then", "properties",
                     finish(properties, good));
}

// Adds the parameter under all its names.
static void put_param(json_t *properties, const ParamInfo *info, bool *good)
{
    put(properties, info->name, reference(info->name), good);
    if (params_also(info)) put(properties, params_also(info), reference(info->name), good);
}

static json_t *section(const SchemaSolver *solvers)
{
    json_t *properties = json_object(), *rules = json_array();
    bool good = properties && rules;
    put(properties, "file",
        json_pack("{s:s, s:i, s:s}", "type", "string", "minLength", 1, "description",
                  "hair file, relative to the folder of this file"),
        &good);
    for (size_t i = 0; i < PARAM_COUNT; ++i)
        if (PARAM_TABLE[i].scope == SCOPE_SECTION) put_param(properties, &PARAM_TABLE[i], &good);
    for (; solvers->name; ++solvers) append(rules, rule_of(solvers), &good);
    json_t *object = closed(properties);
    put(object, "required", json_pack("[s]", "file"), &good);
    put(object, "allOf", rules, &good);
    return finish(object, good);
}

// The help text of this key, or "".
static json_t *explain(const char *const (*keys)[3], const char *name)
{
    char line[TEXT_SIZE] = "";
    for (; (*keys)[0]; ++keys)
        if (strcmp((*keys)[0], name) == 0 && !*line)
            snprintf(line, sizeof line, "%s: %s", (*keys)[2], (*keys)[1]);
    return json_string(line);
}

static json_t *list_of(const char *object, int most)
{
    return json_pack("{s:s, s:o, s:i, s:i}", "type", "array", "items", reference(object),
                     "minItems", 1, "maxItems", most);
}

// A key that is no parameter, with the help's text.
typedef struct SchemaPart {
    const char *key;
    json_t *value;
} SchemaPart;

static void put_parts(json_t *properties, const SchemaPart *parts, size_t count,
                      const char *const (*keys)[3], bool *good)
{
    for (size_t i = 0; i < count; ++i) {
        put(parts[i].value, "description", explain(keys, parts[i].key), good);
        put(properties, parts[i].key, parts[i].value, good);
    }
}

// What a body of the list has, and a file without the list at its top level.
static void put_body_parts(json_t *properties, const char *const (*keys)[3], bool *good)
{
    const SchemaPart parts[] = {
        {"sections", list_of("sectionObject", SCENE_MAX_SECTIONS)},
        {"head", head_track()},
        {"colliders", colliders()},
    };
    put_parts(properties, parts, sizeof parts / sizeof *parts, keys, good);
}

static json_t *body(const char *const (*keys)[3])
{
    json_t *properties = json_object();
    bool good = properties;
    put_body_parts(properties, keys, &good);
    for (size_t i = 0; i < PARAM_COUNT; ++i)
        if (is_key(&PARAM_TABLE[i]) && PARAM_TABLE[i].scope == SCOPE_BODY)
            put_param(properties, &PARAM_TABLE[i], &good);
    json_t *object = closed(properties);
    put(object, "required", json_pack("[s]", "sections"), &good);
    return finish(object, good);
}

// The defaults of each scope's parameters.
typedef struct SchemaDefaults {
    RunParams run;
    BodyParams body;
    SectionParams section;
} SchemaDefaults;

static json_t *definitions(const SchemaSolver *solvers, const char *const (*keys)[3],
                           const SchemaDefaults *defaults)
{
    const void *const of[] = {[SCOPE_RUN] = &defaults->run,
                              [SCOPE_BODY] = &defaults->body,
                              [SCOPE_SECTION] = &defaults->section};
    json_t *all = json_object();
    bool good = all;
    put(all, "colorValue", color(), &good);
    put(all, "forceTrack", force_track(), &good);
    put(all, "sectionObject", section(solvers), &good);
    put(all, "bodyObject", body(keys), &good);
    for (size_t i = 0; i < PARAM_COUNT; ++i) {
        const ParamInfo *info = &PARAM_TABLE[i];
        if (is_key(info)) put(all, info->name, parameter(info, solvers, of[info->scope]), &good);
    }
    return finish(all, good);
}

static json_t *top(const char *const (*keys)[3])
{
    const SchemaPart parts[] = {
        {"bodies", list_of("bodyObject", SCENE_MAX_BODIES)},
        {"camera", camera_track()},
        {"lights", lights()},
    };
    json_t *properties = json_object();
    bool good = properties;
    put(properties, "$schema",
        json_pack("{s:s, s:s}", "type", "string", "description",
                  "path or address of this schema, for editors; ignored otherwise"),
        &good);
    put_body_parts(properties, keys, &good);
    put_parts(properties, parts, sizeof parts / sizeof *parts, keys, &good);
    for (size_t i = 0; i < PARAM_COUNT; ++i)
        if (is_key(&PARAM_TABLE[i])) put_param(properties, &PARAM_TABLE[i], &good);
    return finish(properties, good);
}

// Sections at the top level, or a list of bodies that have them.
static json_t *one_or_several(void)
{
    return json_pack("[{s:[s], s:{s:b}}, {s:[s], s:{s:b, s:b}}]", "required", "sections",
                     "properties", "bodies", 0, "required", "bodies", "properties", "sections", 0,
                     "head", 0);
}

Result scene_schema_write(const SchemaSolver *solvers, const char *const (*keys)[3], FILE *stream,
                          Error *error)
{
    SchemaDefaults own = {0};
    Result result = params_create_run(&own.run, error);
    THEN(result, params_create_body(&own.body, error));
    THEN(result, params_create_section(&own.section, error));
    json_t *schema = NULL;
    if (result == RESULT_OK)
        schema = json_pack(
            "{s:s, s:s, s:s, s:s, s:o, s:b, s:o, s:o}", "$schema",
            "http://json-schema.org/draft-07/schema#", "title", "Tractrix scene", "description",
            "A scene of tractrix-render: hair files, how they move and how they "
            "look. Made by tractrix-render --help schema.",
            "type", "object", "oneOf", one_or_several(), "additionalProperties", 0, "properties",
            top(keys), "definitions", definitions(solvers, keys, &own));
    char *lines = json_text(schema, JSON_INDENT(2) | JSON_REAL_PRECISION(9));
    if (lines) fprintf(stream, "%s\n", lines);
    if (!lines && result == RESULT_OK)
        result = error_set(error, RESULT_FAILED, "no memory for the schema");
    free(lines);
    json_decref(schema);
    params_destroy_run(&own.run);
    params_destroy_body(&own.body);
    params_destroy_section(&own.section);
    return result;
}
