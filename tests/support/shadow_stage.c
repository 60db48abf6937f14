// SPDX-License-Identifier: MIT
#include "support/shadow_stage.h"

#include "gpu/gpu_uniforms.h"

#include "draw/drawing.h"
#include "support/plain.h"
#include "support/test_glsl.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const Light LIGHT_ABOVE = {
    .direction = {0, 1, 0}, .color = {1, 1, 1}, .intensity = 1, .shadow = true};

const Light LIGHT_LAMP = {.kind = LIGHT_POINT,
                          .position = {0.3f, 2, 0.1f},
                          .color = {1, 1, 1},
                          .intensity = 1,
                          .distance = 1,
                          .shadow = true};

void shadow_stage_open(ShadowStage *stage, Strands strands, float radius, float opacity,
                       const Mesh *mesh, const Light *light)
{
    *stage = (ShadowStage){.strands = strands, .light = *light, .source = mesh};
    const GpuLimits *limits = &fixture_gpu()->limits;
    plain_section(&stage->material);
    stage->material.tip_ratio = 1;
    stage->material.shadow_opacity = opacity;
    NEEDED(hair_create(&stage->hair, &stage->strands, 0, limits, error));
    stage->item =
        (ReferenceItem){.strands = &stage->strands, .material = &stage->material, .radius = radius};
    stage->reference_scene = (ReferenceScene){.items = &stage->item, .item_count = 1, .mesh = mesh};
    NEEDED(shadow_reference_create(&stage->reference, &stage->reference_scene, light,
                                   (const float[3]){0}, error));
    stage->scene = (ShadowScene){.lights = &stage->light,
                                 .light_count = 1,
                                 .casters = {.list = stage->casters},
                                 .mesh = {&stage->mesh, {0, 0, 0, 1}, {0}},
                                 .revision = 1};
    for (uint32_t b = 0; b < stage->hair.batch_count && b < 8; ++b) {
        stage->looks[b] =
            (Look){.material = drawing_material(&stage->material, radius), .share = 1};
        stage->casters[stage->scene.casters.count++] =
            (ShadowCaster){&stage->hair.batches[b], &stage->looks[b]};
    }
    if (mesh) NEEDED(render_mesh_create(&stage->mesh, mesh, limits, error));
}

void shadow_stage_close(ShadowStage *stage)
{
    shadows_destroy(&stage->shadow);
    lane_shadow_destroy(&stage->lanes);
    for (int i = 0; i < 8; ++i) free(stage->position[i]), free(stage->paint[i]);
    render_mesh_destroy(&stage->mesh);
    hair_destroy(&stage->hair);
    shadow_reference_destroy(&stage->reference);
    params_destroy_section(&stage->material);
    strands_destroy(&stage->strands);
}

// --- Maps of lanes.

typedef struct LaneScene {
    LaneShadowScene scene;
    MappedCaster casters[8];
    PlacedMesh mesh;
} LaneScene;

// Copies a buffer to memory whose address does not change.
static void *read_buffer(const GpuBuffer *buffer, void **copy)
{
    if (!buffer->buffer) return NULL;
    if (!*copy) *copy = malloc((size_t)buffer->size);
    assert_non_null(*copy);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer->buffer);
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)buffer->size, *copy);
    return *copy;
}

static void open_lanes(ShadowStage *stage, LaneScene *lanes)
{
    const ShadowScene *scene = &stage->scene;
    *lanes = (LaneScene){.scene = {.lights = scene->lights,
                                   .light_count = scene->light_count,
                                   .casters = {lanes->casters, scene->casters.count},
                                   .mesh_version = stage->shadow.mesh_version + 1,
                                   .revision = scene->revision}};
    for (uint32_t i = 0; i < scene->casters.count; ++i) {
        const ShadowCaster *caster = &scene->casters.list[i];
        lanes->casters[i] =
            (MappedCaster){.material = look_material(caster->look, caster->batch),
                           .position = read_buffer(&caster->batch->position, &stage->position[i]),
                           .paint = read_buffer(&caster->batch->paint, &stage->paint[i])};
    }
    if (!stage->source) return;
    lanes->mesh = (PlacedMesh){.position = (const float(*)[3])stage->source->position,
                               .triangle = (const uint32_t(*)[3])stage->source->triangle,
                               .vertex_count = stage->source->vertex_count,
                               .triangle_count = stage->source->triangle_count};
    memcpy(lanes->mesh.rotation, scene->mesh.rotation, sizeof lanes->mesh.rotation);
    memcpy(lanes->mesh.translation, scene->mesh.translation, sizeof lanes->mesh.translation);
    lanes->scene.mesh = &lanes->mesh;
    memcpy(lanes->scene.mesh_low, stage->mesh.low, sizeof lanes->scene.mesh_low);
    memcpy(lanes->scene.mesh_high, stage->mesh.high, sizeof lanes->scene.mesh_high);
}

static void draw_lanes(ShadowStage *stage)
{
    LaneScene lanes;
    open_lanes(stage, &lanes);
    NEEDED(lane_shadow_draw(&stage->lanes, &lanes.scene, error));
}

typedef struct LaneLight {
    const ShadowStage *stage;
    const float (*points)[4];
    uint32_t count;
    float *shares;
} LaneLight;

SIMD_INLINE void find_lane_light(const LaneLight *light, int part)
{
    enum { W = STRAND_TILE };
    const ShadowStage *stage = light->stage;
    float radius[W], opacity[W], x[3][W], left[W];
    int map = stage->lanes.map_of[0];
    (void)part;
    for (uint32_t i = 0; i < light->count; i += W) {
        for (uint32_t k = 0; k < W; ++k) {
            for (int c = 0; c < 3; ++c)
                x[c][k] = light->points[i + k < light->count ? i + k : i][c];
            radius[k] = stage->on_fibre ? stage->item.radius : 0;
            opacity[k] = stage->material.shadow_opacity;
        }
        if (map >= 0)
            lane_shadow_left_of(&stage->lanes, map, (const float(*)[W])x, radius, opacity, left);
        for (uint32_t k = 0; k < W && i + k < light->count; ++k)
            light->shares[i + k] = map < 0 ? 1 : left[k];
    }
}

SIMD_STAGE(find_lane_light, LaneLight)

static float *find_by_lanes(ShadowStage *stage, const float (*points)[4], uint32_t count)
{
    LaneLight light = {stage, points, count, malloc(count * sizeof(float))};
    assert_non_null(light.shares);
    run_find_lane_light(&light, 1);
    return light.shares;
}

// --- Both ways.

uint32_t shadow_stage_again(ShadowStage *stage)
{
    GpuTimer timer;
    if (stage->way == SHADOW_BY_LANES) {
        draw_lanes(stage);
        return (uint32_t)stage->lanes.maps_drawn;
    }
    gpu_timer_create(&timer, false, true);
    NEEDED(shadows_draw(&stage->shadow, &stage->scene, &timer, error));
    gpu_timer_destroy(&timer);
    return stage->shadow.maps_drawn;
}

void shadow_stage_draw(ShadowStage *stage, Shadow kind, int side, float spacing, ShadowWay way)
{
    DrawParams draw = {.head_rotation = {0, 0, 0, 1}};
    gpu_uniforms_set(BIND_DRAW, &draw, sizeof draw);
    shadows_destroy(&stage->shadow);
    lane_shadow_destroy(&stage->lanes);
    stage->way = way;
    const ShadowOptions options = {.kind = kind, .side = side, .spacing = spacing};
    if (way == SHADOW_BY_LANES)
        NEEDED(lane_shadow_create(&stage->lanes, &options, error));
    else
        shadows_create(&stage->shadow, &fixture_gpu()->limits, &options);
    shadow_stage_again(stage);
}

const ShadowParams *shadow_stage_params(const ShadowStage *stage)
{
    return stage->way == SHADOW_BY_LANES ? &stage->lanes.params : &stage->shadow.params;
}

void shadow_stage_forget_mesh(ShadowStage *stage)
{
    shadows_forget_mesh(&stage->shadow);
}

void shadow_stage_wipe_mesh(ShadowStage *stage)
{
    const float farthest = 1;
    const LaneMeshShadow *mesh = &stage->lanes.mesh;
    int side = stage->lanes.params.mesh_side, maps = stage->lanes.params.maps;
    if (stage->way == SHADOW_BY_LANES) {
        for (int i = 0; i < maps * side * side; ++i) mesh->depths[i] = farthest;
        shadow_mesh_bound(mesh->depths, side, maps, mesh->bounds, 1);
        return;
    }
    glBindFramebuffer(GL_FRAMEBUFFER, stage->shadow.mesh.frame);
    glDepthMask(GL_TRUE);
    glClearBufferfv(GL_DEPTH, 0, &farthest);
}

float *shadow_stage_light(ShadowStage *stage, const float (*points)[4], uint32_t count)
{
    GLuint program;
    GpuBuffer in, out;
    const GpuLimits *limits = &fixture_gpu()->limits;
    const ShaderDefine defines[] = {{"SHADOW", stage->shadow.options.kind},
                                    {"SHADOW_BY_MESH", stage->mesh.triangle_count > 0},
                                    {"WIDE", stage->light.radius > 0},
                                    {NULL, 0}};
    uint32_t groups = (count + 7) / 8;
    if (stage->way == SHADOW_BY_LANES) return find_by_lanes(stage, points, count);
    float *shares = malloc(groups * 8 * sizeof *shares);
    float(*whole)[4] = calloc(groups * 8, sizeof *whole);
    assert_true(shares && whole);
    memcpy(whole, points, count * sizeof *points);
    shader_add_sources(TEST_GLSL_SOURCES);
    shader_treat_warnings_as_errors(true);
    NEEDED(shader_build_compute(&program, "probe_shadow.comp", defines, error));
    NEEDED(gpu_buffer_create(&in, limits, "points", groups * 8 * 16, whole, 0, error));
    NEEDED(gpu_buffer_create(&out, limits, "shares", groups * 8 * 4, NULL, 0, error));
    gpu_buffer_bind_storage(&in, 0);
    gpu_buffer_bind_storage(&out, 1);
    shadows_bind(&stage->shadow);
    glUseProgram(program);
    glUniform2f(0, stage->on_fibre ? 2 * stage->item.radius : 0, stage->material.shadow_opacity);
    glDispatchCompute(groups, 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, count * 4, shares);
    gpu_buffer_destroy(&in);
    gpu_buffer_destroy(&out);
    shader_release(program);
    free(whole);
    return shares;
}

double shadow_stage_exact(const ShadowStage *stage, double x, double y, double z)
{
    return shadow_reference_light(&stage->reference, (const double[3]){x, y, z}, 0);
}

Strands shadow_stage_layers(uint32_t layers)
{
    enum { VERTICES = 5 };
    Strands strands;
    NEEDED(strands_create(&strands, layers, layers * VERTICES, error));
    for (uint32_t s = 0; s <= layers; ++s) strands.first[s] = s * VERTICES;
    for (uint32_t v = 0; v < strands.vertex_count; ++v) {
        strands.position[v][0] = (float)(v % VERTICES) / (VERTICES - 1) - 0.5f;
        strands.position[v][1] = -0.1f * (float)(v / VERTICES);
    }
    return strands;
}

Mesh shadow_stage_square(float y, float half)
{
    Mesh mesh;
    NEEDED(mesh_create(&mesh, 4, 2, error));
    for (int v = 0; v < 4; ++v) {
        memcpy(mesh.position[v], (float[3]){v & 1 ? half : -half, y, v & 2 ? half : -half}, 12);
        mesh.normal[v][1] = 1;
    }
    const uint32_t triangles[2][3] = {{0, 1, 2}, {2, 1, 3}};
    memcpy(mesh.triangle, triangles, sizeof triangles);
    return mesh;
}

void shadow_assert_near(double got, double expected, double tolerance)
{
    if (!(fabs(got - expected) <= tolerance)) fail_msg("got %.9g, expected %.9g", got, expected);
}
