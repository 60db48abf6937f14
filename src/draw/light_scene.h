// SPDX-License-Identifier: MIT
// Input for the light among hair (light_grid.h): hair, lights, eye and mesh.
#pragma once

#include "base/error.h"
#include "draw/fibre_lobes.h"
#include "draw/light_blocks.h"
#include "draw/mapped_caster.h"
#include "draw/renderer_options.h"

#include "glsl/draw/draw.h"

enum { LIGHT_GRID_KINDS = 4 }; // of fibres that scatter in ways of their own; others share the last

// A batch of hair that receives and scatters light.
typedef struct GridHair {
    MappedCaster caster;
    int kind; // of its fibres
} GridHair;

typedef struct GridScene {
    const GridHair *hair;
    uint32_t hair_count;
    const FibreLobes *kinds; // [kind_count]
    int kind_count;          // 1 .. LIGHT_GRID_KINDS
    const DrawParams *draw;  // lights, sky, ground, eye
    const Ambient *ambient;  // its environment; NULL: none
    // That tells light_grid_solve what is left of lights (lanes/shadow.h); NULL: no light has a
    // map.
    const struct LaneShadow *shadow;
    float to_eye[3];        // unit, world: against the way that the camera looks
    int map_of[MAX_LIGHTS]; // of each light; -1: it casts no shadow
    LightBlocks *blocks; // filled for the lattice: what the mesh takes away within the box of hair;
                         // NULL: no mesh
    bool suns;           // the lights' light is followed, too, not only that of the sky
    uint32_t step;       // of so many strands one stands for all in the cells; 0: 1
    int cells;           // along the longest side of the box, 4 .. 64
    int orders; // of scattering that are swept at most, 0 .. 32; 0: the sky's own light alone
} GridScene;

// Whether there is ambient light (sky or ground).
static inline bool light_scene_has_sky(const DrawParams *draw)
{
    for (int c = 0; c < 3; ++c)
        if (draw->sky[c] > 0 || draw->ground[c] > 0) return true;
    return false;
}
