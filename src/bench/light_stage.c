// SPDX-License-Identifier: MIT
#include "bench/light_stage.h"
#include "base/interrupt.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_WORDS = 64 };

static Result read_scene(LightStage *stage, const char *file, const char *const flags[3],
                         Error *error)
{
    static const char usual[] = "--quiet --frames 1 --exposure 0 --tone-map none -o light.pfm";
    char *argv[MOST_WORDS] = {"tractrix-render", (char *)file}, *rest;
    int argc = 2;
    if (asprintf(&stage->words, "%s %s %s %s", usual, flags[0], flags[1], flags[2]) < 0) {
        stage->words = NULL;
        return error_set(error, RESULT_FAILED, "no memory for flags");
    }
    for (char *word = strtok_r(stage->words, " ", &rest); word; word = strtok_r(NULL, " ", &rest)) {
        if (argc == MOST_WORDS)
            return error_set(error, RESULT_USAGE, "more than %d words of flags", MOST_WORDS);
        argv[argc++] = word;
    }
    TRY(scene_from_arguments(&stage->scene, argc, argv, error));
    return stage->scene.request == REQUEST_RUN
               ? RESULT_OK
               : error_set(error, RESULT_USAGE, "flags that ask for help: expected those of a run");
}

Result light_stage_create(LightStage *stage, const Gpu *gpu, const char *file,
                          const char *const flags[3], Error *error)
{
    const Scene *scene = &stage->scene;
    *stage = (LightStage){0};
    gpu_timer_create(&stage->timer, false, gpu->software);
    TRY(read_scene(stage, file, flags, error));
    TRY(assets_load(&stage->assets, scene, NULL, false, error));
    const Mesh *mesh = stage->assets.has_mesh ? &stage->assets.mesh : NULL;
    outline_frame(&stage->framing, scene, stage->assets.strands, mesh);
    TRY(simulation_create(&stage->simulation, gpu, &stage->timer, scene, stage->assets.strands,
                          mesh, error));
    while (simulation_settle(&stage->simulation))
        if (interrupt_requested()) return error_set(error, RESULT_INTERRUPTED, "interrupted");
    simulation_pose(&stage->simulation);
    TRY(images_open(&stage->images, scene, &stage->assets, &stage->simulation, &stage->framing, gpu,
                    &stage->timer, error));
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
