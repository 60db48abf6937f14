// SPDX-License-Identifier: MIT
#include "draw/render_shadow.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double LEAST_LEFT = 1e-3; // of the light behind one fibre

Result render_shadow_create(RenderShadow *shadow, const GpuLimits *limits,
                            const ShadowOptions *options, bool by_processor, Error *error)
{
    *shadow = (RenderShadow){.options = *options};
    shadow->options.side = (options->side + 7) / 8 * 8;
    return render_shadow_hair_create(&shadow->hair, limits, options->kind == SHADOW_DOM,
                                     shadow->options.side, by_processor, error);
}

void render_shadow_destroy(RenderShadow *shadow)
{
    render_shadow_hair_destroy(&shadow->hair);
    render_shadow_mesh_destroy(&shadow->mesh);
    free(shadow->casters);
    gpu_buffer_destroy(&shadow->uniforms);
    *shadow = (RenderShadow){0};
}

static bool casts(const Light *light)
{
    return light->shadow && light->intensity > 0;
}

static bool has_mesh(const ShadowScene *scene)
{
    return scene->mesh.mesh && scene->mesh.mesh->triangle_count > 0;
}

// What approximated maps take for the mean fibre.
static void find_mean_fibre(const RenderShadow *shadow, const ShadowScene *scene,
                            ShadowParams *params)
{
    double radius = 0, opacity = 0, weight = 0;
    for (uint32_t i = 0; i < scene->casters.count; ++i) {
        const ShadowCaster *caster = &scene->casters.list[i];
        double share = (double)caster->batch->strand_count * caster->batch->vertex_count;
        radius += share * (double)caster->look.material.radius;
        opacity += share * (double)caster->look.material.shadow_opacity;
        weight += share;
    }
    if (weight == 0) weight = 1, radius = 1;
    params->fibres = (float)(weight / (radius * (double)shadow->options.spacing));
    params->passed = (float)log2(fmax(1 - opacity / weight, LEAST_LEFT));
}

static void set_rows(mat4 matrix, const LightFrame *frame)
{
    for (int k = 0; k < 4; ++k)
        for (int i = 0; i < 4; ++i) matrix[k][i] = (float)frame->rows[k][i];
}

static void set_hair_frame(ShadowParams *params, int map, int light, const LightView *view,
                           const LightFrame *frame)
{
    set_rows(params->from_world[map], frame);
    params->place[map][0] = (float)light;
    params->place[map][1] = (float)(frame->depth[1] - frame->depth[0]);
    params->place[map][3] = render_shadow_hair_scale(view, frame);
}

static void set_mesh_frame(ShadowParams *params, int map, const ShadowMeshFrame *mesh)
{
    set_rows(params->mesh_from_world[map], &mesh->frame);
    params->place[map][2] = (float)mesh->depth_shift;
    params->mesh_lift = fmaxf(params->mesh_lift, (float)mesh->lift);
}

// The next map, of light `light`; none if nothing is in its sight.
static void draw_map(RenderShadow *shadow, const ShadowScene *scene, int light)
{
    LightView view = light_view(&scene->lights[light], scene->middle);
    ShadowParams *params = &shadow->params;
    int map = params->maps;
    double box[6];
    bool by_mesh = has_mesh(scene);
    if (!render_shadow_hair_find_box(&shadow->hair, &view, scene->casters, box)) {
        if (!by_mesh) return;
        for (int k = 0; k < 3; ++k) box[k] = LIGHT_FRAME_FAR, box[k + 3] = -LIGHT_FRAME_FAR;
        shadow_mesh_add_box(&scene->mesh, &view, box);
    }
    LightFrame frame = render_shadow_hair_frame(&shadow->hair, &view, box);
    set_hair_frame(params, map, light, &view, &frame);
    render_shadow_hair_draw(&shadow->hair, &view, &frame, map, scene->casters);
    if (by_mesh) {
        shadow_mesh_add_box(&scene->mesh, &view, box);
        ShadowMeshFrame mesh = shadow_mesh_frame(&view, box);
        set_mesh_frame(params, map, &mesh);
        gpu_buffer_set_uniforms(&shadow->uniforms, BIND_SHADOW, params, sizeof *params);
        render_shadow_mesh_draw(&shadow->mesh, scene->mesh.mesh, map);
    }
    ++params->maps;
}

static bool same_ribbons(const ShadowCaster *a, const ShadowCaster *b)
{
    const MaterialParams *p = &a->look.material, *q = &b->look.material;
    return a->batch == b->batch && a->look.share == b->look.share &&
           a->look.features == b->look.features && p->radius == q->radius &&
           p->tip_ratio == q->tip_ratio && p->shadow_opacity == q->shadow_opacity &&
           p->smooth_parts == q->smooth_parts && p->smooth_curve == q->smooth_curve;
}

static bool same_casters(const RenderShadow *shadow, ShadowCasters casters)
{
    bool same = casters.count == shadow->drawn.casters.count;
    for (uint32_t i = 0; i < casters.count && same; ++i)
        same = same_ribbons(&casters.list[i], &shadow->casters[i]);
    return same;
}

static bool is_drawn(const RenderShadow *shadow, const ShadowScene *scene)
{
    const ShadowScene *drawn = &shadow->drawn;
    return shadow->any && scene->revision && scene->revision == drawn->revision &&
           scene->light_count == drawn->light_count && scene->mesh.mesh == drawn->mesh.mesh &&
           memcmp(scene->mesh.rotation, drawn->mesh.rotation, sizeof drawn->mesh.rotation) == 0 &&
           memcmp(scene->mesh.translation, drawn->mesh.translation,
                  sizeof drawn->mesh.translation) == 0 &&
           memcmp(scene->lights, shadow->lights, scene->light_count * sizeof(Light)) == 0 &&
           same_casters(shadow, scene->casters);
}

static int count_maps(const ShadowScene *scene)
{
    int maps = 0;
    for (uint32_t i = 0; i < scene->light_count; ++i) maps += casts(&scene->lights[i]);
    return maps ? maps : 1;
}

static Result reserve(RenderShadow *shadow, const ShadowScene *scene, Error *error)
{
    shadow->any = false;
    ShadowCasters casters = scene->casters;
    if (casters.count > shadow->caster_room) {
        ShadowCaster *room = realloc(shadow->casters, casters.count * sizeof *room);
        if (!room)
            return error_set(error, RESULT_FAILED, "no memory for %u batches", casters.count);
        shadow->casters = room;
        shadow->caster_room = casters.count;
    }
    return has_mesh(scene) ? render_shadow_mesh_reserve(&shadow->mesh, count_maps(scene), error)
                           : RESULT_OK;
}

static Result draw_maps(RenderShadow *shadow, const ShadowScene *scene, Error *error)
{
    ShadowParams *params = &shadow->params;
    memset(params, 0, sizeof *params);
    params->side = shadow->options.side;
    params->mesh_side = SHADOW_MESH_SIDE;
    find_mean_fibre(shadow, scene, params);
    Result result =
        render_shadow_hair_begin(&shadow->hair, count_maps(scene), scene->casters, error);
    if (result != RESULT_OK) return result;
    for (uint32_t i = 0; i < scene->light_count; ++i)
        if (casts(&scene->lights[i])) draw_map(shadow, scene, (int)i);
    render_shadow_hair_end(&shadow->hair);
    shadow->maps_drawn = (uint32_t)params->maps;
    ++shadow->version;
    return result;
}

Result render_shadow_draw(RenderShadow *shadow, const ShadowScene *scene, GpuTimer *timer,
                          Error *error)
{
    shadow->maps_drawn = 0;
    if (is_drawn(shadow, scene)) return RESULT_OK;
    Result result = reserve(shadow, scene, error);
    if (result != RESULT_OK) return result;
    gpu_timer_begin(timer, "draw_shadow");
    result = draw_maps(shadow, scene, error);
    gpu_timer_end(timer);
    if (result != RESULT_OK) return result;
    shadow->drawn = *scene;
    memcpy(shadow->lights, scene->lights, scene->light_count * sizeof(Light));
    if (scene->casters.count)
        memcpy(shadow->casters, scene->casters.list,
               scene->casters.count * sizeof *shadow->casters);
    shadow->any = true;
    return gpu_check("shadow maps", error);
}

void render_shadow_bind(RenderShadow *shadow)
{
    gpu_buffer_set_uniforms(&shadow->uniforms, BIND_SHADOW, &shadow->params, sizeof shadow->params);
    render_shadow_hair_bind(&shadow->hair);
    glActiveTexture(GL_TEXTURE0 + BIND_SHADOW_MESH);
    glBindTexture(GL_TEXTURE_2D, shadow->mesh.depth);
}
