// SPDX-License-Identifier: MIT
#include "bench/light_stage.h"
#include "base/interrupt.h"
#include "bench/scene_words.h"

#include <stdlib.h>
#include <string.h>

static const char USUAL[] = "--quiet --frames 1 --exposure 0 --tone-map none -o light.pfm";

// A path-traced case states the light that its fibres transmit. Scenes of an older tractrix-render
// store it as the colour.
static void take_transmission(Scene *scene)
{
    const size_t color = (size_t)(params_find("color") - PARAM_TABLE);
    for (uint32_t i = 0; i < scene->section_count; ++i) {
        SectionParams *params = &scene->sections[i].params;
        if (!scene->sections[i].origin[color] || !params->transmission.automatic) continue;
        params->transmission.automatic = false;
        memcpy(params->transmission.value, params->color, sizeof params->color);
    }
}

Result light_stage_create(LightStage *stage, const Gpu *gpu, const char *file,
                          const char *const flags[3], Error *error)
{
    Scene *scene = &stage->scene;
    *stage = (LightStage){0};
    gpu_timer_create(&stage->timer, false, gpu->software);
    const char *const names[] = {file, NULL};
    const char *const all[SCENE_WORDS_FLAGS] = {USUAL, flags[0], flags[1], flags[2]};
    TRY(scene_words_read(&stage->scene, &stage->words, names, all, error));
    take_transmission(scene);
    TRY(assets_load(&stage->assets, scene, NULL, false, error));
    const Mesh *meshes = stage->assets.meshes;
    outline_frame(&stage->framing, scene, stage->assets.strands, meshes);
    TRY(simulation_create(&stage->simulation, gpu, &stage->timer, scene, stage->assets.strands,
                          meshes, error));
    while (simulation_settle(&stage->simulation))
        if (interrupt_requested()) return error_set(error, RESULT_INTERRUPTED, "interrupted");
    simulation_pose(&stage->simulation);
    TRY(images_create(&stage->images, scene, &stage->assets, &stage->simulation, &stage->framing,
                      &(ImagesForm){.kind = IMAGE_FLOAT}, gpu, &stage->timer, error));
    camera_view(&stage->view, scene, &stage->framing, 0);
    return image_create_kind(&stage->image, scene->run.size[0], scene->run.size[1],
                             renderer_channels(&stage->images.renderer), IMAGE_FLOAT, error);
}

void light_stage_destroy(LightStage *stage)
{
    image_destroy(&stage->image);
    images_destroy(&stage->images);
    if (stage->simulation.scene) simulation_destroy(&stage->simulation);
    gpu_timer_destroy(&stage->timer);
    assets_destroy(&stage->assets);
    scene_destroy(&stage->scene);
    free(stage->words);
    *stage = (LightStage){0};
}

Result light_stage_draw(LightStage *stage, bool moved, Error *error)
{
    if (interrupt_requested()) return error_set(error, RESULT_INTERRUPTED, "interrupted");
    stage->simulation.changes += moved;
    return images_draw(&stage->images, 0, &stage->view, &stage->image, error);
}
