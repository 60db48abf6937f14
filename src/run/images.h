// SPDX-License-Identifier: MIT
// Draws a run's frames: the renderer and the output that the scene asks for, or the renderer alone
// for those who look at the pixels themselves.
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
    Renderer *layers;  // [EXR_LAYERS], owned; NULL: none
    RenderItem *items; // of each section, unless hidden, its guides and followers if there are any
    uint32_t item_count;
    Mesh body;                      // of a mesh that deforms: as it is drawn; owned
    double body_shape;              // ... bound_body_shape
    const Fingerprint *fingerprint; // NULL without an output
    Output *output;
} Images;

// `frame_count`: how many frames will be drawn. The arguments outlive the images, which may be
// destroyed (while the context is current) in each case. Errors of renderer_create, paint_create
// and output_create.
Result images_create(Images *images, const Scene *scene, const Assets *assets,
                     Simulation *simulation, const Framing *framing, const Gpu *gpu,
                     GpuTimer *timer, const Fingerprint *fingerprint, int frame_count,
                     Error *error);

// The same without an output: for images_draw alone.
Result images_open(Images *images, const Scene *scene, const Assets *assets, Simulation *simulation,
                   const Framing *framing, const Gpu *gpu, GpuTimer *timer, Error *error);
void images_destroy(Images *images);

// Draws the hair as the simulation has it now, with the lights of frame `frame`. `image` has the
// size of the run, the channels of renderer_channels and the kind of renderer.options. Errors of
// renderer_draw.
Result images_draw(Images *images, int frame, const View *view, Image *image, Error *error);

// The same in steps, as renderer_begin, renderer_settle and renderer_take, and with `layers`: what
// EXR files have beside the image, if they have it.
Result images_begin(Images *images, int frame, const View *view, Image *image,
                    Image layers[EXR_LAYERS], Error *error);
bool images_are_late(const Images *images);
int images_place(const Images *images);
Result images_settle(Images *images, Error *error);
Result images_take(Images *images, int place, Image *image, Image layers[EXR_LAYERS], Error *error);

// The matrices of a view, as EXR files have them: world to camera, and to the image, whose corners
// are (0, 0), at the top left, and (1, 1).
void images_set_matrices(FrameExtra *extra, const View *view);
