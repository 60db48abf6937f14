// SPDX-License-Identifier: MIT
// Draws a simulation's hair: the only way from a scene to pixels.
#pragma once

#include "draw/renderer.h"
#include "image/exr_file.h"
#include "run/drawn_bodies.h"
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
    Renderer *layers;  // [EXR_LAYERS], owned; NULL: none
    RenderItem *items; // for each section, unless hidden, its guides and its followers, if any
    uint32_t item_count;
    DrawnBodies bodies;
} Images;

// The kind of pixels, and whether there are EXR layers too.
typedef struct ImagesForm {
    ImageKind kind;
    bool layers;
} ImagesForm;

// The arguments, except `form`, must outlive the images, which may be destroyed (while the context
// is current) in either case. Errors of renderer_create and paint_create.
Result images_create(Images *images, const Scene *scene, const Assets *assets,
                     Simulation *simulation, const Framing *framing, const ImagesForm *form,
                     const Gpu *gpu, GpuTimer *timer, Error *error);
void images_destroy(Images *images);

// Draws the simulation's current hair with the lights of frame `frame`. `image` has the run's size,
// the channels of renderer_channels and the kind of renderer.options. Errors of renderer_draw.
Result images_draw(Images *images, int frame, const View *view, Image *image, Error *error);

// The same in steps, like renderer_begin, renderer_settle and renderer_take; `layers`: the layers
// of EXR files, if there are any.
Result images_begin(Images *images, int frame, const View *view, Image *image,
                    Image layers[EXR_LAYERS], Error *error);
bool images_are_late(const Images *images);
int images_place(const Images *images);
Result images_settle(Images *images, Error *error);
Result images_take(Images *images, int place, Image *image, Image layers[EXR_LAYERS], Error *error);
