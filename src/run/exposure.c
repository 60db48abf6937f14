// SPDX-License-Identifier: MIT
#include "run/exposure.h"
#include "image/meter.h"
#include "run/images.h"
#include "scene/camera.h"

#include <cglm/cglm.h>

#include <stdlib.h>
#include <string.h>

enum { SIDE = 256 }; // px: longer side of the meter's image, at most

// The meter draws two images: the lit scene, and the coverage of hair, which weights the first.
enum { LIGHT, HAIR, DRAWINGS };

typedef struct Meter {
    Scene scene[DRAWINGS]; // scene[LIGHT] owns the sections of both; everything else is borrowed
    GpuTimer timer;
    Simulation simulation;
    Image image[DRAWINGS];
} Meter;

bool exposure_is_wanted(const RunParams *run, ImageKind kind)
{
    return run->exposure.automatic && run->aov == AOV_NONE && kind != IMAGE_FLOAT;
}

// Gives a section's hair the colour of a grey card, without anything that would make its colour
// depend on the groom. The section borrows everything but its tracks.
static Result make_grey(Section *grey, const Section *section, Error *error)
{
    static char none[] = "";
    SectionParams *params = &grey->params;
    *grey = *section;
    grey->tracks = (SectionTracks){0};
    params->color_map = none;
    params->file_colors = false;
    params->transmission = (AutoVec3){.automatic = true};
    params->melanin = (AutoFloat){.automatic = true};
    params->tip_length = 0;
    for (int k = 0; k < 3; ++k) params->color[k] = (float)image_srgb_from_linear(METER_GREY);
    TRY(section_tracks_copy(&grey->tracks, &section->tracks, error));
    static const char *const VARIED[] = {"color", "transmission", "melanin", "tip_length"};
    for (size_t i = 0; i < sizeof VARIED / sizeof *VARIED; ++i)
        section_tracks_drop(&grey->tracks, params_find(VARIED[i]));
    return RESULT_OK;
}

static Result make_all_grey(Scene *small, const Scene *scene, Error *error)
{
    small->sections = calloc((size_t)scene->section_count + 1, sizeof *small->sections);
    if (!small->sections) return error_set(error, RESULT_FAILED, "no memory for the exposure");
    Result result = RESULT_OK;
    for (uint32_t i = 0; i < scene->section_count; ++i)
        THEN(result, make_grey(&small->sections[i], &scene->sections[i], error));
    return result;
}

static void destroy_grey(Scene *small)
{
    for (uint32_t i = 0; small->sections && i < small->section_count; ++i)
        section_tracks_destroy(&small->sections[i].tracks);
    free(small->sections);
}

// The scene that the meter draws: small, on black, without tone curve. It is always drawn by
// `blocks`, so that the exposure does not depend on --raster. "put" makes the simulation show given
// positions.
static Scene meter_scene(const Scene *scene, Aov aov)
{
    static char hair[] = "put";
    Scene small = *scene;
    RunParams *run = &small.run;
    int longest = run->size[0] > run->size[1] ? run->size[0] : run->size[1];
    for (int k = 0; k < 2 && longest > SIDE; ++k) {
        run->size[k] = run->size[k] * SIDE / longest;
        if (run->size[k] < 1) run->size[k] = 1;
    }
    memset(run->background, 0, sizeof run->background);
    run->environment_background = false;
    run->aov = aov;
    run->exposure = (AutoFloat){0};
    run->tone_map = TONE_NONE;
    run->samples = 1;
    run->raster = RASTER_BLOCKS;
    run->ribbon_length = 1; // in a small image longer ribbons would change the exposure
    run->oit = OIT_AUTO;
    run->oit_layers = 0;
    run->floor = FLOOR_NONE;
    for (uint32_t b = 0; b < small.body_count; ++b) small.bodies[b].params.collide_mesh = false;
    run->from_cache = hair;
    run->quiet = true;
    small.sections = NULL;
    return small;
}

static void carry(float (*positions)[3], size_t count, const HeadPose *head)
{
    versor rotation = {0};
    memcpy(rotation, head->rotation, sizeof rotation);
    for (size_t i = 0; i < count; ++i) {
        vec3 x = {positions[i][0], positions[i][1], positions[i][2]};
        glm_quat_rotatev(rotation, x, x);
        for (int k = 0; k < 3; ++k) positions[i][k] = x[k] + head->translation[k];
    }
}

// Moves the hair with the head to its pose at time 0.
static Result put_hair(Simulation *simulation, Error *error)
{
    uint32_t sections = simulation->scene->section_count;
    size_t count = 0, first = 0;
    for (uint32_t i = 0; i < sections; ++i) count += simulation->sections[i].hair.particle_count;
    float(*positions)[3] = malloc(count * sizeof *positions + 1);
    if (!positions) return error_set(error, RESULT_FAILED, "no memory for %zu points", count);
    Result result = RESULT_OK;
    for (uint32_t i = 0; i < sections && result == RESULT_OK; ++i) {
        const SimulationSection *section = &simulation->sections[i];
        result = hair_read_positions(&section->hair, positions + first, error);
        carry(positions + first, section->hair.particle_count, &section->body->head);
        first += section->hair.particle_count;
    }
    const HeadPose head = simulation->bodies[0].head;
    THEN(result, simulation_show(simulation, 0, &head, (const float(*)[3])positions, error));
    free(positions);
    return result;
}

static Result draw(Meter *meter, int which, const Assets *assets, const Framing *framing,
                   const Gpu *gpu, Error *error)
{
    const Scene *scene = &meter->scene[which];
    Image *image = &meter->image[which];
    Images images;
    View view;
    camera_view(&view, scene, framing, 0);
    Result result = images_create(&images, scene, assets, &meter->simulation, framing,
                                  &(ImagesForm){.kind = IMAGE_FLOAT}, gpu, &meter->timer, error);
    const RendererOptions *options = &images.renderer.options;
    THEN(result, image_create_kind(image, options->width, options->height,
                                   renderer_channels(&images.renderer), options->kind, error));
    THEN(result, images_draw(&images, 0, &view, image, error));
    images_destroy(&images);
    return result;
}

Result exposure_find(float *exposure, const Scene *scene, const Assets *assets,
                     const Framing *framing, const Gpu *gpu, Error *error)
{
    Meter meter = {.scene = {meter_scene(scene, AOV_NONE), meter_scene(scene, AOV_COVERAGE)}};
    gpu_timer_create(&meter.timer, false, gpu->software);
    Result result = make_all_grey(&meter.scene[LIGHT], scene, error);
    meter.scene[HAIR].sections = meter.scene[LIGHT].sections;
    THEN(result, simulation_create(&meter.simulation, gpu, &meter.timer, &meter.scene[LIGHT],
                                   assets->strands, assets->meshes, error));
    THEN(result, put_hair(&meter.simulation, error));
    for (int i = 0; i < DRAWINGS; ++i) THEN(result, draw(&meter, i, assets, framing, gpu, error));
    THEN(result, meter_exposure(exposure, &meter.image[LIGHT], &meter.image[HAIR],
                                (Tone)scene->run.tone_map, error));
    for (int i = 0; i < DRAWINGS; ++i) image_destroy(&meter.image[i]);
    if (meter.simulation.scene) simulation_destroy(&meter.simulation);
    gpu_timer_destroy(&meter.timer);
    destroy_grey(&meter.scene[LIGHT]);
    return result;
}
