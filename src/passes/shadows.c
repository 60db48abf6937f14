// SPDX-License-Identifier: MIT
#include "passes/shadows.h"

#include "gpu/gpu_uniforms.h"

#include <string.h>

void shadows_create(Shadows *shadow, const GpuLimits *limits, const ShadowOptions *options)
{
    *shadow = (Shadows){.options = *options, .mesh_version = 1};
    shadow->options.side = (options->side + 7) / 8 * 8;
    hair_shadow_create(&shadow->hair, limits, options->kind == SHADOW_DOM, shadow->options.side);
}

void shadows_destroy(Shadows *shadow)
{
    hair_shadow_destroy(&shadow->hair);
    mesh_shadow_destroy(&shadow->mesh);
    *shadow = (Shadows){0};
}

Result shadows_reserve_mesh(Shadows *shadow, int maps, Error *error)
{
    return mesh_shadow_reserve(&shadow->mesh, maps, error);
}

void shadows_forget_mesh(Shadows *shadow)
{
    ++shadow->mesh_version;
}

static bool has_mesh(const ShadowScene *scene)
{
    return scene->mesh.mesh && scene->mesh.mesh->triangle_count > 0;
}

static ShadowMesh mesh_of(const Shadows *shadow, const ShadowScene *scene)
{
    ShadowMesh mesh;
    memset(&mesh, 0, sizeof mesh);
    if (!has_mesh(scene)) return mesh;
    mesh.version = shadow->mesh_version;
    memcpy(mesh.low, scene->mesh.mesh->low, sizeof mesh.low);
    memcpy(mesh.high, scene->mesh.mesh->high, sizeof mesh.high);
    memcpy(mesh.rotation, scene->mesh.rotation, sizeof mesh.rotation);
    memcpy(mesh.translation, scene->mesh.translation, sizeof mesh.translation);
    return mesh;
}

static void begin_frames(const Shadows *shadow, const ShadowScene *scene, ShadowFrames *frames)
{
    ShadowMesh mesh = mesh_of(shadow, scene);
    shadow_frames_begin(frames, scene->lights, scene->light_count, scene->middle, &mesh,
                        scene->revision);
    for (uint32_t i = 0; i < scene->casters.count; ++i) {
        const ShadowCaster *caster = &scene->casters.list[i];
        MaterialParams material = look_material(caster->look, caster->batch);
        shadow_frames_add(frames, caster->batch, &material, caster->batch->paint.buffer != 0);
    }
}

bool shadows_show(const Shadows *shadow, const ShadowScene *scene)
{
    ShadowFrames frames;
    begin_frames(shadow, scene, &frames);
    return shadow->any && shadow_frames_same(&frames, &shadow->drawn);
}

static Result draw_maps(Shadows *shadow, const ShadowScene *scene, ShadowFrames *frames,
                        Error *error)
{
    double boxes[SCENE_MAX_LIGHTS][6];
    int maps = frames->count ? frames->count : 1;
    if (has_mesh(scene)) TRY(shadows_reserve_mesh(shadow, maps, error));
    TRY(hair_shadow_begin(&shadow->hair, maps, scene->casters, error));
    hair_shadow_find_boxes(&shadow->hair, frames, scene->casters, boxes);
    shadow_frames_place(frames, shadow->options.side, shadow->options.spacing, boxes);
    for (int map = 0; map < frames->params.maps; ++map)
        hair_shadow_draw(&shadow->hair, frames, map, scene->casters);
    if (!has_mesh(scene) || !frames->params.maps) return RESULT_OK;
    gpu_uniforms_set(BIND_SHADOW, &frames->params, sizeof frames->params);
    mesh_shadow_draw(&shadow->mesh, frames, scene->mesh.mesh);
    return RESULT_OK;
}

Result shadows_draw(Shadows *shadow, const ShadowScene *scene, GpuTimer *timer, Error *error)
{
    ShadowFrames frames;
    begin_frames(shadow, scene, &frames);
    shadow->maps_drawn = 0;
    if (shadow->any && shadow_frames_same(&frames, &shadow->drawn)) return RESULT_OK;
    shadow->any = false;
    gpu_timer_begin(timer, "draw_shadow");
    Result result = draw_maps(shadow, scene, &frames, error);
    gpu_timer_end(timer);
    if (result != RESULT_OK) return result;
    memcpy(&shadow->drawn, &frames.key, sizeof frames.key);
    shadow->params = frames.params;
    shadow->maps_drawn = (uint32_t)frames.params.maps;
    ++shadow->version;
    shadow->any = true;
    return gpu_check("shadow maps", error);
}

void shadows_bind(Shadows *shadow)
{
    gpu_uniforms_set(BIND_SHADOW, &shadow->params, sizeof shadow->params);
    hair_shadow_bind(&shadow->hair);
    mesh_shadow_bind(&shadow->mesh);
}
