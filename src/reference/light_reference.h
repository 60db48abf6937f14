// SPDX-License-Identifier: MIT
// Light among strands by paths: from the eye, from fibre to fibre, to the lights, in double
// precision.
// The reference for light that cells approximate (light_grid.h).
//
// A strand is a chain of straight cylinders along the Catmull-Rom curve through its vertices. A
// fibre scatters by fibre_reference.h, where the path hits it; the path goes on from the fibre's
// axis and does not hit the same place of the fibre again. There is no mesh.
//
// A light with a radius is a disc that faces each point. It has the same radiance everywhere, so
// that a white matt surface which faces its middle shows color * intensity (scene.h). An
// environment has the same radiance all over each pixel of its image.
#pragma once

#include "base/error.h"
#include "image/image.h"
#include "reference/fibre_reference.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "strands/strands.h"

typedef struct LightReferenceItem {
    const Strands *strands; // m, in the world
    double radius;          // m, the same along the strand
    FibreReference fibre;
} LightReferenceItem;

typedef struct LightReferenceScene {
    const LightReferenceItem *items;
    uint32_t item_count;
    const View *view;
    const Light *lights;
    uint32_t light_count;
    const float *sky, *ground;      // [3] linear radiance from above and below, mixed in between
    const Environment *environment; // replaces both; its image is kept; NULL: none
    EnvironmentAxes axes;           // of the environment
    float strength;                 // factor of the environment's radiance
} LightReferenceScene;

// Draws linear light into `image`, an IMAGE_FLOAT of 3 or 4 channels (the fourth is the coverage),
// on black. `orders`: the most fibres that light meets; 1 is single scattering. `paths`: for each
// pixel, >= 1. `seed` and nothing else changes the noise. RESULT_FAILED when memory is short;
// RESULT_INTERRUPTED (interrupt.h).
Result light_reference_draw(Image *image, const LightReferenceScene *scene, int orders, int paths,
                            uint64_t seed, Error *error);
