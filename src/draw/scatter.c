// SPDX-License-Identifier: MIT
#include "draw/scatter.h"

#include <string.h>

ScatterOptions scatter_options(const RendererOptions *options)
{
    ScatterOptions asked = options->scatter;
    if (!asked.cells) asked.cells = 32;
    if (!asked.orders) asked.orders = 16;
    if (options->shadow.kind != SHADOW_DOM || options->aov != AOV_NONE) asked.off = true;
    asked.skin = options->mesh_shading == MESH_SKIN;
    return asked;
}

bool scatter_is_wanted(const ScatterOptions *options, const BackendFrame *frame)
{
    bool any = false;
    for (uint32_t i = 0; i < frame->hair_count; ++i)
        any |= (frame->hair[i].look->features & LOOK_MARSCHNER) != 0;
    return any && !options->off &&
           (options->kind != SCATTER_NONE || light_scene_has_sky(&frame->drawing->whole));
}

bool scatter_same_lights(const DrawParams *a, const DrawParams *b)
{
    return a->light_count == b->light_count &&
           memcmp(a->light_place, b->light_place, sizeof a->light_place) == 0 &&
           memcmp(a->light_color, b->light_color, sizeof a->light_color) == 0 &&
           memcmp(a->light_axis, b->light_axis, sizeof a->light_axis) == 0 &&
           memcmp(a->light_cone, b->light_cone, sizeof a->light_cone) == 0 &&
           memcmp(a->sky, b->sky, sizeof a->sky) == 0 &&
           memcmp(a->ground, b->ground, sizeof a->ground) == 0 &&
           memcmp(a->around, b->around, sizeof a->around) == 0;
}

uint32_t scatter_step(const ScatterOptions *options, const BackendFrame *frame)
{
    uint64_t all = 0;
    for (uint32_t i = 0; i < frame->hair_count; ++i) all += frame->hair[i].material.drawn_strands;
    return options->strands ? (uint32_t)(all / options->strands) : 1;
}

GridScene scatter_scene(const ScatterOptions *options, const BackendFrame *frame,
                        const ShadowParams *shadows)
{
    GridScene scene = {.draw = &frame->drawing->whole,
                       .ambient = frame->frame->ambient,
                       .cells = options->cells,
                       .step = scatter_step(options, frame),
                       .suns = options->kind == SCATTER_GRID,
                       .skin = options->kind == SCATTER_GRID && options->skin,
                       .orders = options->kind == SCATTER_NONE ? 0 : options->orders};
    for (int k = 0; k < 3; ++k) scene.to_eye[k] = frame->frame->view->view[k][2];
    for (int l = 0; l < MAX_LIGHTS; ++l) scene.map_of[l] = -1;
    for (int m = 0; m < shadows->maps; ++m) scene.map_of[(int)shadows->place[m][0]] = m;
    return scene;
}

LightMesh scatter_mesh(const BackendFrame *frame)
{
    const Mesh *mesh = &frame->mesh->mesh;
    LightMesh among = {.vertices = (const float(*)[3])mesh->position,
                       .triangles = (const uint32_t(*)[3])mesh->triangle,
                       .vertex_count = mesh->vertex_count,
                       .triangle_count = mesh->triangle_count};
    memcpy(among.rotation, frame->frame->head_rotation, sizeof among.rotation);
    memcpy(among.translation, frame->frame->head_translation, sizeof among.translation);
    return among;
}
