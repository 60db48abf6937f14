// SPDX-License-Identifier: MIT
#include "draw/drawing.h"

#include "gpu/gpu_uniforms.h"
#include "image/tone.h"
#include "sim/hair.h"
#include "sim/head.h"
#include "strands/paint.h"

#include "glsl/common/shared_math.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

// --- Camera, lights and materials for shaders.

_Static_assert(MAX_LIGHTS == SCENE_MAX_LIGHTS, "one limit");

void drawing_set_view(DrawParams *draw, const View *view, int width, int height)
{
    mat4 projection = {0}, from_world = {0};
    memcpy(projection, view->projection, sizeof projection);
    memcpy(from_world, view->view, sizeof from_world);
    projection[1][1] = -projection[1][1]; // rows of the image begin at the top
    glm_mat4_mul(projection, from_world, draw->clip_from_world);
    memcpy(draw->eye, view->eye, sizeof(vec3));
    draw->width = (float)width;
    draw->height = (float)height;
    draw->band[0] = (uint32_t)width;
    draw->focal = 0.5f * draw->height * view->projection[1][1];
    draw->axis[0] = draw->width / 2;
    draw->axis[1] = draw->height / 2;
    draw->near_distance = view->near_distance;
    // Clip-space z is z22 z + z32, where the distance in front of the eye is w = -z.
    draw->depth[0] = -view->projection[2][2];
    draw->depth[1] = view->projection[3][2];
}

// The spot's falloff is clamp((cos a - cos outer) / (cos inner - cos outer), 0, 1), where a is the
// angle to the axis. The shader computes it as x - y cos b from the cosine of the direction towards
// the light, cos b = -cos a. With y = 0 everything is inside the cone.
static void set_cone(const Light *light, float cone[4])
{
    cone[0] = 1;
    if (light->kind != LIGHT_SPOT) return;
    float outer = cosf(glm_rad(light->outer_deg)), inner = cosf(glm_rad(light->inner_deg));
    cone[1] = 1 / fmaxf(inner - outer, 1e-6f);
    cone[0] = -outer * cone[1];
}

void drawing_set_lights(DrawParams *draw, const Light *lights, uint32_t count)
{
    assert(count <= MAX_LIGHTS);
    draw->light_count = (int)count;
    for (uint32_t i = 0; i < count; ++i) {
        const Light *light = &lights[i];
        bool far = light->kind == LIGHT_DIRECTIONAL;
        for (int k = 0; k < 3; ++k) {
            draw->light_place[i][k] = far ? light->direction[k] : light->position[k];
            draw->light_color[i][k] = light->intensity * light->color[k];
            draw->light_axis[i][k] = far ? 0 : light->direction[k];
        }
        draw->light_place[i][3] = !far;
        draw->light_axis[i][3] = light->distance * light->distance;
        set_cone(light, draw->light_cone[i]);
    }
}

// beta and alpha are for theta_h = (theta_i + theta_r) / 2. In theta_r the lobe is twice as wide
// and tilted by twice the angle. The scales tilt R towards the root; TT and TRT follow from R
// (Marschner et al. 2003, table 1).
static void set_lobes(const SectionParams *params, MaterialParams *material)
{
    static const float WIDTH[] = {1, 0.5f, 2}, TILT[] = {-1, 0.5f, 1.5f};
    for (int p = 0; p < 3; ++p) {
        float width = 2 * WIDTH[p] * glm_rad(params->roughness), v = width * width,
              tilt = 2 * TILT[p] * glm_rad(params->cone_angle);
        material->lobe_sharpness[p] = 1 / v;
        material->lobe_scale[p] = 1 / (v * (1 - expf(-2 / v)));
        material->lobe_tilt_cos[p] = cosf(tilt);
        material->lobe_tilt_sin[p] = sinf(tilt);
    }
}

MaterialParams drawing_material(const SectionParams *params, float radius)
{
    float cone = glm_rad(params->cone_angle);
    MaterialParams material = {
        .color_variation = params->color_variation,
        .warmth_variation = params->warmth_variation,
        .radius = radius,
        .tip_ratio = params->tip_ratio,
        .opacity = params->opacity,
        .shadow_opacity = params->shadow_opacity,
        .smooth_parts = (uint)params->smooth,
        .smooth_curve = (uint)params->curve,
        .ambient = params->ambient,
        .diffuse = params->diffuse,
        .specular1 = params->specular1,
        .exponent1 = params->exponent1,
        .specular2 = params->specular2,
        .exponent2 = params->exponent2,
        .shift1_cos = cosf(2 * cone),
        .shift1_sin = sinf(2 * cone),
        .shift2_cos = cosf(-3 * cone),
        .shift2_sin = sinf(-3 * cone),
    };
    paint_color(params, material.color);
    set_lobes(params, &material);
    return material;
}

// --- A frame to draw.

// The share of the ambient light that a matt mesh and its floor receive. They have no ambient
// occlusion; this constant stands for the ambient light that is left between hair and mesh.
static const float MATT_AMBIENT = 0.15f;

int drawing_display(const RendererOptions *options)
{
    bool light = options->kind == IMAGE_FLOAT || options->aov != AOV_NONE;
    return light ? TONE_LIGHT : (int)options->tone;
}

static bool has_backing(const RendererOptions *options)
{
    return options->tone != TONE_NONE && options->background[3] == 1;
}

void drawing_background(const RendererOptions *options, float light[4])
{
    float opacity = has_backing(options) ? 0 : options->background[3];
    linear_from_srgb_color(options->background, light);
    for (int k = 0; k < 3; ++k) light[k] *= opacity;
    light[3] = opacity;
}

void drawing_backing(const RendererOptions *options, float color[4])
{
    color[3] = has_backing(options);
    linear_from_srgb_color(options->background, color);
    for (int k = 0; k < 3; ++k) color[k] *= color[3];
}

// The two first terms of an environment are as a sky's and a ground's.
static void set_environment(DrawParams *draw, const Ambient *ambient, float light)
{
    float terms[ENVIRONMENT_TERMS][3];
    environment_around(ambient->environment, &ambient->axes, terms);
    for (int k = 0; k < 3; ++k) {
        draw->sky[k] = light * ambient->strength * (terms[0][k] + terms[1][k]);
        draw->ground[k] = light * ambient->strength * (terms[0][k] - terms[1][k]);
        for (int t = 0; t < AROUND_TERMS; ++t)
            draw->around[t][k] = light * ambient->strength * terms[2 + t][k];
        draw->around[1 + k][3] = ambient->axes.axis[0][k];
    }
    draw->around[0][3] = 1;
}

static void set_ambient(DrawParams *draw, const Ambient *ambient, float light)
{
    if (ambient && ambient->environment) {
        set_environment(draw, ambient, light);
        return;
    }
    for (int k = 0; k < 3; ++k) {
        draw->sky[k] = light * (ambient ? linear_from_srgb(ambient->sky[k]) : 1);
        draw->ground[k] = light * (ambient ? linear_from_srgb(ambient->ground[k]) : 1);
    }
}

// Fills `draw` for the whole image; the members for a band are set later.
static void fill_draw_params(const RendererOptions *options, const DrawnMesh *mesh,
                             const RenderFrame *frame, DrawParams *draw)
{
    memset(draw, 0, sizeof *draw);
    drawing_set_view(draw, frame->view, options->width * options->samples,
                     options->height * options->samples);
    float light = exp2f(options->exposure);
    drawing_set_lights(draw, frame->lights, frame->light_count);
    set_ambient(draw, frame->ambient, light);
    for (int k = 0; k < 3; ++k)
        for (uint32_t i = 0; i < frame->light_count; ++i) draw->light_color[i][k] *= light;
    memcpy(draw->depth_range, options->depth_range, sizeof options->depth_range);
    drawing_background(options, draw->background);
    drawing_backing(options, draw->backing);
    memcpy(draw->head_rotation, frame->head_rotation, sizeof draw->head_rotation);
    memcpy(draw->head_translation, frame->head_translation, sizeof frame->head_translation);
    if (options->aov == AOV_NONE) memcpy(draw->mesh_color, mesh->color, sizeof mesh->color);
    draw->mesh_color[3] = options->mesh_shading == MESH_SKIN ? 1 : MATT_AMBIENT;
    draw->seed = options->seed;
}

// A disc of the angular radius r has the variance r^2 / 4 along each axis. Lamps are as wide as
// they are from the middle of the hair, but never more than 45 degrees.
static void set_widths(Drawing *drawing, const RenderFrame *frame)
{
    vec3 middle = {0};
    if (drawing->item_count) drawing_find_middle(&drawing->items[0], middle);
    for (uint32_t i = 0; i < frame->light_count; ++i) {
        const Light *light = &frame->lights[i];
        float radius = glm_rad(light->radius);
        if (light->kind != LIGHT_DIRECTIONAL) {
            vec3 place = {light->position[0], light->position[1], light->position[2]};
            radius = atanf(light->radius / fmaxf(glm_vec3_distance(place, middle), 1e-6f));
        }
        radius = fminf(radius, glm_rad(SCENE_WIDE_MOST));
        drawing->draw.light_color[i][3] = 0.25f * radius * radius;
    }
}

// Widens a box in the image by a point of the world. A point in front of the near plane widens it
// without limit.
static void add_to_box(DrawParams *draw, vec3 x, int box[4])
{
    vec4 clip;
    const int far = 1 << 20;
    glm_mat4_mulv(draw->clip_from_world, (vec4){x[0], x[1], x[2], 1}, clip);
    if (clip[3] < draw->near_distance) { // may project to anywhere
        box[0] = box[1] = 0, box[2] = box[3] = far;
        return;
    }
    for (int k = 0; k < 2; ++k) {
        float size = k ? draw->height : draw->width, px = (clip[k] / clip[3] + 1) * size / 2;
        px = fmaxf(fminf(px, (float)far - 2), 2 - (float)far);
        box[k] = (int)fminf((float)box[k], floorf(px) - 1);
        box[k + 2] = (int)fmaxf((float)box[k + 2], ceilf(px) + 1);
    }
}

static void find_mesh_box(const DrawnMesh *mesh, DrawParams *draw, int box[4])
{
    const int far = 1 << 20;
    vec3 x;
    box[0] = box[1] = far, box[2] = box[3] = -far;
    for (int corner = 0; corner < 8 && mesh->mesh.triangle_count; ++corner) {
        for (int k = 0; k < 3; ++k) x[k] = (corner >> k & 1 ? mesh->high : mesh->low)[k];
        glm_quat_rotatev(draw->head_rotation, x, x);
        glm_vec3_add(x, draw->head_translation, x);
        add_to_box(draw, x, box);
    }
}

static void add_floor_to_box(const Floor *floor, DrawParams *draw, int box[4])
{
    vec3 x;
    for (int corner = 0; corner < 4 && floor->kind != FLOOR_NONE; ++corner) {
        for (int k = 0; k < 3; ++k) x[k] = floor->middle[k];
        x[0] += corner & 1 ? floor->faded : -floor->faded;
        x[2] += corner & 2 ? floor->faded : -floor->faded;
        add_to_box(draw, x, box);
    }
}

static void find_boxes(Drawing *drawing, const RendererOptions *options, const DrawnMesh *mesh)
{
    find_mesh_box(mesh, &drawing->draw, drawing->mesh_box);
    memcpy(drawing->base_box, drawing->mesh_box, sizeof drawing->base_box);
    add_floor_to_box(&options->floor, &drawing->draw, drawing->base_box);
    if (options->backdrop)
        memcpy(drawing->base_box,
               (int[4]){0, 0, (int)drawing->draw.width, (int)drawing->draw.height},
               sizeof drawing->base_box);
}

// A window's samples are those of the whole image shifted by its first sample: x' = x - first. With
// x = (X/W + 1)/2 size for both, X' = X size/size' + W ((size - 2 first)/size' - 1).
void drawing_set_window(Drawing *drawing, const RendererOptions *options, const DrawnMesh *mesh,
                        const int place[2], const int size[2])
{
    const float whole[2] = {drawing->whole.width, drawing->whole.height};
    DrawParams *draw = &drawing->draw;
    *draw = drawing->whole;
    for (int k = 0; k < 2; ++k) {
        double first = place[k] * options->samples, own = size[k] * options->samples,
               scale = (double)whole[k] / own, shift = ((double)whole[k] - 2 * first) / own - 1;
        for (int i = 0; i < 4; ++i)
            draw->clip_from_world[i][k] =
                (float)(scale * (double)drawing->whole.clip_from_world[i][k] +
                        shift * (double)drawing->whole.clip_from_world[i][3]);
        draw->axis[k] -= (float)first;
    }
    draw->width = (float)(size[0] * options->samples);
    draw->height = (float)(size[1] * options->samples);
    draw->band[0] = (uint)(size[0] * options->samples);
    find_boxes(drawing, options, mesh);
}

// Whether the shaders for directional lights and a single ambient colour are enough.
static bool lights_are_simple(const RenderFrame *frame)
{
    for (uint32_t i = 0; i < frame->light_count; ++i)
        if (frame->lights[i].kind != LIGHT_DIRECTIONAL) return false;
    const Ambient *ambient = frame->ambient;
    return !ambient || (!ambient->environment &&
                        memcmp(ambient->sky, ambient->ground, sizeof ambient->sky) == 0);
}

bool drawing_has_wide_lights(const DrawParams *draw)
{
    for (int i = 0; i < draw->light_count; ++i)
        if (draw->light_color[i][3] > 0) return true;
    return false;
}

void drawing_find_middle(const RenderItem *item, vec3 middle)
{
    const HeadPose *head = item->head;
    for (int k = 0; k < 3; ++k) middle[k] = 0.5f * (item->hair->low[k] + item->hair->high[k]);
    if (!head) return;
    glm_quat_rotatev((float *)head->rotation, middle, middle);
    glm_vec3_add(middle, (float *)head->translation, middle);
}

static bool uses_lod(const LodOptions *lod)
{
    return lod->end > lod->start || lod->width > 0;
}

// The share of an item's strands that is drawn, by its level of detail.
static float find_share(const RendererOptions *options, const Drawing *drawing,
                        const RenderItem *item)
{
    const LodOptions *lod = &options->lod;
    const DrawParams *draw = &drawing->draw;
    vec3 middle = {0}, eye = {draw->eye[0], draw->eye[1], draw->eye[2]};
    drawing_find_middle(item, middle);
    float distance = fmaxf(glm_vec3_distance(middle, eye), draw->near_distance), share = 1;
    if (lod->end > lod->start)
        share -= (1 - lod->least) *
                 fminf(fmaxf((distance - lod->start) / (lod->end - lod->start), 0), 1);
    if (lod->width > 0)
        share = fminf(share, 2 * item->radius * draw->focal /
                                 (distance * lod->width * (float)options->samples));
    return fmaxf(share, lod->least);
}

static unsigned shadow_features(const RendererOptions *options, const DrawnMesh *mesh)
{
    unsigned by_mesh = mesh->mesh.triangle_count ? LOOK_SHADOW_BY_MESH : 0;
    switch (options->shadow.kind) {
    case SHADOW_APPROX:
        return LOOK_SHADOW_APPROX | by_mesh;
    case SHADOW_DOM:
        return LOOK_SHADOW_DOM | by_mesh;
    default:
        return 0;
    }
}

static Result make_room(Drawing *drawing, Error *error)
{
    if (drawing->look_room >= drawing->item_count) return RESULT_OK;
    Look *looks = realloc(drawing->looks, drawing->item_count * sizeof *looks);
    if (!looks)
        return error_set(error, RESULT_FAILED, "no memory for %u sections", drawing->item_count);
    drawing->looks = looks;
    drawing->look_room = drawing->item_count;
    return RESULT_OK;
}

static void fit_albedo(Look *look, FibreTable table)
{
    float *fit = look->material.albedo;
    fibre_lobes_fit_albedo(table, fit);
    for (int k = 0; k < 3; ++k)
        look->material.mean_albedo[k] =
            fit[0] + (1 - fit[0]) * powf(fminf(look->mean_color[k], 1), fit[1]);
}

// `features`: the features that do not depend on the item.
static Result make_look(Drawing *drawing, const RendererOptions *options, const RenderItem *item,
                        unsigned features, Look *look, Error *error)
{
    *look = (Look){.material = drawing_material(item->material, item->radius),
                   .features = features,
                   .light_count = drawing->draw.light_count,
                   .share = 1};
    if (uses_lod(&options->lod)) look->share = find_share(options, drawing, item);
    look->material.radius /= look->share;
    if (item->material->smooth > 1) look->features |= LOOK_SMOOTH;
    if (item->hair->alike) look->material.color_variation = look->material.warmth_variation = 0;
    if (options->aov != AOV_NONE || item->material->shading != SHADING_MARSCHNER) return RESULT_OK;
    look->features |= LOOK_MARSCHNER;
    const float *mean = item->hair->is_painted ? item->hair->paint_mean : look->material.color;
    memcpy(look->mean_color, mean, sizeof look->mean_color);
    if (item->material->lobes == LOBES_GAUSS) look->features |= LOOK_GAUSS;
    ScatterTable *table;
    TRY(scatter_tables_find(&drawing->tables, item->material->refraction,
                            glm_rad(item->material->azimuthal_roughness), &table, error));
    TRY(scatter_table_read(table, &look->table, error));
    look->scatter = scatter_table_texture(table);
    fit_albedo(look, look->table);
    return RESULT_OK;
}

Result drawing_begin(Drawing *drawing, const RendererOptions *options, const DrawnMesh *mesh,
                     const RenderFrame *frame, const RenderItem *items, uint32_t item_count,
                     Error *error)
{
    static const unsigned aovs[] = {0, LOOK_WHITE, LOOK_WHITE, LOOK_TANGENT, LOOK_STRAND}; // [Aov]
    unsigned features = aovs[options->aov];
    fill_draw_params(options, mesh, frame, &drawing->draw);
    drawing->items = items;
    drawing->item_count = item_count;
    set_widths(drawing, frame);
    if (options->aov == AOV_NONE)
        features = (lights_are_simple(frame) ? 0 : LOOK_LIGHTS) |
                   (drawing_has_wide_lights(&drawing->draw) ? LOOK_WIDE : 0) |
                   shadow_features(options, mesh);
    drawing->whole = drawing->draw;
    find_boxes(drawing, options, mesh);
    TRY(make_room(drawing, error));
    for (uint32_t i = 0; i < item_count; ++i)
        TRY(make_look(drawing, options, &items[i], features, &drawing->looks[i], error));
    return RESULT_OK;
}

void drawing_destroy(Drawing *drawing)
{
    scatter_tables_destroy(&drawing->tables);
    backdrop_destroy(&drawing->backdrop);
    free(drawing->looks);
    *drawing = (Drawing){0};
}

void drawing_upload(Drawing *drawing)
{
    gpu_uniforms_set(BIND_DRAW, &drawing->draw, sizeof drawing->draw);
}

uint64_t drawing_count_segments(const Drawing *drawing)
{
    uint64_t count = 0;
    for (uint32_t i = 0; i < drawing->item_count; ++i)
        count +=
            drawing->items[i].hair->segment_count * (uint64_t)drawing->items[i].material->smooth;
    return count;
}
