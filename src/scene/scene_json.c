// SPDX-License-Identifier: MIT
#include "scene/scene.h"
#include "scene/scene_param.h"
#include "scene/scene_tracks.h"
#include "scene/section_keys.h"

#include <stdlib.h>
#include <string.h>

// A member of the file that is not a parameter.
typedef struct Part {
    const char *key;
    Result (*read)(Scene *scene, const JsonPlace *place, const json_t *value, Error *error);
} Part;

static const Part PARTS[] = {{"camera", scene_tracks_read_camera},
                             {"lights", scene_tracks_read_lights}};
enum { PART_COUNT = sizeof PARTS / sizeof PARTS[0] };

// The objects of a scene file that have parameters. A file with one body may leave out the list of
// bodies: the top level has its keys, then.
typedef enum Level { LEVEL_TOP, LEVEL_BODY, LEVEL_SECTION } Level;

static const struct {
    const char *name;     // as messages call it
    const char *keys[4];  // that are no parameters
    ParamScope outermost; // whose parameters it may have
} LEVELS[] = {
    [LEVEL_TOP] = {"the top level", {"bodies", "sections", "head", "$schema"}, SCOPE_RUN},
    [LEVEL_BODY] = {"a body", {"sections", "head"}, SCOPE_BODY},
    [LEVEL_SECTION] = {"a section", {"file"}, SCOPE_SECTION},
};
enum { LEVEL_KEYS = sizeof LEVELS->keys / sizeof *LEVELS->keys };

// Whether an object may have this parameter: the top level those of all scopes, as defaults.
static bool may_have(Level level, const ParamInfo *info)
{
    return level == LEVEL_TOP || info->scope == LEVELS[level].outermost;
}

// The file being read. `root` is its place; `folder` is the part of its path up to and including
// the last '/', or "".
typedef struct Document {
    JsonPlace root;
    const char *folder;
    const json_t *json;
    const SceneOverrides *overrides;
} Document;

// The keys that an object of the file may have, terminated by NULL; the caller frees the array.
static const char **list_keys(Level level)
{
    const char **names = calloc(2 * PARAM_COUNT + PART_COUNT + LEVEL_KEYS + 1, sizeof names[0]);
    size_t count = 0;
    if (!names) return NULL;
    for (size_t i = 0; i < PARAM_COUNT; i++) {
        const ParamInfo *info = &PARAM_TABLE[i];
        if (!may_have(level, info)) continue;
        names[count++] = info->name;
        if (params_also(info)) names[count++] = params_also(info);
    }
    for (size_t i = 0; level == LEVEL_TOP && i < PART_COUNT; i++) names[count++] = PARTS[i].key;
    for (size_t i = 0; i < LEVEL_KEYS && LEVELS[level].keys[i]; i++)
        names[count++] = LEVELS[level].keys[i];
    return names;
}

static Result check_keys(Level level, const JsonPlace *place, const json_t *object, Error *error)
{
    for (size_t i = 0; i < PARAM_COUNT; i++) {
        const ParamInfo *info = &PARAM_TABLE[i];
        if (!may_have(level, info) && json_object_get(object, info->name))
            return json_fail(place, error, "'%s' belongs to the top level%s, not to %s", info->name,
                             info->scope == SCOPE_RUN    ? ""
                             : info->scope == SCOPE_BODY ? " or to a body"
                                                         : " or to a section",
                             LEVELS[level].name);
    }
    const char **names = list_keys(level);
    if (!names) return error_set(error, RESULT_FAILED, "out of memory");
    Result result = json_check_object(place, object, names, error);
    free(names);
    return result;
}

// Whether the parameter may have keyframes.
static bool is_force(const char *name)
{
    return strcmp(name, "gravity") == 0 || strcmp(name, "wind") == 0;
}

// The destination of parameters of one scope, and the Origin of each.
typedef struct Sink {
    ParamScope scope;
    void *params;
    uint8_t *origin;       // [SCENE_PARAMS]
    SectionTracks *tracks; // of a section; otherwise NULL
    Colliders *colliders;  // of a body; otherwise NULL
} Sink;

static Result read_colliders(Colliders *colliders, const JsonPlace *place, const json_t *value,
                             Error *error)
{
    colliders_destroy(colliders);
    return colliders_from_json(colliders, place, value, error);
}

// Reads the parameters of one scope from the members of `object`. The caller reads keyframes of
// forces.
static Result read_params(const Document *document, const Sink *sink, Origin origin,
                          const JsonPlace *parent, const json_t *object, Error *error)
{
    for (size_t i = 0; i < PARAM_COUNT; i++) {
        const ParamInfo *info = &PARAM_TABLE[i];
        const char *key = info->name;
        const char *also = params_also(info);
        if (also && json_object_get(object, also) && info->scope == sink->scope) {
            if (json_object_get(object, key))
                return json_fail(
                    parent, error,
                    "'%s' and '%s' are two names of the same key: expected one of them", key, also);
            key = also;
        }
        const json_t *value = json_object_get(object, key);
        bool keys = json_is_object(value) && is_force(info->name);
        bool shapes = strcmp(info->name, "colliders") == 0;
        if (info->scope != sink->scope || !value) continue;
        sink->origin[i] = (uint8_t)origin;
        JsonPlace place = {.parent = parent, .key = key};
        if (sink->tracks && json_is_object(value)) {
            TRY(section_keys_read(sink->tracks, sink->params, info, &place, value, error));
            continue;
        }
        if (sink->tracks) section_tracks_drop(sink->tracks, info);
        if (shapes) TRY(read_colliders(sink->colliders, &place, value, error));
        if (shapes && json_is_array(value)) // not the text of the defaults beside this list
            TRY(params_parse(info, sink->params, "", error));
        else if (!keys)
            TRY(scene_param_read(info, sink->params, document->folder, &place, value, error));
    }
    return RESULT_OK;
}

static Result read_section(Scene *scene, const Document *document, const Section *defaults,
                           const JsonPlace *place, const json_t *object, Error *error)
{
    TRY(check_keys(LEVEL_SECTION, place, object, error));
    const json_t *file = json_object_get(object, "file");
    if (!file) return json_fail(place, error, "expected a key 'file'");
    JsonPlace file_place = {.parent = place, .key = "file"};
    if (!json_is_string(file) || json_string_length(file) == 0)
        return json_refuse(&file_place, file, "the path of a hair file", error);
    char *path = scene_param_join_path(document->folder, json_string_value(file));
    if (!path) return error_set(error, RESULT_FAILED, "out of memory");
    Result result = scene_add_section(scene, path, &defaults->params, error);
    free(path);
    if (result != RESULT_OK) return result;
    Section *section = &scene->sections[scene->section_count - 1];
    const Sink sink = {SCOPE_SECTION, &section->params, section->origin, &section->tracks, NULL};
    TRY(section_tracks_copy(&section->tracks, &defaults->tracks, error));
    memcpy(section->origin, defaults->origin, sizeof section->origin);
    return read_params(document, &sink, ORIGIN_KEY, place, object, error);
}

// Whether the parameter belongs to the section's solver or to the solver that the command line
// selects.
static bool is_owned(const ParamInfo *info, const Section *section, const char *asked)
{
    return params_owned_by(info, section->params.algo) || (asked && params_owned_by(info, asked));
}

// Where a section stands: the last of `place`, each the parent of the next.
typedef struct PlaceOfSection {
    JsonPlace bodies, body, sections, section;
} PlaceOfSection;

static void find_place(PlaceOfSection *place, const Scene *scene, const Document *document,
                       uint32_t section)
{
    const SceneBody *body = scene_body_of(scene, section);
    bool listed = json_object_get(document->json, "bodies");
    place->bodies = (JsonPlace){.parent = &document->root, .key = "bodies"};
    place->body = (JsonPlace){.parent = &place->bodies, .index = (size_t)(body - scene->bodies)};
    place->sections =
        (JsonPlace){.parent = listed ? &place->body : &document->root, .key = "sections"};
    place->section = (JsonPlace){.parent = &place->sections, .index = section - body->first};
}

static Result check_owner(const Scene *scene, const Document *document, size_t row, Error *error)
{
    const ParamInfo *info = &PARAM_TABLE[row];
    const char *asked = document->overrides->algo;
    bool shared = false, owned = false;
    JsonPlace place = {.parent = &document->root, .key = info->name};
    for (uint32_t i = 0; i < scene->section_count; i++) {
        const Section *section = &scene->sections[i];
        bool own = is_owned(info, section, asked);
        shared = shared || section->origin[row] == ORIGIN_SHARED_KEY;
        owned = owned || own;
        if (own || section->origin[row] != ORIGIN_KEY) continue;
        PlaceOfSection of;
        find_place(&of, scene, document, i);
        place.parent = &of.section;
        json_fail(&place, error, "algo '%.60s' has no such parameter: it belongs to %s",
                  section->params.algo, info->owner);
        return RESULT_USAGE;
    }
    if (!shared || owned) return RESULT_OK;
    json_fail(&place, error, "no section's algo has such a parameter: it belongs to %s",
              info->owner);
    return RESULT_USAGE;
}

// The preset that the command line gives, or else the file. NULL if neither does, or if the file's
// word is invalid, which is reported when its value is read.
static const char *find_word(const Document *document, const char *name, const char *asked)
{
    RunParams unused = {0};
    Error why = {{0}};
    const char *word = json_string_value(json_object_get(document->json, name));
    if (asked || !word) return asked;
    return params_parse(params_find(name), &unused, word, &why) == RESULT_OK ? word : NULL;
}

static Presets find_presets(const Document *document)
{
    const Presets *asked = &document->overrides->presets;
    return (Presets){find_word(document, "look", asked->look),
                     find_word(document, "quality", asked->quality)};
}

// The sections of an object whose place is `of`: the last body's.
static Result read_sections(Scene *scene, const Document *document, const Section *defaults,
                            const JsonPlace *of, const json_t *object, Error *error)
{
    const json_t *array = json_object_get(object, "sections");
    if (!array) return json_fail(of, error, "expected a key 'sections'");
    JsonPlace place = {.parent = of, .key = "sections"};
    size_t count = json_array_size(array);
    if (!json_is_array(array) || count == 0 || count > SCENE_MAX_SECTIONS - scene->section_count)
        return json_refuse(&place, array, "an array of 1 to 1024 sections, all bodies together",
                           error);
    for (size_t i = 0; i < count; i++) {
        JsonPlace element = {.parent = &place, .index = i};
        TRY(read_section(scene, document, defaults, &element, json_array_get(array, i), error));
    }
    return RESULT_OK;
}

static Result read_head(SceneBody *body, const JsonPlace *of, const json_t *object, Error *error)
{
    const json_t *value = json_object_get(object, "head");
    const JsonPlace place = {.parent = of, .key = "head"};
    return value ? scene_tracks_read_head(&body->head, &place, value, error) : RESULT_OK;
}

// A body of the list; `first` has the top level's parameters, which are the defaults of each.
static Result read_body(Scene *scene, const Document *document, const SceneBody *first,
                        const Section *defaults, const JsonPlace *place, const json_t *object,
                        Error *error)
{
    SceneBody *body = &scene->bodies[scene->body_count - 1];
    const Sink sink = {SCOPE_BODY, &body->params, body->origin, NULL, &body->colliders};
    TRY(check_keys(LEVEL_BODY, place, object, error));
    TRY(params_copy_body(&body->params, &first->params, error));
    memcpy(body->origin, first->origin, sizeof body->origin);
    for (uint32_t i = 0; i < first->colliders.count; ++i)
        TRY(colliders_add(&body->colliders, &first->colliders.list[i], error));
    TRY(read_params(document, &sink, ORIGIN_KEY, place, object, error));
    TRY(read_head(body, place, object, error));
    return read_sections(scene, document, defaults, place, object, error);
}

static Result read_list(Scene *scene, const Document *document, const json_t *array,
                        const Section *defaults, Error *error)
{
    static const char *const BESIDE[] = {"sections", "head"};
    JsonPlace place = {.parent = &document->root, .key = "bodies"};
    size_t count = json_array_size(array);
    if (!json_is_array(array) || count == 0 || count > SCENE_MAX_BODIES)
        return json_refuse(&place, array, "an array of 1 to 16 bodies", error);
    for (size_t i = 0; i < sizeof BESIDE / sizeof *BESIDE; i++)
        if (json_object_get(document->json, BESIDE[i]))
            return json_fail(&document->root, error,
                             "'%s' beside 'bodies': expected this key in a body", BESIDE[i]);
    scene->lists_bodies = true;
    SceneBody first = scene->bodies[0];
    scene->bodies[0] = (SceneBody){0};
    Result result = RESULT_OK;
    for (size_t i = 0; i < count && result == RESULT_OK; i++) {
        JsonPlace element = {.parent = &place, .index = i};
        scene->body_count = (uint32_t)i + 1;
        result =
            read_body(scene, document, &first, defaults, &element, json_array_get(array, i), error);
    }
    params_destroy_body(&first.params);
    colliders_destroy(&first.colliders);
    return result;
}

// Parameters at the top level are the defaults of every body and section.
static Result read_bodies(Scene *scene, const Document *document, Error *error)
{
    SceneBody *body = &scene->bodies[0];
    Section defaults = {0};
    const json_t *list = json_object_get(document->json, "bodies");
    const Sink bodies = {SCOPE_BODY, &body->params, body->origin, NULL, &body->colliders},
               sections = {SCOPE_SECTION, &defaults.params, defaults.origin, &defaults.tracks,
                           NULL};
    const JsonPlace *root = &document->root;
    const Presets presets = find_presets(document);
    Result result = read_params(document, &bodies, ORIGIN_SHARED_KEY, root, document->json, error);
    THEN(result, params_create_section(&defaults.params, error));
    THEN(result, scene_apply_presets(&presets, SCOPE_SECTION, &defaults.params, error));
    THEN(result, read_params(document, &sections, ORIGIN_SHARED_KEY, root, document->json, error));
    if (list) {
        THEN(result, read_list(scene, document, list, &defaults, error));
    } else {
        THEN(result, read_head(body, root, document->json, error));
        THEN(result, read_sections(scene, document, &defaults, root, document->json, error));
    }
    for (size_t i = 0; i < PARAM_COUNT; i++) THEN(result, check_owner(scene, document, i, error));
    params_destroy_section(&defaults.params);
    section_tracks_destroy(&defaults.tracks);
    return result;
}

// Reads the track if the force `name` (gravity or wind) is an object.
static Result read_force(Track *track, const char *name, const Document *document, Error *error)
{
    const json_t *value = json_object_get(document->json, name);
    if (!json_is_object(value)) return RESULT_OK;
    JsonPlace place = {.parent = &document->root, .key = name};
    return scene_tracks_read_force(track, params_find(name), &place, value, error);
}

static Result refuse_both(const Document *document, const char *name, const Track *track,
                          Error *error)
{
    if (!track_is_given(track) || !json_object_get(document->json, name)) return RESULT_OK;
    JsonPlace place = {.parent = &document->root, .key = name};
    return json_fail(&place, error, "given here and by 'camera': expected only one of them");
}

static Result read_parts(Scene *scene, const Document *document, Error *error)
{
    TRY(read_force(&scene->gravity, "gravity", document, error));
    TRY(read_force(&scene->wind, "wind", document, error));
    for (size_t i = 0; i < PART_COUNT; i++) {
        const json_t *value = json_object_get(document->json, PARTS[i].key);
        JsonPlace place = {.parent = &document->root, .key = PARTS[i].key};
        if (value) TRY(PARTS[i].read(scene, &place, value, error));
    }
    TRY(refuse_both(document, "eye", &scene->eye, error));
    TRY(refuse_both(document, "target", &scene->target, error));
    return refuse_both(document, "fov", &scene->fov, error);
}

static Result read_document(Scene *scene, const Document *document, Error *error)
{
    const Presets presets = find_presets(document);
    TRY(check_keys(LEVEL_TOP, &document->root, document->json, error));
    // For editors: the path or address of the file's JSON schema, ignored here.
    const json_t *schema = json_object_get(document->json, "$schema");
    const JsonPlace schema_place = {.parent = &document->root, .key = "$schema"};
    if (schema && !json_is_string(schema))
        return json_refuse(&schema_place, schema, "a string: the schema's path", error);
    TRY(scene_apply_presets(&presets, SCOPE_RUN, &scene->run, error));
    const Sink sink = {SCOPE_RUN, &scene->run, scene->origin, NULL, NULL};
    int look = scene->run.look, quality = scene->run.quality;
    TRY(read_params(document, &sink, ORIGIN_SHARED_KEY, &document->root, document->json, error));
    scene->run.look = look;
    scene->run.quality = quality;
    TRY(read_bodies(scene, document, error));
    return read_parts(scene, document, error);
}

static Result parse(Scene *scene, const char *name, const json_t *json, const char *folder,
                    const SceneOverrides *overrides, Error *error)
{
    const Document document = {
        .root = {.key = name}, .json = json, .folder = folder, .overrides = overrides};
    scene->file = strdup(name);
    Result result = scene->file ? read_document(scene, &document, error)
                                : error_set(error, RESULT_FAILED, "out of memory");
    // A scene file without a scalp means none.
    if (scene->origin[params_find("scalp") - PARAM_TABLE] == ORIGIN_DEFAULT)
        scene->run.scalp = SCALP_NONE;
    return result;
}

Result scene_parse_unchecked(Scene *scene, const char *name, const Bytes *content,
                             const char *folder, const SceneOverrides *overrides, Error *error)
{
    json_t *json;
    TRY(scene_create(scene, error));
    TRY(json_parse(&json, name, content, JSON_REJECT_DUPLICATES, error));
    Result result = parse(scene, name, json, folder, overrides, error);
    json_decref(json);
    return result;
}

Result scene_read_unchecked(Scene *scene, const char *path, const SceneOverrides *overrides,
                            Error *error)
{
    Bytes bytes;
    *scene = (Scene){0};
    TRY(bytes_read_file(&bytes, path, error));
    bytes_drop_mark(&bytes);
    const char *slash = strrchr(path, '/');
    char *folder = strndup(path, slash ? (size_t)(slash + 1 - path) : 0);
    Result result = folder ? scene_parse_unchecked(scene, path, &bytes, folder, overrides, error)
                           : error_set(error, RESULT_FAILED, "out of memory");
    free(folder);
    bytes_destroy(&bytes);
    return result;
}

Result scene_read(Scene *scene, const char *path, Error *error)
{
    const SceneOverrides none = {0};
    TRY(scene_read_unchecked(scene, path, &none, error));
    scene_settle(scene);
    scene_set_lights(scene);
    Result result = scene_check(scene, error);
    if (result != RESULT_USAGE && result != RESULT_BAD_INPUT) return result;
    return error_prefix(error, RESULT_BAD_INPUT, "%.300s: ", path);
}
