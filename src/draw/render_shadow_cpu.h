// SPDX-License-Identifier: MIT
// Lets the processor make shadow maps of hair (cpu_shadow.h) where OpenGL's buffers lie in its own
// memory: maps those of the hair and of the maps while they are drawn.
#pragma once

#include "draw/cpu_shadow.h"
#include "draw/render_look.h"

// Hair that stands in the light: the ribbons that are drawn, with the material's shadow_opacity.
typedef struct ShadowCaster {
    const HairBatch *batch;
    Look look;
} ShadowCaster;

typedef struct ShadowCasters {
    const ShadowCaster *list;
    uint32_t count;
} ShadowCasters;

typedef struct RenderShadowCpu {
    CpuShadow shadow;
    CpuCaster *casters; // [room], owned
    uint32_t count, room;
    ParticleLight *lights; // [room], owned
    float **left;          // [room], owned: theirs, while maps are drawn
    uint32_t lit;          // of them there are; 0: none, they would not fit into a buffer
    GLuint *mapped;        // [3 room + 2], owned: buffers
    uint32_t mapped_count;
    float *depths; // of all maps, while they are drawn; deep
    uint32_t *texels;
} RenderShadowCpu;

// Whether it can draw them all: no curves.
bool render_shadow_cpu_can(ShadowCasters casters);

// `side`, `deep`: see cpu_shadow_create. Destroying a zeroed struct is legal.
Result render_shadow_cpu_create(RenderShadowCpu *cpu, int side, bool deep, Error *error);
void render_shadow_cpu_destroy(RenderShadowCpu *cpu);

// Maps all that is read and written, and waits for the GPU. `depths` (deep) and `texels` are what
// shaders read later, the first depths or the layers of all `maps`. After RESULT_FAILED (memory is
// short, a buffer cannot be mapped) nothing is.
Result render_shadow_cpu_begin(RenderShadowCpu *cpu, const GpuLimits *limits, int maps,
                               ShadowCasters casters, const GpuBuffer *depths,
                               const GpuBuffer *texels, Error *error);
void render_shadow_cpu_end(RenderShadowCpu *cpu);

// Between the two: see cpu_shadow.h; map params->map. What is drawn of a deep map leaves its light
// in `lights`, too; `across`: ShadowParams.place[map].w.
bool render_shadow_cpu_find_box(RenderShadowCpu *cpu, const CastParams *params, double box[6]);
void render_shadow_cpu_draw(RenderShadowCpu *cpu, const CastParams *params, float across);
