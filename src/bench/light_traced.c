// SPDX-License-Identifier: MIT
#include "bench/light_traced.h"
#include "image/image.h"
#include "reference/light_reference.h"
#include "scene/camera.h"
#include "strands/follow_plan.h"
#include "strands/paint.h"

#include <math.h>
#include <string.h>

static bool has_followers(const SectionParams *params, const Strands *strands)
{
    bool given = !params->followers.automatic && params->followers.value >= 0;
    return given ? params->followers.value > 0
                 : strands->followers > 0 || follow_plan_fills(params, strands);
}

// Whether the fibres are alike, with scales that are not tilted, and lie where the file has them.
static bool is_plain(const SectionParams *params, const Strands *strands, const Hair *hair)
{
    return strcmp(params->algo, "none") == 0 && params->shading == SHADING_MARSCHNER &&
           params->cone_angle == 0 && params->tip_ratio == 1 && params->opacity == 1 &&
           params->color_variation == 0 && params->warmth_variation == 0 && !hair->is_painted &&
           !has_followers(params, strands);
}

static Result take_section(const SectionParams *params, const Strands *strands, const Hair *hair,
                           LightReferenceItem *item, Error *error)
{
    float color[3];
    if (!is_plain(params, strands, hair))
        return error_set(error, RESULT_USAGE,
                         "the path tracer: a section has options that the path tracer does not "
                         "support: expected algo none, shading marschner, cone_angle 0, tip_ratio "
                         "1, opacity 1, color_variation 0 and warmth_variation 0, no followers, "
                         "and no colours, opacity or thickness from a file");
    paint_color(params, color);
    *item = (LightReferenceItem){
        .strands = strands,
        .radius = (double)paint_radius(params, strands, 0),
        .fibre = fibre_reference_create(
            (double)params->refraction, (double)params->roughness * M_PI / 180,
            (double)params->azimuthal_roughness * M_PI / 180,
            (const double[]){(double)color[0], (double)color[1], (double)color[2]})};
    return RESULT_OK;
}

static bool has_mesh(const Assets *assets)
{
    bool any = false;
    for (uint32_t i = 0; i < assets->body_count; ++i) any |= assets->meshes[i].triangle_count > 0;
    return any;
}

Result light_traced_draw(LightStage *stage, Image *image, int orders, int paths, Error *error)
{
    const Scene *scene = &stage->scene;
    LightReferenceItem items[SCENE_MAX_SECTIONS];
    Light lights[SCENE_MAX_LIGHTS];
    float around[2][3];
    Environment environment = {0}; // with its image, which assets need not keep
    if (has_mesh(&stage->assets))
        return error_set(error, RESULT_USAGE,
                         "the path tracer: the scene has a mesh: expected hair only");
    for (uint32_t i = 0; i < scene->section_count; ++i)
        TRY(take_section(&scene->sections[i].params, &stage->assets.strands[i],
                         &stage->simulation.sections[i].hair, &items[i], error));
    camera_lights(lights, scene, &stage->framing, 0);
    for (int c = 0; c < 3; ++c) {
        around[0][c] = (float)image_linear_from_srgb((double)scene->run.sky[c]);
        around[1][c] = (float)image_linear_from_srgb((double)scene->run.ground[c]);
    }
    if (*scene->run.environment)
        TRY(environment_read(&environment, scene->run.environment, true, error));
    const LightReferenceScene traced = {.items = items,
                                        .item_count = scene->section_count,
                                        .view = &stage->view,
                                        .lights = lights,
                                        .light_count = scene->light_count,
                                        .sky = around[0],
                                        .ground = around[1],
                                        .environment = environment.parts ? &environment : NULL,
                                        .axes = camera_environment(scene, 0),
                                        .strength = scene->run.environment_strength};
    Result result = light_reference_draw(image, &traced, orders, paths, 1, error);
    environment_destroy(&environment);
    return result;
}
