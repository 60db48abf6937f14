// SPDX-License-Identifier: MIT
#include "run/fingerprint.h"
#include "base/bytes.h"
#include "run/caption.h"
#include "scene/camera.h"
#include "scene/floor.h"

#include "version.h"

#include <inttypes.h>
#include <libdeflate.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const FingerprintExempt FINGERPRINT_EXEMPT[] = {
    {"strict", "a file that is read is read alike"},
    {"check", "draws nothing"},
    {"unit", "the hair as it was read counts"},
    {"up", "the hair as it was read counts"},
    {"points_per_strand", "the hair as it was read counts"},
    {"array", "the hair as it was read counts"},
    {"group", "the hair as it was read counts"},
    {"object", "the hair as it was read counts"},
    {"hair_frame", "the hair as it was read counts"},
    {"mesh_object", "the mesh as it was read counts"},
    {"frame_number", "the names of the files; captions have it"},
    {"mesh", "its content counts"},
    {"mesh_rest", "the hair that it carries counts"},
    {"mesh_unit", "the mesh as it was read counts"},
    {"mesh_up", "the mesh as it was read counts"},
    {"color_map", "its content counts"},
    {"environment", "its content counts"},
    {"output", "where images go"},
    {"first", "which frames are drawn"},
    {"last", "which frames are drawn"},
    {"every", "which frames are drawn"},
    {"part", "which frames are drawn"},
    {"contact_sheet", "a sheet is always drawn whole"},
    {"cache", "where the simulation goes"},
    {"from_cache", "a cache is of the same scene or refused; who made it counts"},
    {"export", "where hair goes"},
    {"export_followers", "counts for hair files alone"},
    {"resume", "which frames are drawn"},
    {"allow_paths", "where files go"},
    {"stats", "where statistics go"},
    {"quiet", "what is printed"},
    {"verbose", "what is printed"},
    {"sdf_cache", "what is computed again"},
    {"frames", "camera and lights of each frame count"},
    {"exposure", "the exposure that is drawn with counts"},
    {"backend", "the renderer's name counts"},
    {"device", "the renderer's name counts"},
    {"list_devices", "draws nothing"},
    {"platform", "draws nothing"},
    {"software", "the renderer's name counts"},
    {"require_hardware", "the renderer's name counts"},
};
const size_t FINGERPRINT_EXEMPT_COUNT = sizeof FINGERPRINT_EXEMPT / sizeof *FINGERPRINT_EXEMPT;

const char *const FINGERPRINT_ORIGIN[FINGERPRINT_ORIGIN_COUNT] = {"Software", "Renderer", "Driver"};

// --- The hash: 64-bit FNV-1a (Fowler, Noll, Vo) of all values. For arrays it takes their size and
// CRC-32.

static const uint64_t FNV_START = 0xcbf29ce484222325, FNV_PRIME = 0x100000001b3;

static uint64_t add(uint64_t hash, const void *data, size_t size)
{
    const uint8_t *bytes = data;
    for (size_t i = 0; i < size; ++i) hash = (hash ^ bytes[i]) * FNV_PRIME;
    return hash;
}

static uint64_t add_number(uint64_t hash, uint64_t number)
{
    return add(hash, &number, sizeof number);
}

static uint64_t add_text(uint64_t hash, const char *text)
{
    return add(hash, text, strlen(text) + 1);
}

// A missing array (NULL) hashes differently from an empty array.
static uint64_t add_array(uint64_t hash, const void *data, size_t size)
{
    hash = add_number(hash, data ? size : UINT64_MAX);
    return data ? add_number(hash, libdeflate_crc32(0, data, size)) : hash;
}

// --- The hashed values.

// Removes exempt values from a scene, body or section, and from the sections in it.
static void remove_exempt(json_t *object)
{
    for (size_t i = 0; i < FINGERPRINT_EXEMPT_COUNT; ++i)
        json_object_del(object, FINGERPRINT_EXEMPT[i].name);
    json_object_del(object, "file"); // the content of the file is hashed, not its name
    json_t *sections = json_object_get(object, "sections");
    for (size_t i = 0; i < json_array_size(sections); ++i)
        remove_exempt(json_array_get(sections, i));
}

static Result add_values(uint64_t *hash, const Scene *scene, Error *error)
{
    json_t *object = scene_to_json(scene), *bodies = json_object_get(object, "bodies");
    remove_exempt(object);
    for (size_t i = 0; i < json_array_size(bodies); ++i) remove_exempt(json_array_get(bodies, i));
    char *text = json_text(object, JSON_COMPACT | JSON_SORT_KEYS | JSON_REAL_PRECISION(17));
    if (text) *hash = add_text(*hash, text);
    Result result =
        text ? RESULT_OK : error_set(error, RESULT_FAILED, "no memory for the scene's values");
    free(text);
    json_decref(object);
    return result;
}

static uint64_t add_strands(uint64_t hash, const Strands *strands)
{
    size_t n = strands->strand_count, vertices = strands->vertex_count;
    hash = add_array(hash, strands->first, (n + 1) * sizeof *strands->first);
    hash = add_array(hash, strands->position, vertices * sizeof *strands->position);
#define OF_VERTICES(member, ...)                                                                   \
    hash = add_array(hash, strands->member, vertices * sizeof *strands->member);
#define OF_STRANDS(member, ...)                                                                    \
    hash = add_array(hash, strands->member, n * sizeof *strands->member);
    STRANDS_ARRAYS_OF_VERTICES(OF_VERTICES)
    STRANDS_ARRAYS_OF_STRANDS(OF_STRANDS)
#undef OF_VERTICES
#undef OF_STRANDS
    hash = add_number(hash, strands->followers);
    hash = add(hash, &strands->follower_radius, sizeof strands->follower_radius);
    return add_number(hash, strands->both_ends_fixed);
}

static uint64_t add_mesh(uint64_t hash, const Mesh *mesh)
{
    size_t triangles = mesh->triangle_count;
    hash = add_array(hash, mesh->position, mesh->vertex_count * sizeof *mesh->position);
    hash = add_array(hash, mesh->triangle, triangles * sizeof *mesh->triangle);
    hash = add_array(hash, mesh->uv, mesh->uv_count * sizeof *mesh->uv);
    return add_array(hash, mesh->triangle_uv, triangles * sizeof *mesh->triangle_uv);
}

static Result add_map(uint64_t *hash, const char *path, Error *error)
{
    Bytes file = {0};
    if (*path) TRY(bytes_read_file(&file, path, error));
    *hash = add_array(*hash, file.data, file.size);
    bytes_destroy(&file);
    return RESULT_OK;
}

static Result add_files(uint64_t *hash, const Scene *scene, const Assets *assets, Error *error)
{
    for (uint32_t i = 0; i < scene->section_count; ++i) {
        const StrandsFrames *frames = scene->sections[i].frames;
        *hash = add_strands(*hash, &assets->strands[i]);
        if (frames)
            *hash = add_array(*hash, frames->position,
                              (size_t)frames->count * frames->vertices * sizeof *frames->position);
        TRY(add_map(hash, scene->sections[i].params.color_map, error));
    }
    if (assets->environment.parts)
        *hash = add_array(*hash, assets->environment.parts,
                          ENVIRONMENT_PARTS * sizeof *assets->environment.parts);
    if (assets->environment.image.pixels)
        *hash = add_array(*hash, assets->environment.image.pixels,
                          image_size(&assets->environment.image));
    for (uint32_t b = 0; b < scene->body_count; ++b) {
        *hash = add_mesh(*hash, &assets->meshes[b]);
        if (scene->bodies[b].shape)
            *hash = add_number(*hash, scene->bodies[b].shape->sequence.checksum);
    }
    return RESULT_OK;
}

// --- The program and device that draw. Images of CPU drivers depend on the processor, too.

static Result describe_origin(ImageTexts *texts, const Gpu *gpu, Error *error)
{
    TRY(image_texts_set(texts, "Software", "tractrix " TRACTRIX_VERSION, error));
    TRY(image_texts_set(texts, "Renderer", gpu->renderer, error));
    TRY(image_texts_set(texts, "Driver", gpu->version, error));
    return gpu->software ? image_texts_set(texts, "CPU", gpu->processor, error) : RESULT_OK;
}

// --- The fingerprint.

Result fingerprint_create(Fingerprint *fingerprint, const Scene *scene, const Assets *assets,
                          const Framing *framing, float exposure, const Gpu *gpu, const char *maker,
                          Error *error)
{
    *fingerprint = (Fingerprint){.scene = scene, .framing = framing, .hair = FNV_START};
    TRY(describe_origin(&fingerprint->origin, gpu, error));
    TRY(add_values(&fingerprint->hair, scene, error));
    TRY(add_files(&fingerprint->hair, scene, assets, error));
    if (maker) fingerprint->hair = add_text(fingerprint->hair, maker);
    for (size_t i = 0; i < FINGERPRINT_ORIGIN_COUNT; ++i)
        fingerprint->hair = add_text(fingerprint->hair,
                                     image_texts_find(&fingerprint->origin, FINGERPRINT_ORIGIN[i]));
    Floor floor = floor_find(scene, framing);
    fingerprint->image = add(fingerprint->hair, &exposure, sizeof exposure);
    if (floor.kind != FLOOR_NONE) {
        fingerprint->image = add(fingerprint->image, floor.middle, sizeof floor.middle);
        fingerprint->image = add(fingerprint->image, &floor.whole, sizeof floor.whole);
        fingerprint->image = add(fingerprint->image, &floor.faded, sizeof floor.faded);
    }
    return RESULT_OK;
}

Result fingerprint_of_scene(uint64_t *hash, const Scene *scene, const Assets *assets,
                            const Framing *framing, Error *error)
{
    *hash = FNV_START;
    TRY(add_values(hash, scene, error));
    TRY(add_files(hash, scene, assets, error));
    *hash = add(*hash, &framing->hair, sizeof framing->hair);
    *hash = add(*hash, &framing->all, sizeof framing->all);
    *hash = add(*hash, framing->target, sizeof framing->target);
    *hash = add(*hash, framing->eye, sizeof framing->eye);
    return RESULT_OK;
}

void fingerprint_destroy(Fingerprint *fingerprint)
{
    image_texts_destroy(&fingerprint->origin);
    *fingerprint = (Fingerprint){0};
}

static void write(char text[FINGERPRINT_BYTES], uint64_t hash)
{
    snprintf(text, FINGERPRINT_BYTES, "%016" PRIx64, hash);
}

static uint64_t add_view(uint64_t hash, const View *view)
{
    hash = add(hash, view->view, sizeof view->view);
    hash = add(hash, view->projection, sizeof view->projection);
    hash = add(hash, &view->near_distance, sizeof view->near_distance);
    return add(hash, &view->far_distance, sizeof view->far_distance);
}

static uint64_t add_light(uint64_t hash, const Light *light)
{
    hash = add_number(hash, (uint64_t)light->kind);
    hash = add(hash, light->direction, sizeof light->direction);
    return add(hash, light->position,
               sizeof light->position); // the other members are hashed with the scene's values
}

void fingerprint_of_image(char text[FINGERPRINT_BYTES], const Fingerprint *fingerprint, int frame)
{
    const Scene *scene = fingerprint->scene;
    View view;
    Light lights[SCENE_MAX_LIGHTS];
    char caption[CAPTION_BYTES];
    uint64_t hash = add_number(fingerprint->image, (uint64_t)frame);
    camera_view(&view, scene, fingerprint->framing, frame);
    hash = add_view(hash, &view);
    if (scene->run.aov == AOV_DEPTH) {
        float range[2];
        camera_depth_range(range, scene, fingerprint->framing);
        hash = add(hash, range, sizeof range);
    }
    camera_lights(lights, scene, fingerprint->framing, frame);
    for (uint32_t i = 0; i < scene->light_count; ++i) hash = add_light(hash, &lights[i]);
    if (scene->run.turn_lights) {
        const EnvironmentAxes axes = camera_environment(scene, frame);
        hash = add(hash, &axes, sizeof axes);
    }
    caption_write(caption, scene, frame);
    write(text, add_text(hash, caption));
}

void fingerprint_of_hair(char text[FINGERPRINT_BYTES], const Fingerprint *fingerprint, int frame)
{
    uint64_t hash = add_number(fingerprint->hair, (uint64_t)frame);
    write(text, add_number(hash, fingerprint->scene->run.export_followers));
}
