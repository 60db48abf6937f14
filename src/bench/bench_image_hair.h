// SPDX-License-Identifier: MIT
// Hair before a camera that frames it: what benchmarks of drawing draw.
#pragma once

#include "scene/camera.h"
#include "scene/scene.h"
#include "sim/hair.h"

typedef struct ImageHair {
    const char *set, *file; // where it comes from, borrowed: one of both
    char name[64];          // of it, without folders
    Scene scene;            // of one section, all at its defaults
    Strands strands;
    Hair hair;
    float radius; // of its fibres, m
    View view;
} ImageHair;

// The strands of a set: straight, curls, curls100k, fur or a name that strands_make_set knows; with
// a set of NULL those of a file.
Result image_hair_read(Strands *strands, const char *set, const char *file, Error *error);

// Pictures of it are size[0] x size[1] px. It may be destroyed in either case, or zeroed.
Result image_hair_create(ImageHair *hair, const Gpu *gpu, const char *set, const char *file,
                         const int size[2], Error *error);
void image_hair_destroy(ImageHair *hair);
