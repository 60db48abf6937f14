// SPDX-License-Identifier: MIT
#include "run/images.h"
#include "draw/hair_paint.h"
#include "draw/openness.h"
#include "draw/scalp_tint.h"
#include "scene/camera.h"
#include "strands/paint.h"

#include <stdlib.h>
#include <string.h>

// Refuses a colour that changes over time if colours vary along the strands: in that case `paint`
// has the section's colour of the start baked into each vertex.
static Result refuse_changes(const Section *section, const Strands *strands, const Paint *paint,
                             Error *error)
{
    static const char *const NAMES[] = {"color", "transmission", "melanin"};
    const SectionParams *params = &section->params;
    bool opacity = params->file_opacity && !strands_are_opaque(strands);
    if (!paint->color || paint->colors_from_file || *params->color_map) return RESULT_OK;
    for (size_t i = 0; i < sizeof NAMES / sizeof *NAMES; ++i)
        if (section_tracks_has(&section->tracks, params_find(NAMES[i])))
            return error_set(error, RESULT_USAGE,
                             "%s: it cannot change over time with %s: expected one value, or %s",
                             NAMES[i],
                             params->tip_length > 0 ? "tips of another color"
                             : opacity              ? "the file's opacities"
                                                    : "the file's thickness",
                             params->tip_length > 0 ? "--tip-length 0"
                             : opacity              ? "--no-file-opacity"
                                                    : "--no-file-thickness");
    return RESULT_OK;
}

static Result paint_section(Images *images, uint32_t i, Error *error)
{
    SimulationSection *section = &images->simulation->sections[i];
    const Section *look = &images->scene->sections[i];
    const Strands *strands = &images->assets->strands[i];
    const GpuLimits *limits = &images->gpu->limits;
    Paint paint;
    Result result = paint_create(&paint, strands, &look->params, error);
    THEN(result, refuse_changes(look, strands, &paint, error));
    THEN(result, hair_paint_upload(&section->hair, strands, &paint, limits, error));
    if (result == RESULT_OK && section->follow.per_guide)
        result = hair_paint_upload(&section->follow.hair, strands, &paint, limits, error);
    paint_destroy(&paint);
    return result == RESULT_USAGE ? error_prefix(error, result, "%s: ", look->file) : result;
}

static Result create_items(Images *images, Error *error)
{
    images->items = calloc(2 * (size_t)images->scene->section_count + 1, sizeof *images->items);
    if (!images->items)
        return error_set(error, RESULT_FAILED, "no memory for %u sections",
                         images->scene->section_count);
    for (uint32_t i = 0; i < images->scene->section_count; ++i) {
        const SimulationSection *section = &images->simulation->sections[i];
        const SectionParams *params = section->params;
        if (params->hidden) continue;
        float radius = paint_radius(params, &images->assets->strands[i], section->follow.per_guide);
        TRY(paint_section(images, i, error));
        images->items[images->item_count++] = (RenderItem){&section->hair, params, radius};
        if (section->follow.per_guide)
            images->items[images->item_count++] =
                (RenderItem){&section->follow.hair, params, radius};
    }
    return RESULT_OK;
}

// For --aov depth, floats hold metres; PNG files map the range from the scene's nearest to its
// farthest point to white and black.
static void set_depth_range(const Images *images, RendererOptions *options)
{
    if (options->aov == AOV_DEPTH && options->kind != IMAGE_FLOAT)
        camera_depth_range(options->depth_range, images->scene, images->framing);
}

static RendererOptions describe_images(const Images *images, ImageKind kind)
{
    const RunParams *run = &images->scene->run;
    RendererOptions options = renderer_options_of(run);
    options.exposure = run->exposure.value;
    options.tone = (Tone)run->tone_map;
    options.kind = kind;
    options.aov = (Aov)run->aov;
    options.mesh_shading = (MeshShading)run->mesh_shading;
    options.floor = floor_find(images->scene, images->framing);
    set_depth_range(images, &options);
    return options;
}

// Computes how much of the sky each vertex of the mesh sees, for the shading of skin.
static Result open_sky(Images *images, Error *error)
{
    const Assets *assets = images->assets;
    const RendererOptions *options = &images->renderer.options;
    uint32_t count = 0, sections = images->scene->section_count;
    if (!assets->has_mesh || options->mesh_shading != MESH_SKIN || options->aov != AOV_NONE)
        return RESULT_OK;
    OpennessHair *hair = calloc((size_t)sections + 1, sizeof *hair);
    float *open = malloc((size_t)assets->mesh.vertex_count * sizeof *open + 1);
    Result result = RESULT_OK;
    if (!hair || !open) result = error_set(error, RESULT_FAILED, "no memory for the mesh's sky");
    for (uint32_t i = 0; i < sections && result == RESULT_OK; ++i) {
        const SectionParams *params = &images->scene->sections[i].params;
        uint32_t followers = images->simulation->sections[i].follow.per_guide;
        if (params->hidden) continue;
        hair[count++] =
            (OpennessHair){.strands = &assets->strands[i],
                           .radius = paint_radius(params, &assets->strands[i], followers),
                           .each = 1 + (float)followers};
    }
    THEN(result, openness_find(open, &assets->mesh, hair, count, error));
    THEN(result, renderer_set_openness(&images->renderer, open, error));
    free(hair);
    free(open);
    return result;
}

static Result list_scalp_hair(const Images *images, ScalpHair *hair, Paint *paints, uint32_t *count,
                              Error *error)
{
    for (uint32_t i = 0; i < images->scene->section_count; ++i) {
        const SectionParams *params = &images->scene->sections[i].params;
        const Strands *strands = &images->assets->strands[i];
        uint32_t followers = images->simulation->sections[i].follow.per_guide;
        const SectionParams seen = paint_as_seen(params);
        if (params->hidden) continue;
        Paint *paint = &paints[*count];
        TRY(paint_create(paint, strands, &seen, error));
        ScalpHair *own = &hair[(*count)++];
        *own = (ScalpHair){.strands = strands,
                           .paint = paint,
                           .radius = paint_radius(params, strands, followers),
                           .each = 1 + (float)followers};
        paint_color(&seen, own->color);
    }
    return RESULT_OK;
}

// Gives the scalp the tint of its roots, of the colours at the start.
static Result tint_scalp(Images *images, Error *error)
{
    const Assets *assets = images->assets;
    const RunParams *run = &images->scene->run;
    uint32_t count = 0, sections = images->scene->section_count;
    if (!assets->has_mesh || run->scalp_tint == 0 || run->aov != AOV_NONE) return RESULT_OK;
    ScalpHair *hair = calloc((size_t)sections + 1, sizeof *hair);
    Paint *paints = calloc((size_t)sections + 1, sizeof *paints);
    float(*tint)[3] = malloc((size_t)assets->mesh.vertex_count * sizeof *tint + 1);
    Result result = RESULT_OK;
    if (!hair || !paints || !tint)
        result = error_set(error, RESULT_FAILED, "no memory for the tint of the scalp");
    THEN(result, list_scalp_hair(images, hair, paints, &count, error));
    THEN(result, scalp_tint_find(tint, &assets->mesh, images->renderer.mesh.color, run->scalp_tint,
                                 hair, count, error));
    THEN(result, renderer_set_tint(&images->renderer, (const float(*)[3])tint, error));
    for (uint32_t i = 0; paints && i < sections; ++i) paint_destroy(&paints[i]);
    free(hair);
    free(paints);
    free(tint);
    return result;
}

static Result open_one(Images *images, Renderer *renderer, const RendererOptions *options,
                       GpuTimer *timer, Error *error)
{
    const Assets *assets = images->assets;
    TRY(renderer_create(renderer, images->gpu, timer, options, error));
    if (!assets->has_mesh) return RESULT_OK;
    return renderer_set_mesh(renderer, &assets->mesh, images->scene->run.mesh_color, error);
}

static Result open_layers(Images *images, const RendererOptions *options, GpuTimer *timer,
                          Error *error)
{
    static const Aov aovs[EXR_LAYERS] = {[EXR_COVERAGE] = AOV_COVERAGE,
                                         [EXR_DEPTH] = AOV_DEPTH,
                                         [EXR_TANGENT] = AOV_TANGENT,
                                         [EXR_STRAND] = AOV_STRAND};
    images->layers = calloc(EXR_LAYERS, sizeof *images->layers);
    if (!images->layers) return error_set(error, RESULT_FAILED, "no memory for layers");
    for (int l = 0; l < EXR_LAYERS; ++l) {
        RendererOptions layer = *options;
        layer.aov = aovs[l];
        layer.background[3] = 1;
        TRY(open_one(images, &images->layers[l], &layer, timer, error));
    }
    return RESULT_OK;
}

static Result copy_body(Images *images, Error *error)
{
    const Mesh *mesh = &images->assets->mesh;
    if (!images->scene->body) return RESULT_OK;
    TRY(mesh_create(&images->body, mesh->vertex_count, mesh->triangle_count, error));
    memcpy(images->body.triangle, mesh->triangle, mesh->triangle_count * sizeof *mesh->triangle);
    images->body_shape = bound_body_shape(&images->simulation->body, 0);
    return RESULT_OK;
}

static Result open_all(Images *images, const ImagesForm *form, GpuTimer *timer, Error *error)
{
    const RendererOptions options = describe_images(images, form->kind);
    TRY(open_one(images, &images->renderer, &options, timer, error));
    if (form->layers) TRY(open_layers(images, &options, timer, error));
    TRY(create_items(images, error));
    TRY(copy_body(images, error));
    TRY(open_sky(images, error));
    return tint_scalp(images, error);
}

Result images_create(Images *images, const Scene *scene, const Assets *assets,
                     Simulation *simulation, const Framing *framing, const ImagesForm *form,
                     const Gpu *gpu, GpuTimer *timer, Error *error)
{
    *images = (Images){
        .scene = scene, .assets = assets, .simulation = simulation, .framing = framing, .gpu = gpu};
    return open_all(images, form, timer, error);
}

void images_destroy(Images *images)
{
    renderer_destroy(&images->renderer);
    for (int l = 0; l < EXR_LAYERS && images->layers; ++l) renderer_destroy(&images->layers[l]);
    free(images->layers);
    free(images->items);
    mesh_destroy(&images->body);
    *images = (Images){0};
}

static int count_layers(const Images *images)
{
    return images->layers ? EXR_LAYERS : 0;
}

// Moves the mesh to its pose at the simulation's time.
static void move_mesh(Images *images)
{
    Simulation *simulation = images->simulation;
    if (!images->body.vertex_count) return;
    double shape = bound_body_shape(&simulation->body, simulation->time);
    if (shape == images->body_shape) return;
    const BodyPose *pose = bound_body_pose(&simulation->body, simulation->time);
    images->body_shape = shape;
    memcpy(images->body.position, pose->position,
           images->body.vertex_count * sizeof *pose->position);
    mesh_compute_normals(&images->body);
    renderer_move_mesh(&images->renderer, &images->body);
    for (int l = 0; l < count_layers(images); ++l)
        renderer_move_mesh(&images->layers[l], &images->body);
}

// Updates radii that change over time. Everything else of a look is read from the parameters.
static void take_radii(Images *images)
{
    for (uint32_t i = 0, item = 0; i < images->scene->section_count; ++i) {
        const SimulationSection *section = &images->simulation->sections[i];
        if (section->params->hidden) continue;
        bool changes =
            section_tracks_has(&images->scene->sections[i].tracks, params_find("radius"));
        for (int k = 0; k < (section->follow.per_guide ? 2 : 1); ++k, ++item)
            if (changes) images->items[item].radius = section->params->radius.value;
    }
}

static Result begin_by(Images *images, Renderer *renderer, int frame, const View *view,
                       Image *image, Error *error)
{
    const Scene *scene = images->scene;
    const Simulation *simulation = images->simulation;
    Ambient ambient = {0};
    Light lights[SCENE_MAX_LIGHTS];
    camera_lights(lights, scene, images->framing, frame);
    RenderFrame drawn = {.view = view,
                         .lights = lights,
                         .light_count = scene->light_count,
                         .ambient = &ambient,
                         .revision = 1 + simulation->changes};
    if (images->assets->environment.parts)
        ambient = (Ambient){.environment = &images->assets->environment,
                            .axes = camera_environment(scene, frame),
                            .strength = scene->run.environment_strength};
    memcpy(ambient.sky, scene->run.sky, sizeof ambient.sky);
    memcpy(ambient.ground, scene->run.ground, sizeof ambient.ground);
    memcpy(drawn.head_rotation, simulation->head.rotation, sizeof drawn.head_rotation);
    memcpy(drawn.head_translation, simulation->head.translation, sizeof drawn.head_translation);
    return renderer_begin(renderer, &drawn, images->items, images->item_count, image, error);
}

Result images_begin(Images *images, int frame, const View *view, Image *image,
                    Image layers[EXR_LAYERS], Error *error)
{
    move_mesh(images);
    take_radii(images);
    TRY(begin_by(images, &images->renderer, frame, view, image, error));
    for (int l = 0; l < count_layers(images); ++l)
        TRY(begin_by(images, &images->layers[l], frame, view, &layers[l], error));
    return RESULT_OK;
}

bool images_are_late(const Images *images)
{
    return renderer_is_late(&images->renderer);
}

int images_place(const Images *images)
{
    return renderer_place(&images->renderer);
}

Result images_settle(Images *images, Error *error)
{
    TRY(renderer_settle(&images->renderer, error));
    for (int l = 0; l < count_layers(images); ++l) TRY(renderer_settle(&images->layers[l], error));
    return RESULT_OK;
}

Result images_take(Images *images, int place, Image *image, Image layers[EXR_LAYERS], Error *error)
{
    TRY(renderer_take(&images->renderer, place, image, error));
    for (int l = 0; l < count_layers(images); ++l)
        TRY(renderer_take(&images->layers[l], place, &layers[l], error));
    return RESULT_OK;
}

Result images_draw(Images *images, int frame, const View *view, Image *image, Error *error)
{
    Renderer *renderer = &images->renderer;
    int place = renderer_place(renderer);
    move_mesh(images);
    take_radii(images);
    TRY(begin_by(images, renderer, frame, view, image, error));
    TRY(renderer_settle(renderer, error));
    return renderer_take(renderer, place, image, error);
}
