// SPDX-License-Identifier: MIT
// The light among hair (light_grid.h) for images: found by the processor where it makes the shadow
// maps, from what they leave at hair's points, else by shaders (light_passes.h), and kept while
// hair, lights and mesh stand still.
#pragma once

#include "draw/drawing.h"
#include "draw/light_dual.h"
#include "draw/shadows.h"
#include "lanes/light_grid.h"
#include "passes/light_passes.h"

typedef struct HairScatterOptions {
    Scatter scatter; // none and dual: only light of the sky
    int cells;       // 4 .. 64, see light_grid.h
    int orders;      // 1 .. 32
} HairScatterOptions;

typedef struct HairScatterScene {
    const ShadowScene *shadow;
    const View *view;
    Drawing *drawing; // its looks get the light
    ShadowCasters casters;
    const LightMesh *mesh; // NULL: none stands in the light
} HairScatterScene;

typedef struct HairScatter {
    HairScatterOptions options;
    const GpuLimits *limits;
    LightGrid grid;
    LightPasses passes;
    LightDual dual;
    LightBlocks blocks;
    FibreLobes kinds[LIGHT_GRID_KINDS];
    GLuint kind_table[LIGHT_GRID_KINDS]; // texture
    int kind_count;
    GridHair *hair;      // [room], owned
    ParticleLight *seen; // [room], owned
    uint32_t count, room;
    GLuint *mapped; // [4 room], owned
    uint32_t mapped_count;
    uint64_t shadow_version; // of the maps that the light was found by
    DrawParams drawn;
    float to_eye[3]; // of the light that is seen
    bool any;
    uint32_t solved; // times that light was found, for the last image
} HairScatter;

void hair_scatter_create(HairScatter *scatter, const GpuLimits *limits,
                         const HairScatterOptions *options);
void hair_scatter_destroy(HairScatter *scatter);

// Queues what shaders have to know of hair early: before the shadows of the scene are drawn.
Result hair_scatter_begin(HairScatter *scatter, const Shadows *shadows,
                          const HairScatterScene *scene, Error *error);

// Finds the light if it is another one than before and if a look of the drawing asks for it, and
// gives it to the looks. Needs `shadows`, deep ones, drawn for the scene and bound. RESULT_FAILED
// if memory is short.
Result hair_scatter_draw(HairScatter *scatter, Shadows *shadows, const HairScatterScene *scene,
                         GpuTimer *timer, Error *error);
