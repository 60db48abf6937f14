// SPDX-License-Identifier: MIT
#include "run/cache_scene.h"

#include "base/json.h"

#include "version.h"

#include <endian.h>
#include <epoxy/gl.h>
#include <libdeflate.h>
#include <stdlib.h>
#include <string.h>

// --- The program and driver that simulated.

static const char MAKER[] = "made_by", NUMBER[] = "frame_number";

const char *cache_scene_own_maker(void)
{
    static char maker[600];
    snprintf(maker, sizeof maker, "tractrix %s, %s, OpenGL %s", TRACTRIX_VERSION,
             (const char *)glGetString(GL_RENDERER), (const char *)glGetString(GL_VERSION));
    return maker;
}

char *cache_scene_maker(const Bytes *text)
{
    json_t *scene = json_read((const char *)text->data, text->size, 0, NULL);
    const char *maker = json_string_value(json_object_get(scene, MAKER));
    char *copy = strdup(maker ? maker : "unknown");
    json_decref(scene);
    return copy;
}

// --- Values.

// Parameters in the groups below that do not change the motion of guides.
static const char *const HARMLESS[] = {"frames",    "followers",      "follow", "follower_radius",
                                       "sdf_cache", "tip_separation", "clump",  "frame_number"};

// Keys that are not parameters and only concern drawing.
static const char *const DRAWN[] = {"camera", "lights", "file"};

static bool moves_hair(const ParamInfo *info)
{
    for (size_t i = 0; i < sizeof HARMLESS / sizeof *HARMLESS; ++i)
        if (strcmp(info->name, HARMLESS[i]) == 0) return false;
    return info->group == GROUP_SIMULATION || info->group == GROUP_FORCES ||
           info->group == GROUP_COLLISION;
}

// Removes all values that do not move hair. `object`: a scene or a section.
static void keep_what_moves(json_t *object)
{
    const char *algo = json_string_value(json_object_get(object, "algo"));
    for (size_t i = 0; i < PARAM_COUNT; ++i)
        if (!moves_hair(&PARAM_TABLE[i]) || (algo && !params_owned_by(&PARAM_TABLE[i], algo)))
            json_object_del(object, PARAM_TABLE[i].name);
    for (size_t i = 0; i < sizeof DRAWN / sizeof *DRAWN; ++i) json_object_del(object, DRAWN[i]);
}

// Removes from a body and its sections what does not move hair. Without --collide-mesh the mesh
// does not, either.
static void keep_body(json_t *body)
{
    const json_t *sections = json_object_get(body, "sections");
    keep_what_moves(body);
    if (!json_object_get(body, "mesh_checksum"))
        json_object_set_new(body, "collide_mesh", json_false());
    for (size_t i = 0; i < json_array_size(sections); ++i)
        keep_what_moves(json_array_get(sections, i));
}

// The same for a scene, which is a body itself unless it lists bodies.
static void keep_values(json_t *scene)
{
    const json_t *bodies = json_object_get(scene, "bodies");
    if (!bodies) keep_body(scene);
    keep_what_moves(scene);
    for (size_t i = 0; i < json_array_size(bodies); ++i) keep_body(json_array_get(bodies, i));
}

// The properties of a deforming mesh that the motion of hair depends on.
static json_t *describe_shape(const Body *shape)
{
    const MeshSequence *sequence = &shape->sequence;
    const SampleTimes *times = &sequence->times;
    return json_pack("{s:I, s:I, s:f, s:f, s:b}", "checksum", (json_int_t)sequence->checksum,
                     "samples", (json_int_t)times->count, "fps", times->rate, "start", times->start,
                     "linear", times->linear);
}

// 17 digits: key times are doubles.
static char *write_text(const json_t *object)
{
    return json_text(object, JSON_COMPACT | JSON_SORT_KEYS | JSON_REAL_PRECISION(17));
}

Result cache_scene_describe(Bytes *text, const Simulation *simulation, Error *error)
{
    const Scene *scene = simulation->scene;
    json_t *object = scene_to_json(scene), *bodies = json_object_get(object, "bodies");
    for (uint32_t b = 0; b < scene->body_count; ++b) {
        json_t *body = bodies ? json_array_get(bodies, b) : object;
        uint32_t checksum = simulation->bodies[b].mesh_checksum;
        const Body *shape = scene->bodies[b].shape;
        if (checksum) json_object_set_new(body, "mesh_checksum", json_integer(checksum));
        if (shape) json_object_set_new(body, "body", describe_shape(shape));
    }
    keep_values(object);
    json_object_set_new(object, MAKER, json_string(cache_scene_own_maker()));
    if (scene->run.frame_number.value) // for programs that name frames; not compared
        json_object_set_new(object, NUMBER, json_integer(scene->run.frame_number.value));
    char *dump = write_text(object);
    json_decref(object);
    if (!dump) return error_set(error, RESULT_FAILED, "no memory for the scene's values");
    *text = (Bytes){.data = (uint8_t *)dump, .size = strlen(dump)};
    return RESULT_OK;
}

// The place where two values differ, such as "sections[1].style".
typedef struct Difference {
    char place[200];
    const json_t *a, *b; // NULL if the value is missing on that side
} Difference;

static bool find_difference(Difference *difference, const char *place, const json_t *a,
                            const json_t *b)
{
    if (json_equal((json_t *)a, (json_t *)b)) return false;
    snprintf(difference->place, sizeof difference->place, "%s", place);
    difference->a = a;
    difference->b = b;
    char inner[sizeof difference->place + 64];
    if (json_is_array(a) && json_is_array(b) && json_array_size(a) == json_array_size(b))
        for (size_t i = 0; i < json_array_size(a); ++i) {
            snprintf(inner, sizeof inner, "%s[%zu]", place, i);
            if (find_difference(difference, inner, json_array_get(a, i), json_array_get(b, i)))
                return true;
        }
    if (!json_is_object(a) || !json_is_object(b)) return true;
    for (int turn = 0; turn < 2; ++turn) { // first the keys of a, then the keys that only b has
        const char *key;
        json_t *value;
        json_object_foreach((json_t *)(turn ? b : a), key, value)
        {
            snprintf(inner, sizeof inner, "%s%s%s", place, *place ? "." : "", key);
            if (find_difference(difference, inner, json_object_get(a, key),
                                json_object_get(b, key)))
                return true;
        }
    }
    return true;
}

static void print_value(const json_t *value, char *text, size_t size)
{
    char *dump = json_text(value, JSON_COMPACT | JSON_ENCODE_ANY | JSON_REAL_PRECISION(9));
    snprintf(text, size, "%.60s", dump ? dump : "nothing");
    free(dump);
}

static Result refuse(const Difference *difference, const char *path, Error *error)
{
    char was[80], is[80];
    print_value(difference->a, was, sizeof was);
    print_value(difference->b, is, sizeof is);
    return error_set(error, RESULT_BAD_INPUT,
                     "%s: was simulated with %s %s, but this scene has %s: expected the same value",
                     path, difference->place, was, is);
}

// Reads a stored scene and compares it with `is`, which is freed; NULL: there was no memory for it.
// `forget`, if not NULL, removes from both what is not compared.
static Result compare(const Bytes *text, json_t *is, void (*forget)(json_t *scene),
                      const char *path, Error *error)
{
    Difference difference;
    json_t *was = json_read((const char *)text->data, text->size, 0, NULL);
    Result result = RESULT_OK;
    if (!is || (!was && json_memory_short())) {
        result = error_set(error, RESULT_FAILED, "%s: no memory to compare its scene", path);
    } else if (!was) {
        result = error_set(error, RESULT_BAD_INPUT,
                           "%s: the stored scene is damaged: expected a JSON object", path);
    } else {
        keep_values(was); // earlier versions also wrote the parameters of other solvers
        json_object_del(was, MAKER);
        json_object_del(is, MAKER);
        json_object_del(was, NUMBER);
        json_object_del(is, NUMBER);
        if (forget) {
            forget(was);
            forget(is);
        }
        if (find_difference(&difference, "", was, is)) result = refuse(&difference, path, error);
    }
    json_decref(is);
    json_decref(was);
    return result;
}

Result cache_scene_compare(const Bytes *text, const Simulation *simulation, const char *path,
                           Error *error)
{
    Bytes now = {0};
    TRY(cache_scene_describe(&now, simulation, error));
    // Parse the text again, so that both sides have the same JSON types for numbers.
    json_t *is = json_read((const char *)now.data, now.size, 0, NULL);
    bytes_destroy(&now);
    return compare(text, is, NULL, path, error);
}

static void forget_body_mesh(json_t *body)
{
    static const char *const keys[] = {"mesh_checksum", "body", "collide_mesh"};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; ++i) json_object_del(body, keys[i]);
}

static void forget_meshes(json_t *scene)
{
    const json_t *bodies = json_object_get(scene, "bodies");
    forget_body_mesh(scene);
    for (size_t i = 0; i < json_array_size(bodies); ++i)
        forget_body_mesh(json_array_get(bodies, i));
}

Result cache_scene_compare_values(const Bytes *text, const Scene *scene, const char *path,
                                  Error *error)
{
    json_t *object = scene_to_json(scene);
    keep_values(object);
    char *dump = write_text(object);
    json_decref(object);
    json_t *is = dump ? json_read(dump, strlen(dump), 0, NULL) : NULL;
    free(dump);
    return compare(text, is, forget_meshes, path, error);
}

// --- Hair.

static void put_u32(FILE *stream, uint32_t value)
{
    value = htole32(value);
    fwrite(&value, sizeof value, 1, stream);
}

// The CRC-32 of vertex counts and positions.
static uint32_t checksum(const Strands *strands)
{
    uint32_t crc = libdeflate_crc32(0, strands->first,
                                    ((size_t)strands->strand_count + 1) * sizeof *strands->first);
    return libdeflate_crc32(crc, strands->position,
                            (size_t)strands->vertex_count * sizeof *strands->position);
}

// Writes batches of equal vertex counts as one run, so the file does not depend on how many buffers
// a driver needs for them.
static void put_runs(FILE *stream, const Hair *hair)
{
    uint32_t runs = 0;
    for (uint32_t i = 0; i < hair->batch_count; ++i)
        runs += i == 0 || hair->batches[i].vertex_count != hair->batches[i - 1].vertex_count;
    put_u32(stream, runs);
    for (uint32_t i = 0; i < hair->batch_count;) {
        uint32_t n = hair->batches[i].vertex_count, count = 0;
        for (; i < hair->batch_count && hair->batches[i].vertex_count == n; ++i)
            count += hair->batches[i].strand_count;
        put_u32(stream, n);
        put_u32(stream, count);
    }
}

static void put_section(FILE *stream, const Hair *hair, const Strands *strands)
{
    put_u32(stream, hair->strand_count);
    put_u32(stream, checksum(strands));
    put_runs(stream, hair);
    for (uint32_t i = 0; i < hair->batch_count; ++i)
        for (uint32_t s = 0; s < hair->batches[i].strand_count; ++s)
            put_u32(stream, hair->batches[i].strand[s]);
}

// `ends`, if not NULL: the number of bytes up to the end of each section.
static Result describe_hair(Bytes *bytes, size_t *ends, const Simulation *simulation,
                            const Strands *strands, Error *error)
{
    char *data = NULL;
    *bytes = (Bytes){0};
    FILE *stream = open_memstream(&data, &bytes->size);
    if (stream) {
        put_u32(stream, simulation->scene->section_count);
        for (uint32_t i = 0; i < simulation->scene->section_count; ++i) {
            put_section(stream, &simulation->sections[i].hair, &strands[i]);
            if (ends) ends[i] = (size_t)ftell(stream);
        }
    }
    bool good = stream && fclose(stream) == 0;
    bytes->data = (uint8_t *)data;
    if (good) return RESULT_OK;
    bytes_destroy(bytes);
    return error_set(error, RESULT_FAILED, "no memory for the numbers of the strands");
}

Result cache_scene_describe_hair(Bytes *bytes, const Simulation *simulation, const Strands *strands,
                                 Error *error)
{
    return describe_hair(bytes, NULL, simulation, strands, error);
}

static Result refuse_hair(const Scene *scene, uint32_t section, const char *path, Error *error)
{
    return error_set(error, RESULT_BAD_INPUT,
                     "%s: was simulated with hair that differs from %s: expected the same hair",
                     path, scene->section_count ? scene->sections[section].file : "none");
}

// 0 behind the end.
static uint32_t take_u32(const Bytes *bytes, size_t *at)
{
    uint32_t value = 0;
    if (*at <= bytes->size && bytes->size - *at >= sizeof value)
        memcpy(&value, bytes->data + *at, sizeof value);
    *at += sizeof value;
    return le32toh(value);
}

Result cache_scene_compare_strands(const Bytes *bytes, const Scene *scene, const Strands *strands,
                                   const char *path, Error *error)
{
    size_t at = 0;
    if (take_u32(bytes, &at) != scene->section_count) return refuse_hair(scene, 0, path, error);
    for (uint32_t i = 0; i < scene->section_count; ++i) {
        uint32_t count = take_u32(bytes, &at), crc = take_u32(bytes, &at);
        uint32_t runs = take_u32(bytes, &at);
        if (count != strands[i].strand_count || crc != checksum(&strands[i]))
            return refuse_hair(scene, i, path, error);
        at += ((size_t)2 * runs + count) * sizeof count; // see put_runs and put_section
    }
    return RESULT_OK;
}

Result cache_scene_compare_hair(const Bytes *bytes, const Simulation *simulation,
                                const Strands *strands, const char *path, Error *error)
{
    uint32_t count = simulation->scene->section_count, i = 0;
    Bytes now = {0};
    size_t *ends = calloc((size_t)count + 1, sizeof *ends);
    if (!ends) return error_set(error, RESULT_FAILED, "no memory for %u sections", count);
    Result result = describe_hair(&now, ends, simulation, strands, error);
    if (result == RESULT_OK &&
        (bytes->size != now.size || memcmp(bytes->data, now.data, now.size) != 0)) {
        while (i + 1 < count && ends[i] <= bytes->size &&
               memcmp(bytes->data, now.data, ends[i]) == 0)
            ++i;
        result = refuse_hair(simulation->scene, i, path, error);
    }
    bytes_destroy(&now);
    free(ends);
    return result;
}
