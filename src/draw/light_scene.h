// SPDX-License-Identifier: MIT
// Input for the light among hair (light_grid.h): hair, lights, eye and mesh.
#pragma once

#include "base/error.h"
#include "draw/fibre_lobes.h"
#include "draw/light_blocks.h"
#include "draw/mapped_caster.h"
#include "draw/renderer_options.h"

#include "glsl/draw/draw.h"

// kinds of fibres that scatter differently; further kinds share the last
enum { LIGHT_GRID_KINDS = 4 };

// A batch of hair that receives and scatters light.
typedef struct GridHair {
    MappedCaster caster;
    int kind; // kind of its fibres
} GridHair;

typedef struct GridScene {
    const GridHair *hair;
    uint32_t hair_count;
    const FibreLobes *kinds; // [kind_count]
    int kind_count;          // 1 .. LIGHT_GRID_KINDS
    const DrawParams *draw;  // lights, sky, ground, eye
    const Ambient *ambient;  // its environment; NULL: none
    // The shares of lights past shadows (lanes/shadow.h) for light_grid_solve; NULL: no light has a
    // map.
    const struct LaneShadow *shadow;
    float to_eye[3];        // unit, world: opposite to the camera's direction
    int map_of[MAX_LIGHTS]; // map of each light; -1: it casts no shadow
    LightBlocks *blocks;    // how the mesh blocks light within the box of hair; NULL: no mesh
    bool skin;              // also find the light that hair sends onto the mesh
    bool suns;              // also follow the light of lights, not only that of the sky
    uint32_t step; // one strand of each group of this many represents them in the cells; 0: 1
    int cells;     // along the longest side of the box, 4 .. 64
    int orders;    // number of swept orders of scattering at most, 0 .. 32; 0: only direct light of
                   // the sky
} GridScene;

// Whether there is ambient light (sky or ground).
static inline bool light_scene_has_sky(const DrawParams *draw)
{
    for (int c = 0; c < 3; ++c)
        if (draw->sky[c] > 0 || draw->ground[c] > 0) return true;
    return false;
}
