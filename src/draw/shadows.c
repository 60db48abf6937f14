// SPDX-License-Identifier: MIT
#include "draw/shadows.h"

#include "gpu/gpu_uniforms.h"

#include <cglm/cglm.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

// --- The maps of the mesh.

enum {
    MESH_SIDE = 1024, // texels of a map
    MARGIN = 6,       // at its edges stay empty: all that a point beside it looks at
};

// A map's square, and how a point is moved before it looks at the map.
typedef struct MeshFrame {
    LightFrame frame;
    double depth_shift; // of the map's depths
    double lift;        // m, along the normal of the mesh
} MeshFrame;

static void destroy_mesh(MeshShadow *shadow)
{
    if (shadow->program) glDeleteProgram(shadow->program);
    if (shadow->depth) glDeleteTextures(1, &shadow->depth);
    if (shadow->frame) glDeleteFramebuffers(1, &shadow->frame);
    gpu_buffer_destroy(&shadow->texels);
    *shadow = (MeshShadow){0};
}

Result shadows_reserve_mesh(Shadows *shadows, int maps, Error *error)
{
    MeshShadow *shadow = &shadows->mesh;
    if (shadow->maps >= maps) return RESULT_OK;
    destroy_mesh(shadow);
    glGenTextures(1, &shadow->depth);
    glBindTexture(GL_TEXTURE_2D, shadow->depth);
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_DEPTH_COMPONENT32F, MESH_SIDE, MESH_SIDE * maps);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glGenFramebuffers(1, &shadow->frame);
    glBindFramebuffer(GL_FRAMEBUFFER, shadow->frame);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, shadow->depth, 0);
    glDrawBuffer(GL_NONE);
    Result result = shader_build_draw(&shadow->program, "draw/shadow_mesh.vert", "draw/depth.frag",
                                      NULL, error);
    THEN(result, gpu_check("the mesh's shadow map", error));
    if (shadows->with_texels)
        THEN(result, gpu_buffer_create(&shadow->texels, shadows->hair.limits, "the mesh's shadows",
                                       (int64_t)sizeof(float) * MESH_SIDE * MESH_SIDE * maps, NULL,
                                       GL_R32F, error));
    shadow->maps = maps;
    if (result != RESULT_OK) destroy_mesh(shadow);
    return result;
}

// Widens the box (see light_frame.h) to the mesh's.
static void add_mesh_box(const ShadowMesh *mesh, const LightView *view, double box[6])
{
    for (int corner = 0; corner < 8; ++corner) {
        vec3 x;
        versor turn = {0};
        double world[3], place[3];
        memcpy(turn, mesh->rotation, sizeof turn);
        for (int k = 0; k < 3; ++k)
            x[k] = (corner >> k & 1 ? mesh->mesh->high : mesh->mesh->low)[k];
        glm_quat_rotatev(turn, x, x);
        for (int k = 0; k < 3; ++k) world[k] = (double)(x[k] + mesh->translation[k]);
        if (!light_frame_place(view, world, place)) continue;
        for (int k = 0; k < 3; ++k) {
            double bound = k < 2 && view->perspective ? LIGHT_FRAME_WIDE : LIGHT_FRAME_FAR;
            double value = fmin(fmax(place[k], -bound), bound);
            box[k] = fmin(box[k], value);
            box[k + 3] = fmax(box[k + 3], value);
        }
    }
}

// A texel's depth is that of its middle: on a surface that the light meets at 45 degrees it is off
// by a texel. Two of them by depth, and as much as a texel and a half along the normal. Before a
// lamp a texel is as wide as half-way, and its depth as steep as at the far end: less elsewhere.
static MeshFrame frame_mesh(const LightView *view, const double box[6])
{
    MeshFrame mesh = {.frame = light_frame_drawn(view, box, MESH_SIDE, MARGIN)};
    double near = mesh.frame.depth[0], far = mesh.frame.depth[1], texel = mesh.frame.texel;
    if (view->perspective) {
        texel *= 0.5 * (near + far);
        mesh.depth_shift = 2 * texel * near / (far * (far - near));
    } else {
        mesh.depth_shift = 2 * texel / (far - near);
    }
    mesh.lift = 1.5 * texel;
    return mesh;
}

// Draws all maps, of which the ShadowParams block tells the frames.
static void draw_mesh(const MeshShadow *shadow, const RenderMesh *mesh, int maps)
{
    const float farthest = 1;
    glBindFramebuffer(GL_FRAMEBUFFER, shadow->frame);
    glDisable(GL_SCISSOR_TEST);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glClearBufferfv(GL_DEPTH, 0, &farthest);
    glUseProgram(shadow->program);
    glBindVertexArray(mesh->vertex_array);
    for (int map = 0; map < maps; ++map) {
        glViewport(0, map * MESH_SIDE, MESH_SIDE, MESH_SIDE);
        glUniform1i(1, map);
        glDrawElements(GL_TRIANGLES, (GLsizei)(3 * mesh->triangle_count), GL_UNSIGNED_INT, NULL);
    }
    glDisable(GL_DEPTH_TEST);
}

// For those that do not read textures.
static void copy_texels(const MeshShadow *shadow, int maps)
{
    if (!shadow->texels.buffer) return;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, shadow->frame);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, shadow->texels.buffer);
    glReadPixels(0, 0, MESH_SIDE, MESH_SIDE * maps, GL_DEPTH_COMPONENT, GL_FLOAT, NULL);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
}

static bool mesh_is_shown(const MeshShadow *shadow, const ShadowMesh *mesh,
                          const ShadowParams *params)
{
    const ShadowMesh *shown = &shadow->shown;
    return shown->mesh == mesh->mesh && shadow->shown_maps == params->maps &&
           memcmp(shown->rotation, mesh->rotation, sizeof shown->rotation) == 0 &&
           memcmp(shown->translation, mesh->translation, sizeof shown->translation) == 0 &&
           memcmp(shadow->frames, params->mesh_from_world, sizeof shadow->frames) == 0;
}

// Makes the mesh's maps, unless they show it: where the head stands still and hair alone moves. C
// reads them where it finds the light on hair, else shaders.
static Result draw_mesh_maps(Shadows *shadows, const ShadowMesh *mesh, Error *error)
{
    MeshShadow *shadow = &shadows->mesh;
    const ShadowParams *params = &shadows->params;
    bool fresh = !mesh_is_shown(shadow, mesh, params);
    if (fresh) {
        gpu_uniforms_set(BIND_SHADOW, params, sizeof *params);
        draw_mesh(shadow, mesh->mesh, params->maps);
        copy_texels(shadow, params->maps);
        shadow->shown = *mesh;
        shadow->shown_maps = params->maps;
        memcpy(shadow->frames, params->mesh_from_world, sizeof shadow->frames);
    }
    return shadows->hair.by_processor && shadows->hair.cpu.past_mesh
               ? hair_shadow_cpu_pass_mesh(&shadows->hair.cpu, params, &shadow->texels, fresh,
                                           error)
               : RESULT_OK;
}

void shadows_forget_mesh(Shadows *shadows)
{
    shadows->mesh.shown.mesh = NULL;
}

// --- All maps.

Result shadows_create(Shadows *shadow, const GpuLimits *limits, const ShadowOptions *options,
                      bool by_processor, Error *error)
{
    *shadow = (Shadows){.options = *options};
    shadow->options.side = (options->side + 7) / 8 * 8;
    Result result = hair_shadow_create(&shadow->hair, limits, options->kind == SHADOW_DOM,
                                       shadow->options.side, by_processor, options->behind, error);
    shadow->hair.cpu.copies = options->copies;
    return result;
}

void shadows_destroy(Shadows *shadow)
{
    hair_shadow_destroy(&shadow->hair);
    destroy_mesh(&shadow->mesh);
    free(shadow->casters);
    *shadow = (Shadows){0};
}

static bool casts(const Light *light)
{
    return light->shadow && light->intensity > 0;
}

static bool has_mesh(const ShadowScene *scene)
{
    return scene->mesh.mesh && scene->mesh.mesh->triangle_count > 0;
}

// What approximated maps take for the mean fibre, which lets a little through.
static void find_mean_fibre(const Shadows *shadow, const ShadowScene *scene, ShadowParams *params)
{
    const double least_left = 1e-3;
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
    params->passed = (float)log2(fmax(1 - opacity / weight, least_left));
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
    params->place[map][3] = hair_shadow_scale(view, frame);
}

static void set_mesh_frame(ShadowParams *params, int map, const MeshFrame *mesh)
{
    set_rows(params->mesh_from_world[map], &mesh->frame);
    params->place[map][2] = (float)mesh->depth_shift;
    params->mesh_lift = fmaxf(params->mesh_lift, (float)mesh->lift);
}

static void empty_box(double box[6])
{
    for (int k = 0; k < 3; ++k) box[k] = LIGHT_FRAME_FAR, box[k + 3] = -LIGHT_FRAME_FAR;
}

// The mesh's window: around the mesh alone, so that it stays while the head does; what lies beside
// or behind it has no mesh before it. At least a tenth as deep as wide, since depths of a mesh that
// is flat before the light would be nothing but rounding. Before a lamp, which may stand in the
// mesh's box, around hair as well.
static void frame_mesh_map(ShadowParams *params, int map, const ShadowMesh *mesh,
                           const LightView *view, double box[6])
{
    if (!view->perspective) empty_box(box);
    add_mesh_box(mesh, view, box);
    if (!view->perspective)
        box[5] = fmax(box[5], box[2] + 0.1 * fmax(box[3] - box[0], box[4] - box[1]));
    MeshFrame frame = frame_mesh(view, box);
    set_mesh_frame(params, map, &frame);
}

// The next map, of light `light` and of hair in `box`; none if nothing is in its sight.
static void draw_map(Shadows *shadow, const ShadowScene *scene, int light, const LightView *view,
                     double box[6])
{
    ShadowParams *params = &shadow->params;
    int map = params->maps;
    if (!(box[0] <= box[3])) {
        if (!has_mesh(scene)) return;
        empty_box(box);
        add_mesh_box(&scene->mesh, view, box);
    }
    LightFrame frame = hair_shadow_frame(&shadow->hair, view, box);
    set_hair_frame(params, map, light, view, &frame);
    hair_shadow_draw(&shadow->hair, view, &frame, map, scene->casters);
    if (has_mesh(scene)) frame_mesh_map(params, map, &scene->mesh, view, box);
    ++params->maps;
}

static void draw_hair_maps(Shadows *shadow, const ShadowScene *scene)
{
    LightView views[SCENE_MAX_LIGHTS] = {0};
    double boxes[SCENE_MAX_LIGHTS][6];
    int lights[SCENE_MAX_LIGHTS], count = 0;
    for (uint32_t i = 0; i < scene->light_count; ++i) {
        if (!casts(&scene->lights[i])) continue;
        views[count] = light_frame_view(&scene->lights[i], scene->middle);
        lights[count++] = (int)i;
    }
    hair_shadow_find_boxes(&shadow->hair, views, count, scene->casters, boxes);
    for (int i = 0; i < count; ++i) draw_map(shadow, scene, lights[i], &views[i], boxes[i]);
}

static bool same_ribbons(const ShadowCaster *a, const ShadowCaster *b)
{
    const MaterialParams *p = &a->look.material, *q = &b->look.material;
    return a->batch == b->batch && a->look.share == b->look.share &&
           a->look.features == b->look.features && p->radius == q->radius &&
           p->tip_ratio == q->tip_ratio && p->shadow_opacity == q->shadow_opacity &&
           p->smooth_parts == q->smooth_parts && p->smooth_curve == q->smooth_curve;
}

static bool same_casters(const Shadows *shadow, ShadowCasters casters)
{
    bool same = casters.count == shadow->drawn.casters.count;
    for (uint32_t i = 0; i < casters.count && same; ++i)
        same = same_ribbons(&casters.list[i], &shadow->casters[i]);
    return same;
}

bool shadows_show(const Shadows *shadow, const ShadowScene *scene)
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

static Result reserve(Shadows *shadow, const ShadowScene *scene, Error *error)
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
    return has_mesh(scene) ? shadows_reserve_mesh(shadow, count_maps(scene), error) : RESULT_OK;
}

static Result draw_maps(Shadows *shadow, const ShadowScene *scene, Error *error)
{
    ShadowParams *params = &shadow->params;
    memset(params, 0, sizeof *params);
    params->side = shadow->options.side;
    params->mesh_side = MESH_SIDE;
    find_mean_fibre(shadow, scene, params);
    shadow->hair.cpu.past_mesh = shadow->with_texels && has_mesh(scene);
    TRY(hair_shadow_begin(&shadow->hair, count_maps(scene), scene->casters, error));
    draw_hair_maps(shadow, scene);
    Result result =
        has_mesh(scene) && params->maps ? draw_mesh_maps(shadow, &scene->mesh, error) : RESULT_OK;
    hair_shadow_end(&shadow->hair);
    if (result != RESULT_OK) return result;
    shadow->maps_drawn = (uint32_t)params->maps;
    ++shadow->version;
    return RESULT_OK;
}

Result shadows_draw(Shadows *shadow, const ShadowScene *scene, GpuTimer *timer, Error *error)
{
    shadow->maps_drawn = 0;
    if (shadows_show(shadow, scene)) return RESULT_OK;
    TRY(reserve(shadow, scene, error));
    gpu_timer_begin(timer, "draw_shadow");
    Result result = draw_maps(shadow, scene, error);
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

void shadows_bind(Shadows *shadow)
{
    gpu_uniforms_set(BIND_SHADOW, &shadow->params, sizeof shadow->params);
    hair_shadow_bind(&shadow->hair);
    // First, since a buffer that is made later comes to the unit that is active then.
    if (shadow->mesh.texels.buffer)
        gpu_buffer_bind_texture(&shadow->mesh.texels, BIND_SHADOW_TEXELS);
    glActiveTexture(GL_TEXTURE0 + BIND_SHADOW_MESH);
    glBindTexture(GL_TEXTURE_2D, shadow->mesh.depth);
}
