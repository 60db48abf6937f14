// SPDX-License-Identifier: MIT
// A batch of hair that casts shadows, in the CPU's memory.
#pragma once

#include "glsl/common/shared.h"
#include "glsl/draw/material.h"
#include "glsl/draw/shadow.h"

#include <stddef.h>

// The arrays are laid out as in HairBatch.
typedef struct MappedCaster {
    const float (*position)[4];
    const uint32_t (*paint)[4];            // see hair_paint.h; NULL: none
    const float (*points)[3][STRAND_TILE]; // [tile][point], if they are kept; NULL: none
    const uint32_t *order;                 // the order of tiles; NULL: ascending
    MaterialParams material;               // smooth_parts at least 1
    float weight; // number of strands that each represents in shadow maps; 0: 1
} MappedCaster;

typedef struct MappedCasters {
    const MappedCaster *list;
    uint32_t count;
} MappedCasters;

// The tile at place `turn` of the order in which tiles are processed.
static inline size_t mapped_caster_tile(const MappedCaster *caster, int turn)
{
    return caster->order ? caster->order[turn] : (size_t)turn;
}

// Points of a strand: its particles or the points of its curve.
static inline int mapped_caster_points(const MappedCaster *caster)
{
    return (int)((caster->material.vertex_count - 1) * caster->material.smooth_parts + 1);
}
