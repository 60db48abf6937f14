// SPDX-License-Identifier: MIT
#include "draw/base_layer.h"

#include "draw/drawing.h"
#include "draw/look.h"

#include <string.h>

// --- The floor.

enum { CORNERS = 64 };

static bool floor_is_seen(const Floor *floor, const DrawParams *draw)
{
    return floor->kind != FLOOR_NONE && draw->eye[1] > floor->middle[1];
}

Result base_layer_build_floor(BaseFloor *render, Error *error)
{
    const ShaderDefine defines[] = {{"FLOOR_CORNERS", CORNERS}, {NULL, 0}};
    if (render->depth) return RESULT_OK;
    glGenVertexArrays(1, &render->vertex_array);
    return shader_build_draw(&render->depth, "draw/floor.vert", "draw/depth.frag", defines, error);
}

static void set_place(const Floor *floor, float radius)
{
    glUniform3fv(0, 1, floor->middle);
    glUniform3f(1, floor->whole, floor->faded, radius);
}

static void set_floor(const Floor *floor)
{
    float color[3];
    linear_from_srgb_color(floor->color, color);
    set_place(floor, floor->faded);
    glUniform3fv(2, 1, color);
}

// What lies before or behind all that the camera frames stays in the image: its depth is cut.
static Result draw_floor_depth(BaseFloor *render, const Floor *floor, Error *error)
{
    if (floor->kind != FLOOR_PLANE) return RESULT_OK;
    TRY(base_layer_build_floor(render, error));
    glUseProgram(render->depth);
    set_place(floor, 0.5f * (floor->whole + floor->faded));
    glEnable(GL_DEPTH_CLAMP);
    glBindVertexArray(render->vertex_array);
    glDrawArrays(GL_TRIANGLE_FAN, 0, CORNERS + 2);
    glDisable(GL_DEPTH_CLAMP);
    return RESULT_OK;
}

static void destroy_floor(BaseFloor *render)
{
    if (render->depth) glDeleteProgram(render->depth);
    if (render->vertex_array) glDeleteVertexArrays(1, &render->vertex_array);
    *render = (BaseFloor){0};
}

// --- Mesh and floor.

typedef struct Box {
    int low[2], high[2]; // samples, from and before
} Box;

bool base_layer_is_needed(const BaseLayer *base, const Floor *floor)
{
    return base->mesh.triangle_count > 0 || floor->kind != FLOOR_NONE;
}

static void forget(BaseLayer *base)
{
    GLuint *finish = &base->finish[0][0];
    if (base->light) glDeleteProgram(base->light);
    base->light = 0;
    for (int i = 0; i < 9; ++i) {
        if (finish[i]) glDeleteProgram(finish[i]);
        finish[i] = 0;
    }
}

void base_layer_count(BaseLayer *base, int light_count, int map_count)
{
    if (base->light_count == light_count && base->map_count == map_count) return;
    forget(base);
    base->light_count = light_count;
    base->map_count = map_count;
}

Result base_layer_build_light(BaseLayer *base, Shadow shadow, Error *error)
{
    int unrolled = look_unrolled(base->light_count);
    const ShaderDefine defines[] = {{"LIGHTS", 1},
                                    {"LIGHT_COUNT", unrolled},
                                    {"SHADOW_MAPS", unrolled ? base->map_count : 0},
                                    {"SHADOW", shadow},
                                    {"SHADOW_BY_MESH", 1},
                                    {"SKIN", base->shading == MESH_SKIN},
                                    {NULL, 0}};
    return base->light ? RESULT_OK
                       : shader_build_draw(&base->light, "draw/screen.vert", "draw/mesh.frag",
                                           defines, error);
}

Result base_layer_build(BaseLayer *base, BaseArea area, FloorKind floor, Shadow shadow,
                        Error *error)
{
    int unrolled = look_unrolled(base->light_count);
    const ShaderDefine defines[] = {{"LIGHTS", 1},
                                    {"LIGHT_COUNT", unrolled},
                                    {"SHADOW_MAPS", unrolled ? base->map_count : 0},
                                    {"SHADOW", shadow},
                                    {"SHADOW_BY_MESH", area != BASE_WITHOUT_MESH},
                                    {"MESH", area == BASE_OVER_MESH},
                                    {"EDGE_SAMPLES", EDGE_SAMPLES},
                                    {"FLOOR", floor},
                                    {NULL, 0}};
    GLuint *finish = &base->finish[area][floor];
    if (!base->vertex_array) glGenVertexArrays(1, &base->vertex_array);
    return *finish
               ? RESULT_OK
               : shader_build_draw(finish, "draw/screen.vert", "draw/base.frag", defines, error);
}

// The box within the target, some samples wider; empty beside it.
static Box find_box(const RenderTarget *target, const int box[4])
{
    enum { WIDER = 2 };
    const int side[2] = {target->width * target->samples, target->height * target->samples};
    Box found;
    for (int k = 0; k < 2; ++k) {
        found.low[k] = box[k] < WIDER ? 0 : box[k] - WIDER;
        found.high[k] = box[k + 2] > side[k] - WIDER ? side[k] : box[k + 2] + WIDER;
        if (found.low[k] > side[k]) found.low[k] = side[k];
        if (found.high[k] < found.low[k]) found.high[k] = found.low[k];
    }
    return found;
}

// What is drawn is cut by it.
static void scissor(Box box)
{
    glEnable(GL_SCISSOR_TEST);
    glScissor(box.low[0], box.low[1], box.high[0] - box.low[0], box.high[1] - box.low[1]);
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
    glBindFramebuffer(GL_FRAMEBUFFER, target->surface_frame);
    glClearBufferfv(GL_DEPTH, 0, &farthest);
    scissor(find_box(target, scene->mesh_box));
    render_mesh_draw(&base->mesh, target);
    glDisable(GL_DEPTH_TEST);
}

// Only where there is mesh: a triangle behind everything is before nothing else.
static void light_mesh(const BaseLayer *base, const BaseScene *scene, const RenderTarget *target)
{
    if (!base->mesh.triangle_count) return;
    scissor(find_box(target, scene->mesh_box));
    bind_texture(BIND_SURFACE, GL_TEXTURE_2D, target->surface);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_FALSE);
    glDepthFunc(GL_GREATER);
    glBindFramebuffer(GL_FRAMEBUFFER, target->lit_frame);
    glUseProgram(base->light);
    glBindVertexArray(base->vertex_array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDepthFunc(GL_LESS);
    glDisable(GL_DEPTH_TEST);
}

// Its depth, too: what hides hair.
static void finish_over_mesh(const BaseLayer *base, FloorKind floor, const RenderTarget *target,
                             Box box)
{
    bind_texture(BIND_MIDDLE_DEPTH, GL_TEXTURE_2D, target->middle_depth);
    bind_texture(BIND_LIT, GL_TEXTURE_2D, target->lit);
    bind_texture(BIND_EDGE_DEPTH, GL_TEXTURE_2D_MULTISAMPLE, target->edge_depth);
    glUseProgram(base->finish[BASE_OVER_MESH][floor]);
    glUniform2i(3, box.low[0], box.low[1]);
    glUniform2i(4, box.high[0], box.high[1]);
    scissor(box);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDepthFunc(GL_LESS);
    glDisable(GL_DEPTH_TEST);
}

// The rest of `all`: whole rows above and below the box, and what is left and right of it.
static void finish_beside(const BaseLayer *base, BaseArea area, FloorKind floor, Box all, Box box)
{
    const Box sides[] = {{{all.low[0], all.low[1]}, {all.high[0], box.low[1]}},
                         {{all.low[0], box.high[1]}, {all.high[0], all.high[1]}},
                         {{all.low[0], box.low[1]}, {box.low[0], box.high[1]}},
                         {{box.high[0], box.low[1]}, {all.high[0], box.high[1]}}};
    glUseProgram(base->finish[area][floor]);
    for (int i = 0; i < 4; ++i) {
        if (sides[i].low[0] >= sides[i].high[0] || sides[i].low[1] >= sides[i].high[1]) continue;
        scissor(sides[i]);
        glDrawArrays(GL_TRIANGLES, 0, 3);
    }
}

// The background, and over it mesh and floor.
static void finish(const BaseLayer *base, const BaseScene *scene, FloorKind floor,
                   const RenderTarget *target)
{
    bool by_mesh = base->mesh.triangle_count > 0;
    Box all = find_box(target, scene->box), box = find_box(target, scene->mesh_box);
    if (!by_mesh) box = (Box){{all.low[0], all.low[1]}, {all.low[0], all.low[1]}};
    const float farthest = 1;
    glDisable(GL_SCISSOR_TEST);
    glDepthMask(GL_TRUE);
    glBindFramebuffer(GL_FRAMEBUFFER, target->base_frame);
    glClearBufferfv(GL_COLOR, 0, scene->draw->background);
    glClearBufferfv(GL_DEPTH, 0, &farthest);
    glBindVertexArray(base->vertex_array);
    if (by_mesh) finish_over_mesh(base, floor, target, box);
    if (floor != FLOOR_NONE)
        finish_beside(base, by_mesh ? BASE_BESIDE_MESH : BASE_WITHOUT_MESH, floor, all, box);
    glDisable(GL_SCISSOR_TEST);
}

static Result draw_floor(BaseLayer *base, const BaseScene *scene, const RenderTarget *target,
                         Error *error)
{
    FloorKind kind = scene->floor->kind;
    for (int area = 0; area < 3; ++area) {
        if (!base->finish[area][kind]) continue;
        glUseProgram(base->finish[area][kind]);
        set_floor(scene->floor);
    }
    finish(base, scene, kind, target);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glBindFramebuffer(GL_FRAMEBUFFER, target->hair_frame);
    return draw_floor_depth(&base->floor, scene->floor, error);
}

static Result build(BaseLayer *base, FloorKind floor, Shadow shadow, Error *error)
{
    if (base->mesh.triangle_count == 0)
        return base_layer_build(base, BASE_WITHOUT_MESH, floor, shadow, error);
    TRY(base_layer_build_light(base, shadow, error));
    TRY(base_layer_build(base, BASE_OVER_MESH, floor, shadow, error));
    if (floor != FLOOR_NONE) TRY(base_layer_build(base, BASE_BESIDE_MESH, floor, shadow, error));
    return RESULT_OK;
}

static Result draw_all(BaseLayer *base, const BaseScene *scene, const RenderTarget *target,
                       bool moved, GpuTimer *timer, Error *error)
{
    bool seen = floor_is_seen(scene->floor, scene->draw);
    FloorKind floor = seen ? scene->floor->kind : FLOOR_NONE;
    base_layer_count(base, scene->draw->light_count, scene->shadow->params.maps);
    TRY(build(base, floor, scene->shadow->options.kind, error));
    gpu_timer_begin(timer, "draw_mesh");
    if (moved) draw_surfaces(base, scene, target);
    light_mesh(base, scene, target);
    if (!seen) finish(base, scene, floor, target);
    gpu_timer_end(timer);
    if (!seen) return RESULT_OK;
    gpu_timer_begin(timer, "draw_floor");
    Result result = draw_floor(base, scene, target, error);
    gpu_timer_end(timer);
    return result;
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
    destroy_floor(&base->floor);
    forget(base);
    if (base->vertex_array) glDeleteVertexArrays(1, &base->vertex_array);
    *base = (BaseLayer){0};
}
