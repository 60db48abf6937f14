// SPDX-License-Identifier: MIT
// Draws a run's frames: the renderer and the output that the scene asks for.
#pragma once

#include "draw/renderer.h"
#include "run/output.h"
#include "scene/assets.h"
#include "scene/outline.h"
#include "sim/simulation.h"

// A zeroed struct draws nothing and may be destroyed.
typedef struct Images {
    const Scene *scene;
    const Assets *assets;
    Simulation *simulation;
    const Framing *framing;
    const Gpu *gpu;
    Renderer renderer;
    RenderItem *items; // of each section, unless hidden, its guides and followers if there are any
    uint32_t item_count;
    Output *output;
} Images;

// `frame_count`: how many frames will be drawn. The arguments outlive the images, which may be
// destroyed (while the context is current) in each case. Errors of renderer_create, paint_create
// and output_create.
Result images_create(Images *images, const Scene *scene, const Assets *assets,
                     Simulation *simulation, const Framing *framing, const Gpu *gpu,
                     GpuTimer *timer, int frame_count, Error *error);
void images_destroy(Images *images);
