// SPDX-License-Identifier: MIT
#include "run/exposure.h"
#include "image/meter.h"
#include "run/images.h"
#include "scene/camera.h"

#include <cglm/cglm.h>

#include <stdlib.h>
#include <string.h>

enum { SIDE = 256 }; // px of the meter's image, at most

typedef struct Meter {
    Scene scene; // borrows all that the scene owns
    GpuTimer timer;
    Simulation simulation;
    Images images;
    Image image;
} Meter;

bool exposure_is_wanted(const Scene *scene)
{
    const RunParams *run = &scene->run;
    return run->exposure.automatic && run->aov == AOV_NONE && *run->output &&
           !scene_draws_floats(run);
}

// The scene as the meter draws it: small, before nothing, light as it is, by the one rasteriser
// that sorts everything, so that both have the same exposure; hair stays as it is put.
static Scene meter_scene(const Scene *scene)
{
    static char hair[] = "put", light[] = "light.pfm";
    Scene small = *scene;
    RunParams *run = &small.run;
    int longest = run->size[0] > run->size[1] ? run->size[0] : run->size[1];
    for (int k = 0; k < 2 && longest > SIDE; ++k) {
        run->size[k] = run->size[k] * SIDE / longest;
        if (run->size[k] < 1) run->size[k] = 1;
    }
    memset(run->background, 0, sizeof run->background);
    run->exposure = (AutoFloat){0};
    run->tone_map = TONE_NONE;
    run->samples = 1;
    run->raster = RASTER_BLOCKS;
    run->oit = OIT_AUTO;
    run->oit_layers = 0;
    run->floor = FLOOR_NONE;
    run->collide_mesh = false;
    run->from_cache = hair;
    run->output = light;
    run->quiet = true;
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

// Puts the hair where the head has it at time 0.
static Result put_hair(Simulation *simulation, Error *error)
{
    const HeadPose head = head_at(simulation->scene, 0);
    uint32_t sections = simulation->scene->section_count;
    size_t count = 0, first = 0;
    for (uint32_t i = 0; i < sections; ++i) count += simulation->sections[i].hair.particle_count;
    float(*positions)[3] = malloc(count * sizeof *positions + 1);
    if (!positions) return error_set(error, RESULT_FAILED, "no memory for %zu points", count);
    Result result = RESULT_OK;
    for (uint32_t i = 0; i < sections && result == RESULT_OK; ++i) {
        const Hair *hair = &simulation->sections[i].hair;
        result = hair_read_positions(hair, positions + first, error);
        first += hair->particle_count;
    }
    carry(positions, first, &head);
    THEN(result, simulation_show(simulation, 0, &head, (const float(*)[3])positions, error));
    free(positions);
    return result;
}

static Result read_meter(Meter *meter, float *exposure, const Framing *framing, Error *error)
{
    const RendererOptions *options = &meter->images.renderer.options;
    View view;
    TRY(image_create_kind(&meter->image, options->width, options->height,
                          renderer_channels(&meter->images.renderer), options->kind, error));
    camera_view(&view, &meter->scene, framing, 0);
    TRY(images_draw(&meter->images, 0, &view, &meter->image, error));
    return meter_exposure(exposure, &meter->image, error);
}

Result exposure_find(float *exposure, const Scene *scene, const Assets *assets,
                     const Framing *framing, const Gpu *gpu, Error *error)
{
    Meter meter = {.scene = meter_scene(scene)};
    gpu_timer_create(&meter.timer, false, gpu->software);
    Result result = simulation_create(&meter.simulation, gpu, &meter.timer, &meter.scene,
                                      assets->strands, &assets->mesh, error);
    THEN(result, put_hair(&meter.simulation, error));
    THEN(result, images_open(&meter.images, &meter.scene, assets, &meter.simulation, framing, gpu,
                             &meter.timer, error));
    THEN(result, read_meter(&meter, exposure, framing, error));
    image_destroy(&meter.image);
    images_destroy(&meter.images);
    if (meter.simulation.scene) simulation_destroy(&meter.simulation);
    gpu_timer_destroy(&meter.timer);
    return result;
}
