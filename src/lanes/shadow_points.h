// SPDX-License-Identifier: MIT
// The points of the hair's curves, computed once for shadows, projection and shading.
#pragma once

#include "draw/mapped_caster.h"

#include <stdbool.h>
#include <stddef.h>

// Zeroed at the start.
typedef struct ShadowPoints {
    float (*all)[3][STRAND_TILE]; // [room], owned: of all casters, one after the other
    size_t room;
} ShadowPoints;

// Computes the points of all curves, in metres (x, y, z of 16 strands each), on `parts` threads,
// and sets each caster's `points`. If memory is short, or if they would take more than 192 MiB,
// casters have no points and each pass computes them itself.
void shadow_points_find(ShadowPoints *points, MappedCaster *casters, uint32_t count, int parts);

void shadow_points_destroy(ShadowPoints *points);
