// SPDX-License-Identifier: MIT
// What a mesh and hair together leave of lights at points of hair: light_past_mesh of
// glsl/draw/shadow.glsl, found by the processor once for all points.
#pragma once

#include "base/error.h"
#include "lanes/mapped_caster.h"

#include <stddef.h>

// Of each tile of a map's texels the least and the greatest depth that a point in it looks at: most
// points lie before or behind all of them. Zeroed at the start.
typedef struct ShadowPast {
    float (*bounds)[2]; // [room], owned: map, row, column
    size_t room;
} ShadowPast;

// Makes the bounds of params->maps maps of mesh_side x mesh_side texels, one below the other, whose
// depths (0..1) stay the caller's; on `parts` threads. mesh_side: a multiple of 16. RESULT_FAILED
// if memory is short.
Result shadow_past_begin(ShadowPast *past, const ShadowParams *params, const float *depths,
                         int parts, Error *error);

// Multiplies `left`, the share of each light that hair leaves at the caster's points
// ([map][points], 0..1), by what the mesh leaves, into `reaching`. Between them and a lamp that
// they lie behind nothing stands.
void shadow_past_find(const ShadowPast *past, const ShadowParams *params, const float *depths,
                      const MappedCaster *caster, size_t points, const float *left, float *reaching,
                      int parts);

void shadow_past_destroy(ShadowPast *past);
