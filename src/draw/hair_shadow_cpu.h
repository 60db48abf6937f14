// SPDX-License-Identifier: MIT
// Lets the processor make shadow maps of hair (shadow_map.h) where OpenGL's buffers lie in its own
// memory: maps those of the hair and of the maps while they are drawn.
#pragma once

#include "draw/look.h"
#include "lanes/shadow_map.h"
#include "lanes/shadow_past.h"
#include "lanes/shadow_points.h"
#include "lanes/tile_order.h"

// Hair that stands in the light: the ribbons that are drawn, with the material's shadow_opacity.
typedef struct ShadowCaster {
    const HairBatch *batch;
    Look look;
} ShadowCaster;

typedef struct ShadowCasters {
    const ShadowCaster *list;
    uint32_t count;
} ShadowCasters;

// A buffer while the processor uses it: mapped, or a copy of it.
typedef struct SharedBuffer {
    GLuint buffer;
    int64_t size, room; // bytes, of the buffer and of `copy`
    void *copy;         // owned; it stays until the buffer is used again
    bool written;
} SharedBuffer;

typedef struct HairShadowCpu {
    ShadowMap map;
    ShadowPoints points;
    TileOrder order;
    MappedCaster *casters; // [room], owned
    uint32_t count, room;
    ParticleLight *lights; // [room], owned
    float **left;          // [room], owned: theirs, while maps are drawn
    // With a mesh in the light: what it leaves, too (see shadow_past.h).
    bool past_mesh;
    ShadowPast past;
    bool bounded;            // `past` has bounds of the mesh's maps as they are
    ParticleLight *reaching; // [room], owned
    bool behind;             // each light has as many values again, of what is behind (look.h)
    int maps;
    uint32_t lit; // of them there are; 0: none (they would not fit into a buffer)
    // Buffers are copied, not mapped: what hardware keeps in memory of its own is read once, and
    // what is written is sent, never read. Then `casters` and `left` can still be read after
    // hair_shadow_cpu_end, until maps are made again.
    bool copies;
    SharedBuffer *mapped; // [4 room + 2], owned
    uint32_t mapped_count;
    float *depths; // of all maps, while they are drawn; deep
    uint32_t *texels;
} HairShadowCpu;

// `side`, `deep`: see shadow_map_create. Destroying a zeroed struct is legal.
Result hair_shadow_cpu_create(HairShadowCpu *cpu, int side, bool deep, bool behind, Error *error);
void hair_shadow_cpu_destroy(HairShadowCpu *cpu);

// Maps all that is read and written, and waits for the GPU. `depths` (deep) and `texels` are what
// shaders read later, the first depths or the layers of all `maps`. After RESULT_FAILED (memory is
// short, a buffer cannot be mapped) nothing is.
Result hair_shadow_cpu_begin(HairShadowCpu *cpu, const GpuLimits *limits, int maps,
                             ShadowCasters casters, const GpuBuffer *depths,
                             const GpuBuffer *texels, Error *error);
void hair_shadow_cpu_end(HairShadowCpu *cpu);

// Between the two: see shadow_map.h; map params->map. What is drawn of a deep map leaves its light
// in `lights`, too; `across`: ShadowParams.place[map].w.
bool hair_shadow_cpu_find_box(HairShadowCpu *cpu, const CastParams *params, double box[6]);
void hair_shadow_cpu_draw(HairShadowCpu *cpu, const CastParams *params, float across);

// With `past_mesh`, when all maps are drawn: what reaches the points of hair past the mesh, too,
// whose maps' depths are in `texels`, `fresh` if they are others than at the last call.
// RESULT_FAILED if memory is short.
Result hair_shadow_cpu_pass_mesh(HairShadowCpu *cpu, const ShadowParams *params,
                                 const GpuBuffer *texels, bool fresh, Error *error);
