// SPDX-License-Identifier: MIT
// Widths and colours of a scene's strands as USD's curves have them.
#pragma once

#include "scene/scene.h"
#include "strands/formats/usd_write.h"

// Arrays are owned; a zeroed struct is empty.
typedef struct SceneLook {
    UsdLook usd; // points into the rest
    float *width;
    float (*color)[4];
    uint32_t *section;
} SceneLook;

// The drawn diameters of all vertices of all sections, one behind the other: radius (auto: as if
// these strands alone were drawn), the file's thickness, tip_ratio; and their colours as paint.h
// has them, without the chance by which strands differ: one colour if it is the same everywhere,
// one for each strand if it is the same within sections, else one for each vertex. Sections are
// numbered from 0 if there are several. `all`: the sections joined. Errors of paint_create,
// prefixed with the section's file.
Result scene_look_create(SceneLook *look, const Scene *scene, const Strands *sections,
                         const Strands *all, Error *error);
void scene_look_destroy(SceneLook *look);
