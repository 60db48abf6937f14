// SPDX-License-Identifier: MIT
#include "passes/base_layer.h"

#include "draw/drawing.h"
#include "passes/look_programs.h"

#include "glsl/common/shared_math.h"

#include <string.h>

static bool floor_is_seen(const Floor *floor, const DrawParams *draw)
{
    return floor->kind != FLOOR_NONE && draw->eye[1] > floor->middle[1];
}

static void set_floor(const Floor *floor)
{
    float color[3];
    linear_from_srgb_color(floor->color, color);
    glUniform3fv(0, 1, floor->middle);
    glUniform2f(1, floor->whole, floor->faded);
    glUniform3fv(2, 1, color);
}

bool base_layer_is_needed(const BaseLayer *base, const Floor *floor)
{
    return base->mesh.triangle_count > 0 || floor->kind != FLOOR_NONE || base->backdrop;
}

static void forget(BaseLayer *base)
{
    GLuint *finish = &base->finish[0][0];
    shader_release(base->light);
    base->light = 0;
    for (int i = 0; i < 6; ++i) {
        shader_release(finish[i]);
        finish[i] = 0;
    }
}

void base_layer_count(BaseLayer *base, int light_count, int map_count, bool wide, bool onto)
{
    if (base->light_count == light_count && base->map_count == map_count && base->wide == wide &&
        base->onto == onto)
        return;
    forget(base);
    base->light_count = light_count;
    base->map_count = map_count;
    base->wide = wide;
    base->onto = onto;
}

Result base_layer_build_light(BaseLayer *base, Shadow shadow, Error *error)
{
    int unrolled = look_unrolled(base->light_count);
    const ShaderDefine defines[] = {{"LIGHTS", 1},
                                    {"WIDE", base->wide},
                                    {"LIGHT_COUNT", unrolled},
                                    {"SHADOW_MAPS", unrolled ? base->map_count : 0},
                                    {"SHADOW", shadow},
                                    {"SHADOW_BY_MESH", 1},
                                    {"SKIN", base->shading == MESH_SKIN},
                                    {"ONTO", base->onto},
                                    {NULL, 0}};
    return base->light ? RESULT_OK
                       : shader_build_draw(&base->light, "draw/screen.vert", "draw/mesh.frag",
                                           defines, error);
}

Result base_layer_build(BaseLayer *base, bool mesh, FloorKind floor, Shadow shadow, Error *error)
{
    int unrolled = look_unrolled(base->light_count);
    const ShaderDefine defines[] = {{"LIGHTS", 1},
                                    {"WIDE", base->wide},
                                    {"LIGHT_COUNT", unrolled},
                                    {"SHADOW_MAPS", unrolled ? base->map_count : 0},
                                    {"SHADOW", shadow},
                                    {"SHADOW_BY_MESH", mesh},
                                    {"MESH", mesh},
                                    {"EDGE_SAMPLES", EDGE_SAMPLES},
                                    {"FLOOR", floor},
                                    {"BACKDROP", base->backdrop},
                                    {NULL, 0}};
    GLuint *finish = &base->finish[mesh][floor];
    if (!base->vertex_array) glGenVertexArrays(1, &base->vertex_array);
    return *finish
               ? RESULT_OK
               : shader_build_draw(finish, "draw/screen.vert", "draw/base.frag", defines, error);
}

// Restricts drawing to the box, widened by some samples and clipped to the target. Nothing is drawn
// if the box is outside.
static void scissor(const RenderTarget *target, const int box[4])
{
    enum { WIDER = 2 };
    const int side[2] = {target->width * target->samples, target->height * target->samples};
    int low[2], high[2];
    for (int k = 0; k < 2; ++k) {
        low[k] = box[k] < WIDER ? 0 : box[k] - WIDER;
        high[k] = box[k + 2] > side[k] - WIDER ? side[k] : box[k + 2] + WIDER;
        if (low[k] > side[k]) low[k] = side[k];
        if (high[k] < low[k]) high[k] = low[k];
    }
    glEnable(GL_SCISSOR_TEST);
    glScissor(low[0], low[1], high[0] - low[0], high[1] - low[1]);
}

static void bind_texture(GLenum unit, GLenum kind, GLuint texture)
{
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(kind, texture);
}

static void draw_surfaces(const BaseLayer *base, const BaseScene *scene, const RenderTarget *target)
{
    const float farthest = 1;
    glDisable(GL_SCISSOR_TEST);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glBindFramebuffer(GL_FRAMEBUFFER, target->edge_frame);
    glClearBufferfv(GL_DEPTH, 0, &farthest);
    glBindFramebuffer(GL_FRAMEBUFFER, target->surface_frame);
    glClearBufferfv(GL_DEPTH, 0, &farthest);
    scissor(target, scene->mesh_box);
    render_mesh_draw(&base->mesh, target);
    glDisable(GL_DEPTH_TEST);
}

// The light of hair, and its lattice.
static void set_onto(const LightPasses *light)
{
    const LightLattice *lattice = &light->field.lattice;
    float axis[3][4];
    for (int k = 0; k < 3; ++k) {
        memcpy(axis[k], lattice->turn[k], sizeof lattice->turn[k]);
        axis[k][3] = lattice->low[k];
    }
    glUniform4fv(0, 3, axis[0]);
    glUniform4f(3, (float)lattice->count[0], (float)lattice->count[1], (float)lattice->count[2],
                lattice->side);
    gpu_buffer_bind_texture(&light->faces, BIND_ONTO);
}

// Lights pixels of the mesh only: the triangle lies at the far plane and the depth test is
// GL_GREATER, so pixels without mesh are skipped.
static void light_mesh(const BaseLayer *base, const BaseScene *scene, const RenderTarget *target)
{
    if (!base->mesh.triangle_count) return;
    scissor(target, scene->mesh_box);
    bind_texture(BIND_SURFACE, GL_TEXTURE_2D, target->surface);
    bind_texture(BIND_TINT, GL_TEXTURE_2D, target->tint);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_FALSE);
    glDepthFunc(GL_GREATER);
    glBindFramebuffer(GL_FRAMEBUFFER, target->lit_frame);
    glUseProgram(base->light);
    if (base->onto) set_onto(scene->light);
    glBindVertexArray(base->vertex_array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDepthFunc(GL_LESS);
    glDisable(GL_DEPTH_TEST);
}

// Combines background, mesh and floor. Also writes their depth, which hides hair.
static void finish(const BaseLayer *base, const BaseScene *scene, FloorKind floor,
                   const RenderTarget *target)
{
    bool mesh = base->mesh.triangle_count > 0;
    const float farthest = 1, none[4] = {0};
    glDisable(GL_SCISSOR_TEST);
    glDepthMask(GL_TRUE);
    glBindFramebuffer(GL_FRAMEBUFFER, target->base_frame);
    glClearBufferfv(GL_COLOR, 0, scene->draw->background);
    glClearBufferfv(GL_COLOR, 1, none);
    glClearBufferfv(GL_COLOR, 2, none);
    glClearBufferfv(GL_DEPTH, 0, &farthest);
    if (mesh || floor != FLOOR_NONE || base->backdrop) {
        if (base->backdrop) gpu_buffer_bind_texture(&base->backdrop_light, BIND_BACKDROP);
        bind_texture(BIND_MIDDLE_DEPTH, GL_TEXTURE_2D, target->middle_depth);
        bind_texture(BIND_LIT, GL_TEXTURE_2D, target->lit);
        bind_texture(BIND_EDGE_DEPTH, GL_TEXTURE_2D_MULTISAMPLE, target->edge_depth);
        scissor(target, scene->box);
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_ALWAYS);
        glUseProgram(base->finish[mesh][floor]);
        if (floor != FLOOR_NONE) set_floor(scene->floor);
        glBindVertexArray(base->vertex_array);
        glDrawArrays(GL_TRIANGLES, 0, 3);
        glDepthFunc(GL_LESS);
        glDisable(GL_SCISSOR_TEST);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, target->hair_frame);
}

static Result upload_backdrop(BaseLayer *base, const BaseScene *scene, Error *error)
{
    const Backdrop *backdrop = scene->backdrop;
    if (base->backdrop_version == backdrop->version) return RESULT_OK;
    gpu_buffer_destroy(&base->backdrop_light);
    TRY(gpu_buffer_create(&base->backdrop_light, scene->limits, "the background",
                          (int64_t)backdrop->width * backdrop->height * 16, backdrop->light,
                          GL_RGBA32F, error));
    base->backdrop_version = backdrop->version;
    return RESULT_OK;
}

static Result draw_all(BaseLayer *base, const BaseScene *scene, const RenderTarget *target,
                       bool moved, GpuTimer *timer, Error *error)
{
    bool mesh = base->mesh.triangle_count > 0, seen = floor_is_seen(scene->floor, scene->draw);
    FloorKind floor = seen ? scene->floor->kind : FLOOR_NONE;
    Shadow shadow = scene->shadow->options.kind;
    base_layer_count(base, scene->draw->light_count, scene->shadow->params.maps,
                     drawing_has_wide_lights(scene->draw), scene->light != NULL);
    if (mesh) TRY(base_layer_build_light(base, shadow, error));
    if (mesh || seen || base->backdrop) TRY(base_layer_build(base, mesh, floor, shadow, error));
    if (base->backdrop) TRY(upload_backdrop(base, scene, error));
    gpu_timer_begin(timer, "draw_mesh");
    if (moved) draw_surfaces(base, scene, target);
    light_mesh(base, scene, target);
    if (!seen) finish(base, scene, floor, target);
    gpu_timer_end(timer);
    if (!seen) return RESULT_OK;
    gpu_timer_begin(timer, "draw_floor");
    finish(base, scene, floor, target);
    gpu_timer_end(timer);
    return RESULT_OK;
}

Result base_layer_draw(BaseLayer *base, const BaseScene *scene, const RenderTarget *target,
                       GpuTimer *timer, Error *error)
{
    Result result = RESULT_OK;
    if (!base_layer_is_needed(base, scene->floor)) return result;
    bool moved = !base->any || memcmp(&base->drawn, scene->draw, sizeof base->drawn) != 0;
    if (moved || base->shadowed != scene->shadow->version) {
        base->any = false;
        ++base->version;
        if (moved) ++base->depth_version;
        result = draw_all(base, scene, target, moved, timer, error);
        base->drawn = *scene->draw;
        base->shadowed = scene->shadow->version;
        base->any = result == RESULT_OK;
    }
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_FALSE);
    return result;
}

void base_layer_destroy(BaseLayer *base)
{
    render_mesh_destroy(&base->mesh);
    gpu_buffer_destroy(&base->backdrop_light);
    forget(base);
    if (base->vertex_array) glDeleteVertexArrays(1, &base->vertex_array);
    *base = (BaseLayer){0};
}
