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
            return error_set(
                error, RESULT_USAGE,
                "%s: cannot change over time, because the hair has %s: expected one value, or %s",
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
        const HeadPose *head = &section->body->head;
        images->items[images->item_count++] = (RenderItem){&section->hair, params, radius, head};
        if (section->follow.per_guide)
            images->items[images->item_count++] =
                (RenderItem){&section->follow.hair, params, radius, head};
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
    options.shadow.strands *= (int)images->scene->body_count; // all bodies share the sample
    options.scatter.strands *= images->scene->body_count;
    options.tone = (Tone)run->tone_map;
    options.kind = kind;
    options.aov = (Aov)run->aov;
    options.mesh_shading = (MeshShading)run->mesh_shading;
    options.floor = floor_find(images->scene, images->framing);
    set_depth_range(images, &options);
    return options;
}

// Computes how much of the sky each vertex of a body sees, for the shading of skin. Other bodies
// and their hair do not count.
static Result find_openness(const Images *images, uint32_t b, float (*open)[2], Error *error)
{
    const SceneBody *body = &images->scene->bodies[b];
    uint32_t count = 0;
    OpennessHair *hair = calloc((size_t)body->section_count + 1, sizeof *hair);
    if (!hair) return error_set(error, RESULT_FAILED, "no memory for the mesh's sky");
    for (uint32_t i = body->first; i < body->first + body->section_count; ++i) {
        const SectionParams *params = &images->scene->sections[i].params;
        const Strands *strands = &images->assets->strands[i];
        uint32_t followers = images->simulation->sections[i].follow.per_guide;
        if (params->hidden) continue;
        hair[count++] = (OpennessHair){.strands = strands,
                                       .radius = paint_radius(params, strands, followers),
                                       .each = 1 + (float)followers};
    }
    Result result = openness_find(open, &images->assets->meshes[b], hair, count, error);
    free(hair);
    return result;
}

static Result open_sky(Images *images, Error *error)
{
    const RendererOptions *options = &images->renderer.options;
    const DrawnBodies *bodies = &images->bodies;
    if (!bodies->mesh.vertex_count || options->mesh_shading != MESH_SKIN ||
        options->aov != AOV_NONE)
        return RESULT_OK;
    float(*open)[2] = malloc((size_t)bodies->mesh.vertex_count * sizeof *open);
    Result result =
        open ? RESULT_OK : error_set(error, RESULT_FAILED, "no memory for the mesh's sky");
    for (uint32_t b = 0; b < images->assets->body_count; ++b)
        if (images->assets->meshes[b].vertex_count)
            THEN(result, find_openness(images, b, open + bodies->bodies[b].first, error));
    THEN(result, renderer_set_openness(&images->renderer, (const float(*)[2])open, error));
    free(open);
    return result;
}

static Result list_scalp_hair(const Images *images, const SceneBody *body, ScalpHair *hair,
                              Paint *paints, uint32_t *count, Error *error)
{
    for (uint32_t i = body->first; i < body->first + body->section_count; ++i) {
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

// Computes the tint that a body's scalp takes from its own roots.
static Result find_tint(const Images *images, uint32_t b, float (*tint)[3], Error *error)
{
    const SceneBody *body = &images->scene->bodies[b];
    uint32_t count = 0;
    ScalpHair *hair = calloc((size_t)body->section_count + 1, sizeof *hair);
    Paint *paints = calloc((size_t)body->section_count + 1, sizeof *paints);
    Result result = RESULT_OK;
    if (!hair || !paints)
        result = error_set(error, RESULT_FAILED, "no memory for the tint of the scalp");
    THEN(result, list_scalp_hair(images, body, hair, paints, &count, error));
    THEN(result, scalp_tint_find(tint, &images->assets->meshes[b], images->renderer.mesh.color,
                                 images->scene->run.scalp_tint, hair, count, error));
    for (uint32_t i = 0; paints && i < body->section_count; ++i) paint_destroy(&paints[i]);
    free(hair);
    free(paints);
    return result;
}

// Gives the scalps the tint of their roots, of the colours at the start.
static Result tint_scalp(Images *images, Error *error)
{
    const RunParams *run = &images->scene->run;
    const DrawnBodies *bodies = &images->bodies;
    if (!bodies->mesh.vertex_count || run->scalp_tint == 0 || run->aov != AOV_NONE)
        return RESULT_OK;
    float(*tint)[3] = malloc((size_t)bodies->mesh.vertex_count * sizeof *tint);
    Result result =
        tint ? RESULT_OK : error_set(error, RESULT_FAILED, "no memory for the tint of the scalp");
    for (uint32_t b = 0; b < images->assets->body_count; ++b)
        if (images->assets->meshes[b].vertex_count)
            THEN(result, find_tint(images, b, tint + bodies->bodies[b].first, error));
    THEN(result, renderer_set_tint(&images->renderer, (const float(*)[3])tint, error));
    free(tint);
    return result;
}

static Result open_one(Images *images, Renderer *renderer, const RendererOptions *options,
                       GpuTimer *timer, Error *error)
{
    TRY(renderer_create(renderer, images->gpu, timer, options, error));
    if (!images->bodies.mesh.vertex_count) return RESULT_OK;
    return renderer_set_mesh(renderer, &images->bodies.mesh, images->scene->run.mesh_color, error);
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
        layer.kind = IMAGE_FLOAT;
        layer.background[3] = 1;
        TRY(open_one(images, &images->layers[l], &layer, timer, error));
    }
    return RESULT_OK;
}

static Result open_all(Images *images, const ImagesForm *form, GpuTimer *timer, Error *error)
{
    const RendererOptions options = describe_images(images, form->kind);
    TRY(drawn_bodies_create(&images->bodies, images->assets, images->simulation, error));
    TRY(open_one(images, &images->renderer, &options, timer, error));
    if (form->layers) TRY(open_layers(images, &options, timer, error));
    TRY(create_items(images, error));
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
    drawn_bodies_destroy(&images->bodies);
    *images = (Images){0};
}

static int count_layers(const Images *images)
{
    return images->layers ? EXR_LAYERS : 0;
}

// Moves the mesh to its pose at the simulation's time.
static void move_mesh(Images *images)
{
    if (!drawn_bodies_move(&images->bodies)) return;
    renderer_move_mesh(&images->renderer, &images->bodies.mesh);
    for (int l = 0; l < count_layers(images); ++l)
        renderer_move_mesh(&images->layers[l], &images->bodies.mesh);
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
            if (changes)
                images->items[item].radius =
                    section->params->radius.value * section->params->width_scale;
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
    const HeadPose *head = &simulation->bodies[0].head; // of DrawnBodies.mesh
    memcpy(drawn.head_rotation, head->rotation, sizeof drawn.head_rotation);
    memcpy(drawn.head_translation, head->translation, sizeof drawn.head_translation);
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
