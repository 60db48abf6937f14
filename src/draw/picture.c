// SPDX-License-Identifier: MIT
#include "draw/picture.h"

#include "draw/render_uniforms.h"
#include "image/tone.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Light on the mesh that comes from everywhere.
static const float MESH_AMBIENT = 0.15f;

int picture_display(const RendererOptions *options)
{
    bool light = options->kind == IMAGE_FLOAT || options->aov != AOV_NONE;
    return light ? TONE_LIGHT : (int)options->tone;
}

void picture_background(const RendererOptions *options, float light[4])
{
    linear_from_srgb_color(options->background, light);
    for (int k = 0; k < 3; ++k)
        light[k] = options->background[3] * (float)tone_unmap(options->tone, (double)light[k]);
    light[3] = options->background[3];
}

// The picture without the band's values.
static void fill_draw_params(const RendererOptions *options, const RenderMesh *mesh,
                             const RenderFrame *frame, DrawParams *draw)
{
    memset(draw, 0, sizeof *draw);
    draw_params_set_view(draw, frame->view, options->width * options->samples,
                         options->height * options->samples);
    float light = exp2f(options->exposure);
    draw_params_set_lights(draw, frame->lights, frame->light_count);
    for (int k = 0; k < 3; ++k) {
        draw->sky[k] = light * (frame->ambient ? linear_from_srgb(frame->ambient->sky[k]) : 1);
        draw->ground[k] =
            light * (frame->ambient ? linear_from_srgb(frame->ambient->ground[k]) : 1);
        for (uint32_t i = 0; i < frame->light_count; ++i) draw->light_color[i][k] *= light;
    }
    memcpy(draw->depth_range, options->depth_range, sizeof options->depth_range);
    picture_background(options, draw->background);
    memcpy(draw->head_rotation, frame->head_rotation, sizeof draw->head_rotation);
    memcpy(draw->head_translation, frame->head_translation, sizeof frame->head_translation);
    if (options->aov == AOV_NONE) memcpy(draw->mesh_color, mesh->color, sizeof mesh->color);
    draw->mesh_color[3] = MESH_AMBIENT;
    draw->seed = options->seed;
}

// Widens a box of the picture by a point of the world; a point before the near plane makes it as
// wide as can be.
static void add_to_box(DrawParams *draw, vec3 x, int box[4])
{
    vec4 clip;
    const int far = 1 << 20;
    glm_mat4_mulv(draw->clip_from_world, (vec4){x[0], x[1], x[2], 1}, clip);
    if (clip[3] < draw->near_distance) { // crosses the eye's plane: anywhere
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

static void find_mesh_box(const RenderMesh *mesh, DrawParams *draw, int box[4])
{
    const int far = 1 << 20;
    vec3 x;
    box[0] = box[1] = far, box[2] = box[3] = -far;
    for (int corner = 0; corner < 8 && mesh->triangle_count; ++corner) {
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

// Whether the lights ask for more than directions and one ambient colour.
static bool lights_are_simple(const RenderFrame *frame)
{
    for (uint32_t i = 0; i < frame->light_count; ++i)
        if (frame->lights[i].kind != LIGHT_DIRECTIONAL) return false;
    const Ambient *ambient = frame->ambient;
    return !ambient || memcmp(ambient->sky, ambient->ground, sizeof ambient->sky) == 0;
}

void picture_find_middle(const Picture *picture, const Hair *hair, vec3 middle)
{
    versor turn = {0};
    memcpy(turn, picture->draw.head_rotation, sizeof turn);
    for (int k = 0; k < 3; ++k) middle[k] = 0.5f * (hair->low[k] + hair->high[k]);
    glm_quat_rotatev(turn, middle, middle);
    for (int k = 0; k < 3; ++k) middle[k] += picture->draw.head_translation[k];
}

static bool uses_lod(const LodOptions *lod)
{
    return lod->end > lod->start || lod->width > 0;
}

// Share of an item's strands that is drawn.
static float find_share(const RendererOptions *options, const Picture *picture,
                        const RenderItem *item)
{
    const LodOptions *lod = &options->lod;
    const DrawParams *draw = &picture->draw;
    vec3 middle = {0}, eye = {draw->eye[0], draw->eye[1], draw->eye[2]};
    picture_find_middle(picture, item->hair, middle);
    float distance = fmaxf(glm_vec3_distance(middle, eye), draw->near_distance), share = 1;
    if (lod->end > lod->start)
        share -= (1 - lod->least) *
                 fminf(fmaxf((distance - lod->start) / (lod->end - lod->start), 0), 1);
    if (lod->width > 0)
        share = fminf(share, 2 * item->radius * draw->focal /
                                 (distance * lod->width * (float)options->samples));
    return fmaxf(share, lod->least);
}

static unsigned shadow_features(const RendererOptions *options, const RenderMesh *mesh)
{
    unsigned by_mesh = mesh->triangle_count ? LOOK_SHADOW_BY_MESH : 0;
    switch (options->shadow.kind) {
    case SHADOW_APPROX:
        return LOOK_SHADOW_APPROX | by_mesh;
    case SHADOW_DOM:
        return LOOK_SHADOW_DOM | by_mesh;
    default:
        return 0;
    }
}

static Result make_room(Picture *picture, Error *error)
{
    if (picture->look_room >= picture->item_count) return RESULT_OK;
    Look *looks = realloc(picture->looks, picture->item_count * sizeof *looks);
    if (!looks)
        return error_set(error, RESULT_FAILED, "no memory for %u sections", picture->item_count);
    picture->looks = looks;
    picture->look_room = picture->item_count;
    return RESULT_OK;
}

// `features`: those that do not depend on the item.
static Result make_look(Picture *picture, const RendererOptions *options, const RenderItem *item,
                        unsigned features, Look *look, Error *error)
{
    *look = (Look){.material = material_params(item->material, item->radius),
                   .features = features,
                   .light_count = picture->draw.light_count,
                   .share = 1};
    if (uses_lod(&options->lod)) look->share = find_share(options, picture, item);
    look->material.radius /= look->share;
    if (item->material->smooth > 1) look->features |= LOOK_SMOOTH;
    if (item->hair->alike) look->material.color_variation = look->material.warmth_variation = 0;
    if (options->aov != AOV_NONE || item->material->shading != SHADING_MARSCHNER) return RESULT_OK;
    look->features |= LOOK_MARSCHNER;
    if (item->material->lobes == LOBES_GAUSS) look->features |= LOOK_GAUSS;
    return scatter_tables_find(&picture->scatter, item->material->refraction,
                               glm_rad(item->material->azimuthal_roughness), &look->scatter, error);
}

Result picture_begin(Picture *picture, const RendererOptions *options, const RenderMesh *mesh,
                     const RenderFrame *frame, const RenderItem *items, uint32_t item_count,
                     Error *error)
{
    static const unsigned aovs[] = {0, LOOK_WHITE, LOOK_WHITE, LOOK_TANGENT, LOOK_STRAND}; // by Aov
    unsigned features = aovs[options->aov];
    if (options->aov == AOV_NONE)
        features = (lights_are_simple(frame) ? 0 : LOOK_LIGHTS) | shadow_features(options, mesh);
    picture->items = items;
    picture->item_count = item_count;
    fill_draw_params(options, mesh, frame, &picture->draw);
    find_mesh_box(mesh, &picture->draw, picture->mesh_box);
    memcpy(picture->base_box, picture->mesh_box, sizeof picture->base_box);
    add_floor_to_box(&options->floor, &picture->draw, picture->base_box);
    Result result = make_room(picture, error);
    for (uint32_t i = 0; i < item_count && result == RESULT_OK; ++i)
        result = make_look(picture, options, &items[i], features, &picture->looks[i], error);
    return result;
}

void picture_destroy(Picture *picture)
{
    scatter_tables_destroy(&picture->scatter);
    gpu_buffer_destroy(&picture->uniforms);
    free(picture->looks);
    *picture = (Picture){0};
}

void picture_upload(Picture *picture)
{
    gpu_buffer_set_uniforms(&picture->uniforms, BIND_DRAW, &picture->draw, sizeof picture->draw);
}

uint64_t picture_count_segments(const Picture *picture)
{
    uint64_t count = 0;
    for (uint32_t i = 0; i < picture->item_count; ++i)
        count +=
            picture->items[i].hair->segment_count * (uint64_t)picture->items[i].material->smooth;
    return count;
}

uint64_t picture_count_thinned(const Picture *picture)
{
    uint64_t count = 0;
    for (uint32_t i = 0; i < picture->item_count; ++i)
        for (uint32_t b = 0; b < picture->items[i].hair->batch_count; ++b) {
            const HairBatch *batch = &picture->items[i].hair->batches[b];
            count += batch->strand_count - look_material(&picture->looks[i], batch).drawn_strands;
        }
    return count;
}
