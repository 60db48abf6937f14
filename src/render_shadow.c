// SPDX-License-Identifier: MIT
#include "render_shadow.h"

#include "light_view.h"

#include <math.h>
#include <string.h>

enum {
    GROUP = 8,
    TEXEL_GROUP = 64,
    PART_VERTICES = 64, // that one lane walks
    PART_SEGMENTS = 8,
    MESH_SIDE = 1024, // texels of the mesh's map
    MARGIN = 3,       // texels at the edges of a map that hair leaves free
    BOX_WORDS = 6
};

static const double FAR = 1e6;         // m: what is farther off is broken
static const double WIDEST = 3.7;      // of u and v before a lamp: 75 degrees off its axis
static const double UNIT = 1 << 16;    // steps for an optical depth of 1
static const double SUM_MAX = 2e9;     // of those steps: sums do not overflow
static const double LEAST_LEFT = 1e-3; // of the light behind one fibre, as in shadow_splat.comp

// The light in turn, and where its map lies.
typedef struct Turn {
    const ShadowScene *scene;
    int light, map;
    LightView view;
    CastParams cast;
} Turn;

static Result build(GLuint *program, const char *file, int group, int deep, Error *error)
{
    const ShaderDefine defines[] = {{"GROUP_SIZE", group},
                                    {"DEEP", deep},
                                    {"PART_VERTICES", PART_VERTICES},
                                    {"PART_SEGMENTS", PART_SEGMENTS},
                                    {NULL, 0}};
    return shader_build_compute(program, file, defines, error);
}

static Result build_programs(RenderShadow *shadow, Error *error)
{
    bool deep = shadow->options.kind == SHADOW_DOM;
    Result result = build(&shadow->bounds, "shadow_bounds.comp", GROUP, deep, error);
    if (result == RESULT_OK)
        result = build(&shadow->first, "shadow_splat.comp", GROUP, false, error);
    if (result == RESULT_OK && deep)
        result = build(&shadow->splat, "shadow_splat.comp", GROUP, true, error);
    if (result == RESULT_OK && deep)
        result = build(&shadow->spread, "shadow_spread.comp", TEXEL_GROUP, deep, error);
    if (result == RESULT_OK && deep)
        result = build(&shadow->finish, "shadow_finish.comp", TEXEL_GROUP, deep, error);
    return result;
}

Result render_shadow_create(RenderShadow *shadow, const GpuLimits *limits,
                            const ShadowOptions *options, Error *error)
{
    *shadow = (RenderShadow){.options = *options, .limits = limits};
    shadow->options.side = (options->side + 7) / 8 * 8;
    Result result = build_programs(shadow, error);
    if (result == RESULT_OK)
        result = gpu_buffer_create(&shadow->boxes, limits, "light's boxes", BOX_WORDS * 4, NULL, 0,
                                   error);
    if (result != RESULT_OK) render_shadow_destroy(shadow);
    return result;
}

static void destroy_maps(RenderShadow *shadow)
{
    gpu_buffer_destroy(&shadow->firsts);
    gpu_buffer_destroy(&shadow->depths);
    gpu_buffer_destroy(&shadow->sums);
    gpu_buffer_destroy(&shadow->layers);
    if (shadow->mesh_depth) glDeleteTextures(1, &shadow->mesh_depth);
    if (shadow->mesh_frame) glDeleteFramebuffers(1, &shadow->mesh_frame);
    shadow->mesh_depth = shadow->mesh_frame = 0;
    shadow->maps = 0;
    shadow->any = false;
}

void render_shadow_destroy(RenderShadow *shadow)
{
    const GLuint programs[] = {shadow->bounds, shadow->first,  shadow->spread,
                               shadow->splat,  shadow->finish, shadow->mesh};
    for (size_t i = 0; i < sizeof programs / sizeof *programs; ++i)
        if (programs[i]) glDeleteProgram(programs[i]);
    destroy_maps(shadow);
    gpu_buffer_destroy(&shadow->boxes);
    gpu_buffer_destroy(&shadow->cast_uniforms);
    gpu_buffer_destroy(&shadow->uniforms);
    *shadow = (RenderShadow){0};
}

static Result make_mesh_map(RenderShadow *shadow, Error *error)
{
    glGenTextures(1, &shadow->mesh_depth);
    glBindTexture(GL_TEXTURE_2D, shadow->mesh_depth);
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_DEPTH_COMPONENT32F, MESH_SIDE, MESH_SIDE * shadow->maps);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glGenFramebuffers(1, &shadow->mesh_frame);
    glBindFramebuffer(GL_FRAMEBUFFER, shadow->mesh_frame);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, shadow->mesh_depth,
                           0);
    glDrawBuffer(GL_NONE);
    Result result = RESULT_OK;
    if (!shadow->mesh)
        result =
            shader_build_draw(&shadow->mesh, "shadow_mesh.vert", "shadow_mesh.frag", NULL, error);
    return result == RESULT_OK ? gpu_check("the mesh's shadow map", error) : result;
}

// Room for so many maps.
static Result make_maps(RenderShadow *shadow, int maps, bool with_mesh, Error *error)
{
    const GpuLimits *limits = shadow->limits;
    bool deep = shadow->options.kind == SHADOW_DOM;
    if (shadow->maps >= maps && (!with_mesh || shadow->mesh_depth)) return RESULT_OK;
    destroy_maps(shadow);
    shadow->maps = maps;
    int64_t side = shadow->options.side, coarse = deep ? side / SHADOW_COARSE : side,
            texels = maps * side * side;
    Result result = gpu_buffer_create(&shadow->firsts, limits, "shadow's depths",
                                      maps * coarse * coarse * 4, NULL, GL_R32UI, error);
    if (result == RESULT_OK && deep)
        result = gpu_buffer_create(&shadow->depths, limits, "shadow's beginnings", texels * 4, NULL,
                                   GL_R32F, error);
    if (result == RESULT_OK && deep)
        result = gpu_buffer_create(&shadow->sums, limits, "shadow's sums",
                                   texels * 4 * SHADOW_LAYERS, NULL, GL_R32UI, error);
    if (result == RESULT_OK && deep)
        result = gpu_buffer_create(&shadow->layers, limits, "shadow's layers",
                                   texels * 8 * SHADOW_LAYERS, NULL, GL_RG32F, error);
    if (result == RESULT_OK && with_mesh) result = make_mesh_map(shadow, error);
    if (result != RESULT_OK) destroy_maps(shadow);
    return result;
}

static void fill(const GpuBuffer *buffer, GLuint value)
{
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer->buffer);
    glClearBufferSubData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, 0, (GLsizeiptr)buffer->size,
                         GL_RED_INTEGER, GL_UNSIGNED_INT, &value);
}

// Runs a pass over all strands, in parts of `part` of a strand's vertices.
static void cast(RenderShadow *shadow, Turn *turn, GLuint program, uint32_t part)
{
    glUseProgram(program);
    for (uint32_t i = 0; i < turn->scene->caster_count; ++i) {
        const ShadowCaster *caster = &turn->scene->casters[i];
        const HairBatch *batch = caster->batch;
        CastParams *params = &turn->cast;
        params->strand_count = batch->strand_count;
        params->vertex_count = batch->vertex_count;
        params->radius = caster->radius;
        params->tip_ratio = caster->tip_ratio;
        params->opacity = caster->opacity;
        gpu_uniforms_set(&shadow->cast_uniforms, BIND_CAST, params, sizeof *params);
        gpu_buffer_bind_texture(&batch->position, BIND_POSITION);
        glDispatchCompute((batch->strand_count + GROUP - 1) / GROUP,
                          (batch->vertex_count + part - 1) / part, 1);
    }
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                    GL_BUFFER_UPDATE_BARRIER_BIT);
}

static float decode(int32_t bits)
{
    float value;
    bits = bits < 0 ? bits ^ 0x7fffffff : bits;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static void set_rows(mat4 matrix, double rows[4][4])
{
    for (int k = 0; k < 4; ++k)
        for (int i = 0; i < 4; ++i) matrix[k][i] = (float)rows[k][i];
}

// The box (u, v, depth lowest, highest) of all hair; false without any.
static bool find_box(RenderShadow *shadow, Turn *turn, double box[6])
{
    double rows[4][4];
    const GLint none[BOX_WORDS] = {INT32_MAX, INT32_MAX, INT32_MAX,
                                   INT32_MIN, INT32_MIN, INT32_MIN};
    GLint words[BOX_WORDS];
    for (int k = 0; k < 4; ++k) light_view_row(&turn->view, k, rows[k]);
    set_rows(turn->cast.from_world, rows);
    turn->cast.limit = (float)FAR;
    turn->cast.reach = (float)(turn->view.perspective ? WIDEST : FAR);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, shadow->boxes.buffer);
    glBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof none, none);
    gpu_buffer_bind_storage(&shadow->boxes, BIND_BOUNDS_OUT);
    cast(shadow, turn, shadow->bounds, PART_VERTICES);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, shadow->boxes.buffer);
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof words, words);
    if (words[0] > words[3]) return false;
    for (int i = 0; i < 6; ++i) box[i] = (double)decode(words[i]);
    return true;
}

// A window that changes in steps as the box does, so that shadows do not swim with every frame: its
// size in eighths of octaves, its middle by whole texels. Row k of `to` (0, 1) is that of `from` in
// texels.
static double frame_window(const double low[2], const double high[2], double side,
                           double from[4][4], double to[4][4])
{
    double extent = fmax(fmax(high[0] - low[0], high[1] - low[1]), 1e-6);
    double texel = exp2(ceil(8 * log2(extent)) / 8) / (side - 2 * MARGIN);
    for (int k = 0; k < 2; ++k) {
        double shift = side / 2 - floor((low[k] + high[k]) / (2 * texel));
        for (int i = 0; i < 4; ++i) to[k][i] = from[k][i] / texel + shift * from[3][i];
    }
    return texel;
}

static void frame_depth(double near, double range, double from[4][4], double to[4][4])
{
    for (int i = 0; i < 4; ++i) {
        to[2][i] = from[2][i] / range - (i == 3 ? near / range : 0);
        to[3][i] = from[3][i];
    }
}

static void find_mesh_box(const ShadowScene *scene, const LightView *view, double box[6])
{
    for (int corner = 0; corner < 8; ++corner) {
        vec3 x;
        versor turn = {0};
        double world[3], place[3];
        memcpy(turn, scene->head_rotation, sizeof turn);
        for (int k = 0; k < 3; ++k)
            x[k] = (corner >> k & 1 ? scene->mesh->high : scene->mesh->low)[k];
        glm_quat_rotatev(turn, x, x);
        for (int k = 0; k < 3; ++k) world[k] = (double)(x[k] + scene->head_translation[k]);
        if (!light_view_place(view, world, place)) continue;
        for (int k = 0; k < 3; ++k) {
            double bound = k < 2 && view->perspective ? WIDEST : FAR;
            double value = fmin(fmax(place[k], -bound), bound);
            box[k] = fmin(box[k], value);
            box[k + 3] = fmax(box[k + 3], value);
        }
    }
}

// Depths of a perspective map are those of OpenGL: linear on the screen.
static void frame_mesh(RenderShadow *shadow, const Turn *turn, double box[6])
{
    double from[4][4], to[4][4];
    ShadowParams *params = &shadow->params;
    for (int k = 0; k < 4; ++k) light_view_row(&turn->view, k, from[k]);
    find_mesh_box(turn->scene, &turn->view, box);
    double texel = frame_window(box, box + 3, MESH_SIDE, from, to);
    double range = fmax(box[5] - box[2], 1e-6), near = box[2] - 0.01 * range,
           far = box[5] + 0.01 * range, shift;
    frame_depth(near, far - near, from, to);
    if (turn->view.perspective) {
        near = fmax(near, 1e-3 * far);
        for (int i = 0; i < 4; ++i)
            to[2][i] = far / (far - near) * (from[3][i] - (i == 3 ? near : 0));
        texel *= 0.5 * (near + far);
        shift = 2 * texel * near / (far * (far - near)); // as at the far end: less elsewhere
    } else {
        shift = 2 * texel / (far - near);
    }
    set_rows(params->mesh_from_world[turn->map], to);
    params->place[turn->map][2] = (float)shift;
    params->mesh_lift = fmaxf(params->mesh_lift, (float)(1.5 * texel));
}

// The smallest step of sums that cannot overflow, were all segments in one texel.
static float find_unit(const Turn *turn)
{
    double most = 1;
    for (uint32_t i = 0; i < turn->scene->caster_count; ++i) {
        const ShadowCaster *caster = &turn->scene->casters[i];
        double width = fmin(2.0 * (double)(caster->radius * turn->cast.texels), 1);
        if (turn->view.perspective) width = 1;
        double left = fmax(1 - (double)caster->opacity * width, LEAST_LEFT);
        most -= log(left) * caster->batch->strand_count * (caster->batch->vertex_count - 1);
    }
    return (float)fmin(UNIT, SUM_MAX / most);
}

// Rows of the light's matrices; false if no hair is in sight.
static bool frame_light(RenderShadow *shadow, Turn *turn, bool with_mesh)
{
    double box[6], from[4][4], to[4][4];
    ShadowParams *params = &shadow->params;
    if (!find_box(shadow, turn, box)) {
        if (!with_mesh) return false;
        memset(box, 0, sizeof box);
        box[0] = box[1] = box[2] = FAR, box[3] = box[4] = box[5] = -FAR;
        find_mesh_box(turn->scene, &turn->view, box);
    }
    for (int k = 0; k < 4; ++k) light_view_row(&turn->view, k, from[k]);
    double texel = frame_window(box, box + 3, shadow->options.side, from, to);
    double range = exp2(ceil(8 * log2(fmax(1.02 * (box[5] - box[2]), 1e-6))) / 8);
    frame_depth(box[2] - 0.01 * range, range, from, to);
    set_rows(params->from_world[turn->map], to);
    set_rows(turn->cast.from_world, to);
    params->place[turn->map][0] = (float)turn->light;
    params->place[turn->map][1] = (float)range;
    double distance = turn->view.perspective ? 0.5 * (box[2] + box[5]) : 1;
    params->place[turn->map][3] = (float)(1 / (texel * distance));
    turn->cast.side = shadow->options.side;
    turn->cast.map = turn->map;
    turn->cast.texels = (float)(1 / texel);
    turn->cast.unit = find_unit(turn);
    if (with_mesh) frame_mesh(shadow, turn, box);
    return true;
}

// First depths, in texels that are `coarse` of the map's wide.
static void draw_firsts(RenderShadow *shadow, const Turn *turn, int coarse)
{
    Turn wide = *turn;
    wide.cast.side /= coarse;
    wide.cast.texels /= (float)coarse;
    for (int k = 0; k < 2; ++k)
        for (int i = 0; i < 4; ++i) wide.cast.from_world[k][i] /= (float)coarse;
    gpu_buffer_bind_storage(&shadow->firsts, BIND_FIRST_OUT);
    cast(shadow, &wide, shadow->first, PART_SEGMENTS);
}

static void run_texels(const RenderShadow *shadow, const Turn *turn, GLuint program)
{
    int side = shadow->options.side;
    glUseProgram(program);
    glUniform2i(0, side, turn->map);
    if (program == shadow->finish) glUniform1f(1, turn->cast.unit);
    glDispatchCompute((GLuint)(side * side / TEXEL_GROUP), 1, 1);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

static void draw_deep(RenderShadow *shadow, Turn *turn)
{
    draw_firsts(shadow, turn, SHADOW_COARSE);
    gpu_buffer_bind_texture(&shadow->firsts, BIND_FIRST);
    gpu_buffer_bind_storage(&shadow->depths, BIND_DEPTHS_OUT);
    run_texels(shadow, turn, shadow->spread);
    gpu_buffer_bind_texture(&shadow->depths, BIND_DEPTHS);
    gpu_buffer_bind_storage(&shadow->sums, BIND_SUMS_OUT);
    cast(shadow, turn, shadow->splat, PART_SEGMENTS);
    gpu_buffer_bind_texture(&shadow->sums, BIND_SUMS);
    gpu_buffer_bind_storage(&shadow->layers, BIND_LAYERS_OUT);
    run_texels(shadow, turn, shadow->finish);
}

static void draw_mesh(const RenderShadow *shadow, const Turn *turn)
{
    const RenderMesh *mesh = turn->scene->mesh;
    const float farthest = 1;
    glBindFramebuffer(GL_FRAMEBUFFER, shadow->mesh_frame);
    glDisable(GL_SCISSOR_TEST);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    if (turn->map == 0) glClearBufferfv(GL_DEPTH, 0, &farthest);
    glViewport(0, turn->map * MESH_SIDE, MESH_SIDE, MESH_SIDE);
    glUseProgram(shadow->mesh);
    glUniform1i(1, turn->map);
    glBindVertexArray(mesh->vertex_array);
    glDrawElements(GL_TRIANGLES, (GLsizei)(3 * mesh->triangle_count), GL_UNSIGNED_INT, NULL);
    glDisable(GL_DEPTH_TEST);
}

static bool casts(const Light *light)
{
    return light->shadow && light->intensity > 0;
}

// What approximated maps take for the mean fibre.
static void find_mean_fibre(const RenderShadow *shadow, const ShadowScene *scene,
                            ShadowParams *params)
{
    double radius = 0, opacity = 0, weight = 0;
    for (uint32_t i = 0; i < scene->caster_count; ++i) {
        const ShadowCaster *caster = &scene->casters[i];
        double share = (double)caster->batch->strand_count * caster->batch->vertex_count;
        radius += share * (double)caster->radius;
        opacity += share * (double)caster->opacity;
        weight += share;
    }
    if (weight == 0) weight = 1, radius = 1;
    params->fibres = (float)(weight / (radius * (double)shadow->options.spacing));
    params->passed = (float)log2(fmax(1 - opacity / weight, LEAST_LEFT));
}

static bool is_drawn(const RenderShadow *shadow, const ShadowScene *scene)
{
    const ShadowScene *drawn = &shadow->drawn;
    return shadow->any && scene->revision && scene->revision == drawn->revision &&
           scene->light_count == drawn->light_count && scene->mesh == drawn->mesh &&
           memcmp(scene->head_rotation, drawn->head_rotation, sizeof drawn->head_rotation) == 0 &&
           memcmp(scene->head_translation, drawn->head_translation,
                  sizeof drawn->head_translation) == 0 &&
           memcmp(scene->lights, shadow->lights, scene->light_count * sizeof(Light)) == 0;
}

static void begin_maps(RenderShadow *shadow, const ShadowScene *scene)
{
    ShadowParams *params = &shadow->params;
    memset(params, 0, sizeof *params);
    params->side = shadow->options.side;
    params->mesh_side = MESH_SIDE;
    find_mean_fibre(shadow, scene, params);
    fill(&shadow->firsts, SHADOW_DEPTHS);
    if (shadow->options.kind == SHADOW_DOM) fill(&shadow->sums, 0);
}

static void draw_maps(RenderShadow *shadow, const ShadowScene *scene, bool with_mesh)
{
    for (uint32_t i = 0; i < scene->light_count; ++i) {
        Turn turn = {.scene = scene, .light = (int)i, .map = (int)shadow->maps_drawn};
        if (!casts(&scene->lights[i])) continue;
        turn.view = light_view(&scene->lights[i], scene->middle);
        if (!frame_light(shadow, &turn, with_mesh)) continue;
        if (shadow->options.kind == SHADOW_DOM)
            draw_deep(shadow, &turn);
        else
            draw_firsts(shadow, &turn, 1);
        gpu_uniforms_set(&shadow->uniforms, BIND_SHADOW, &shadow->params, sizeof shadow->params);
        if (with_mesh) draw_mesh(shadow, &turn);
        shadow->params.maps = (int)++shadow->maps_drawn;
    }
}

Result render_shadow_draw(RenderShadow *shadow, const ShadowScene *scene, GpuTimer *timer,
                          Error *error)
{
    int maps = 0;
    shadow->maps_drawn = 0;
    if (is_drawn(shadow, scene)) return RESULT_OK;
    for (uint32_t i = 0; i < scene->light_count; ++i) maps += casts(&scene->lights[i]);
    bool with_mesh = scene->mesh && scene->mesh->triangle_count > 0;
    Result result = make_maps(shadow, maps ? maps : 1, with_mesh, error);
    if (result != RESULT_OK) return result;
    gpu_timer_begin(timer, "draw_shadow");
    begin_maps(shadow, scene);
    draw_maps(shadow, scene, with_mesh);
    gpu_timer_end(timer);
    shadow->drawn = *scene;
    memcpy(shadow->lights, scene->lights, scene->light_count * sizeof(Light));
    shadow->any = true;
    return gpu_check("shadow maps", error);
}

void render_shadow_bind(RenderShadow *shadow)
{
    bool deep = shadow->options.kind == SHADOW_DOM;
    gpu_uniforms_set(&shadow->uniforms, BIND_SHADOW, &shadow->params, sizeof shadow->params);
    if (deep) gpu_buffer_bind_texture(&shadow->depths, BIND_DEPTHS);
    gpu_buffer_bind_texture(deep ? &shadow->layers : &shadow->firsts, BIND_LAYERS);
    glActiveTexture(GL_TEXTURE0 + BIND_SHADOW_MESH);
    glBindTexture(GL_TEXTURE_2D, shadow->mesh_depth);
}
