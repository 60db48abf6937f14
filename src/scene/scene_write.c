// SPDX-License-Identifier: MIT
// Writes a scene as JSON. jansson's functions accept NULL for a value and then fail. So a failed
// allocation needs to be checked only where a value is put into its parent.
#include "scene/scene_param.h"
#include "scene/scene_tracks.h"
#include "scene/section_keys.h"

#include "glsl/common/shared_math.h"

#include <math.h>
#include <string.h>

// Puts `value` into `object` and takes over its reference. False if either is NULL or memory is
// short.
static bool put(json_t *object, const char *key, json_t *value)
{
    return json_object_set_new(object, key, value) == 0;
}

// Returns `json` if all went well, otherwise frees it.
static json_t *finish(json_t *json, bool good)
{
    if (json && good) return json;
    json_decref(json);
    return NULL;
}

static json_t *write_value(const Keyframes *keys, uint32_t key, double scale)
{
    float scaled[KEYFRAMES_MAX_WIDTH];
    for (uint32_t i = 0; i < keys->width; i++)
        scaled[i] = (float)((double)keys->value[(size_t)key * keys->width + i] * scale);
    return keys->width == 1 ? scene_param_write_float(scaled[0])
                            : scene_param_write_floats(scaled, keys->width);
}

// A track that becomes the member `name` of keys, in the unit of the file.
typedef struct Track {
    const char *name;
    const Keyframes *keys;
    double scale;
    uint32_t next; // the first key not yet written
} Track;

// The earliest time of the keys that are not yet written; infinity if there are none.
static double next_time(const Track *tracks, size_t count)
{
    double time = INFINITY;
    for (size_t i = 0; i < count; i++) {
        const Track *track = &tracks[i];
        if (track->next < track->keys->count) time = fmin(time, track->keys->time[track->next]);
    }
    return time;
}

// {"keys": [...], "interpolation": ...} with each time once. NULL if no track has keys or if memory
// is short.
static json_t *write_tracks(Track *tracks, size_t count)
{
    json_t *array = json_array(), *object = json_object();
    Interpolation interpolation = INTERPOLATION_SMOOTH;
    bool good = true;
    for (double time; isfinite(time = next_time(tracks, count));) {
        json_t *key = json_object();
        good = put(key, "time", json_real(time)) && good;
        for (size_t i = 0; i < count; i++) {
            Track *track = &tracks[i];
            if (track->next == track->keys->count || track->keys->time[track->next] != time)
                continue;
            interpolation = track->keys->interpolation;
            good =
                put(key, track->name, write_value(track->keys, track->next, track->scale)) && good;
            track->next++;
        }
        good = json_array_append_new(array, key) == 0 && good;
    }
    good = put(object, "keys", array) && good;
    good = put(object, "interpolation", json_string(INTERPOLATION_WORDS[interpolation])) && good;
    return finish(object, good);
}

static bool write_force(json_t *object, const char *name, const Keyframes *keys)
{
    Track track = {.name = "value", .keys = keys, .scale = 1.0};
    return keys->count == 0 || put(object, name, write_tracks(&track, 1));
}

static bool write_camera(json_t *object, const Scene *scene)
{
    Track tracks[] = {{.name = "eye", .keys = &scene->eye, .scale = 1.0},
                      {.name = "target", .keys = &scene->target, .scale = 1.0},
                      {.name = "fov", .keys = &scene->fov, .scale = 1.0}};
    if (isinf(next_time(tracks, 3))) return true;
    bool good = put(object, "camera", write_tracks(tracks, 3));
    // A scene file has either the constant or the keyframes.
    for (size_t i = 0; i < 3; i++) {
        if (tracks[i].keys->count > 0) json_object_del(object, tracks[i].name);
    }
    return good;
}

// `formulas` has three elements.
static json_t *write_formulas(const Formula *formulas)
{
    json_t *array = json_array();
    bool good = true;
    for (int i = 0; i < 3; i++)
        good = json_array_append_new(array, scene_param_write_text(formulas[i].text)) == 0 && good;
    return finish(array, good);
}

static bool write_head(json_t *object, const RigidTrack *track)
{
    Track tracks[] = {
        {.name = "translate", .keys = &track->translation, .scale = 1.0},
        {.name = "rotate", .keys = &track->rotation, .scale = 1.0 / DEGREE},
    };
    bool keyed = !isinf(next_time(tracks, 2)), moved = track->translation_formula[0].text,
         turned = track->rotation_formula[0].text;
    if (!keyed && !moved && !turned) return true;
    json_t *head = keyed ? write_tracks(tracks, 2) : json_object();
    bool good = put(head, "pivot", scene_param_write_floats(track->pivot, 3));
    if (moved) good = put(head, "translate", write_formulas(track->translation_formula)) && good;
    if (turned) good = put(head, "rotate", write_formulas(track->rotation_formula)) && good;
    return put(object, "head", head) && good;
}

static json_t *write_light(const Light *light)
{
    bool far = light->kind == LIGHT_DIRECTIONAL;
    float way[3], color[3];
    for (int i = 0; i < 3; i++) {
        way[i] = (far ? -light->direction[i] : light->direction[i]) + 0.0f;
        color[i] = fminf((float)srgb_encode((double)light->color[i]), 1.0f);
    }
    json_t *object = json_object();
    bool good = put(object, "type", json_string(LIGHT_KIND_WORDS[light->kind]));
    if (!far) {
        good = put(object, "position", scene_param_write_floats(light->position, 3)) && good;
        good = put(object, "distance", scene_param_write_float(light->distance)) && good;
    }
    if (light->kind != LIGHT_POINT)
        good = put(object, "direction", scene_param_write_floats(way, 3)) && good;
    if (light->kind == LIGHT_SPOT) {
        good = put(object, "inner", scene_param_write_float(light->inner_deg)) && good;
        good = put(object, "outer", scene_param_write_float(light->outer_deg)) && good;
    }
    good = put(object, "color", scene_param_write_floats(color, 3)) && good;
    good = put(object, "intensity", scene_param_write_float(light->intensity)) && good;
    if (light->radius > 0)
        good = put(object, "radius", scene_param_write_float(light->radius)) && good;
    good = put(object, "shadow", json_boolean(light->shadow)) && good;
    return finish(object, good);
}

static bool write_lights(json_t *object, const Scene *scene)
{
    json_t *array = json_array();
    bool good = true;
    for (uint32_t i = 0; i < scene->light_count; i++)
        good = json_array_append_new(array, write_light(&scene->lights[i])) == 0 && good;
    return put(object, "lights", array) && good;
}

// Whether the parameter is a permission, which only the command line can give.
static bool is_permission(const ParamInfo *info)
{
    return strcmp(info->name, "allow_paths") == 0;
}

// Writes the parameters of a scope, those with tracks as tracks. `algo` is the section's solver.
static bool write_params(json_t *object, ParamScope scope, const void *params, const char *algo,
                         const SectionTracks *tracks)
{
    bool good = true;
    for (size_t i = 0; i < PARAM_COUNT; i++) {
        const ParamInfo *info = &PARAM_TABLE[i];
        if (info->scope == scope && params_owned_by(info, algo) && !is_permission(info))
            good = put(object, info->name,
                       section_tracks_has(tracks, info) ? section_keys_write(tracks, info)
                                                        : scene_param_write(info, params)) &&
                   good;
    }
    return good;
}

static bool write_sections(json_t *object, const Scene *scene, const SceneBody *body)
{
    json_t *array = json_array();
    bool good = true;
    for (uint32_t i = body->first; i < body->first + body->section_count; i++) {
        json_t *section = json_object();
        good = put(section, "file", scene_param_write_text(scene->sections[i].file)) && good;
        const SectionParams *params = &scene->sections[i].params;
        good = write_params(section, SCOPE_SECTION, params, params->algo,
                            &scene->sections[i].tracks) &&
               good;
        good = json_array_append_new(array, section) == 0 && good;
    }
    return put(object, "sections", array) && good;
}

static bool write_body(json_t *object, const Scene *scene, const SceneBody *body)
{
    bool good = write_params(object, SCOPE_BODY, &body->params, "", &(SectionTracks){0});
    good = write_head(object, &body->head) && good;
    if (body->colliders.count)
        good = put(object, "colliders", colliders_to_json(&body->colliders)) && good;
    return write_sections(object, scene, body) && good;
}

static bool write_list(json_t *object, const Scene *scene)
{
    json_t *array = json_array();
    bool good = true;
    for (uint32_t i = 0; i < scene->body_count; i++) {
        json_t *body = json_object();
        good = write_body(body, scene, &scene->bodies[i]) && good;
        good = json_array_append_new(array, body) == 0 && good;
    }
    return put(object, "bodies", array) && good;
}

json_t *scene_to_json(const Scene *scene)
{
    json_t *object = json_object();
    bool good = write_params(object, SCOPE_RUN, &scene->run, "", &(SectionTracks){0});
    good = write_force(object, "gravity", &scene->gravity) && good;
    good = write_force(object, "wind", &scene->wind) && good;
    good = write_camera(object, scene) && good;
    good = write_lights(object, scene) && good;
    good = (scene->body_count == 1 ? write_body(object, scene, &scene->bodies[0])
                                   : write_list(object, scene)) &&
           good;
    return finish(object, good);
}
