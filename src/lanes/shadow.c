// SPDX-License-Identifier: MIT
#include "lanes/shadow.h"

#include "base/room.h"

#include <stdlib.h>
#include <string.h>

Result lane_shadow_create(LaneShadow *shadow, const ShadowOptions *options, Error *error)
{
    *shadow = (LaneShadow){.options = *options};
    shadow->options.side = (options->side + 7) / 8 * 8;
    return shadow_map_create(&shadow->map, shadow->options.side, options->kind == SHADOW_DOM,
                             error);
}

static void free_maps(LaneShadow *shadow)
{
    free(shadow->depths);
    free(shadow->layers);
    shadow->depths = NULL, shadow->layers = NULL;
    shadow->room = 0;
}

void lane_shadow_destroy(LaneShadow *shadow)
{
    shadow_map_destroy(&shadow->map);
    shadow_mesh_destroy(&shadow->mesh);
    tile_order_destroy(&shadow->order);
    shadow_sample_destroy(&shadow->sample);
    free_maps(shadow);
    *shadow = (LaneShadow){0};
}

static Result make_room(LaneShadow *shadow, int maps, Error *error)
{
    size_t side = (size_t)shadow->options.side, words = shadow_map_layer_words(&shadow->map);
    if (shadow->room >= maps) return RESULT_OK;
    free_maps(shadow);
    shadow->depths = room_new((size_t)maps * side * side, sizeof *shadow->depths);
    if (shadow->map.deep) shadow->layers = room_new((size_t)maps * words, sizeof *shadow->layers);
    shadow->room = maps;
    if (shadow->depths && (shadow->layers || !shadow->map.deep)) return RESULT_OK;
    free_maps(shadow);
    return error_set(error, RESULT_FAILED, "no memory for %d shadow maps of %zu texels", maps,
                     side);
}

static void begin_frames(ShadowFrames *frames, const LaneShadowScene *scene)
{
    ShadowMesh mesh;
    memset(&mesh, 0, sizeof mesh);
    if (scene->mesh && scene->mesh->triangle_count) {
        mesh.version = scene->mesh_version;
        memcpy(mesh.low, scene->mesh_low, sizeof mesh.low);
        memcpy(mesh.high, scene->mesh_high, sizeof mesh.high);
        memcpy(mesh.rotation, scene->mesh->rotation, sizeof mesh.rotation);
        memcpy(mesh.translation, scene->mesh->translation, sizeof mesh.translation);
    }
    shadow_frames_begin(frames, scene->lights, scene->light_count, scene->middle, &mesh,
                        scene->revision);
    for (uint32_t i = 0; i < scene->casters.count; ++i) {
        const MappedCaster *caster = &scene->casters.list[i];
        shadow_frames_add(frames, caster->position, &caster->material, caster->paint != NULL);
    }
}

static Result draw_maps(LaneShadow *shadow, const LaneShadowScene *scene, ShadowFrames *frames,
                        Error *error)
{
    MappedCasters casters;
    CastParams params[MAX_LIGHTS];
    double boxes[MAX_LIGHTS][6];
    for (int i = 0; i < frames->count; ++i) params[i] = shadow_frames_box(frames, i);
    shadow_map_find_boxes(&shadow->map, params, frames->count, scene->casters, boxes);
    shadow_frames_place(frames, shadow->options.side, shadow->options.spacing, boxes);
    TRY(make_room(shadow, frames->params.maps, error));
    TRY(shadow_sample_take(&shadow->sample, scene->casters, shadow->options.strands,
                           shadow->map.parts, &casters, error));
    TRY(shadow_map_reserve(&shadow->map, frames->params.maps, casters, error));
    tile_order_find(&shadow->order, shadow->sample.casters, casters.count);
    shadow_map_draw(&shadow->map, frames->casts, frames->params.maps, casters, shadow->depths,
                    shadow->layers);
    shadow->by_mesh = frames->key.mesh.version && frames->params.maps;
    return shadow->by_mesh
               ? shadow_mesh_draw(&shadow->mesh, frames, scene->mesh, shadow->map.parts, error)
               : RESULT_OK;
}

static void set_lights(LaneShadow *shadow)
{
    for (int i = 0; i < MAX_LIGHTS; ++i) shadow->map_of[i] = -1;
    for (int map = 0; map < shadow->params.maps; ++map) {
        int number = (int)shadow->params.place[map][0];
        const Light *light = &shadow->drawn.lights[number];
        bool lamp = light->kind != LIGHT_DIRECTIONAL;
        shadow->map_of[number] = map;
        memcpy(shadow->light_place[map], lamp ? light->position : light->direction,
               3 * sizeof(float));
        shadow->light_place[map][3] = lamp;
    }
}

Result lane_shadow_draw(LaneShadow *shadow, const LaneShadowScene *scene, Error *error)
{
    ShadowFrames frames;
    begin_frames(&frames, scene);
    shadow->maps_drawn = 0;
    if (shadow->any && shadow_frames_same(&frames, &shadow->drawn)) return RESULT_OK;
    shadow->any = false;
    TRY(draw_maps(shadow, scene, &frames, error));
    memcpy(&shadow->drawn, &frames.key, sizeof frames.key);
    shadow->params = frames.params;
    shadow->maps_drawn = frames.params.maps;
    ++shadow->version;
    shadow->any = true;
    set_lights(shadow);
    return RESULT_OK;
}
