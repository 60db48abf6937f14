// SPDX-License-Identifier: MIT
// How much light a scene lets through to a point, by brute force on the CPU in double precision:
// the judge of every shadow map.
//
// A strand is a chain of ribbons that face the light, as wide as the fibre, with mitres at its
// joints as in image_reference.h. Each of them that the straight way from the light to the point
// crosses takes its opacity of what is left; a triangle of the mesh takes all. Nothing is filtered:
// beside a fibre's edge the light is whole.
#pragma once

#include "reference/image_reference.h"

// A zeroed struct is empty.
typedef struct ShadowReference {
    LightView view;
    Shapes shapes;
    uint32_t *cell_first;  // [side * side + 1], owned: a grid across the light ...
    uint32_t *cell_shapes; // ... and the shapes that touch each cell, owned
    uint32_t side;
    double low[2], step[2]; // of the grid
} ShadowReference;

// What stands in the light: the scene's items and its mesh; of its other members none matters.
// Ribbons have the material's shadow_opacity, times that of the paint at the root. A lamp looks at
// `middle` (world, m), and what is not before it is left out. RESULT_FAILED when memory is short.
Result shadow_reference_create(ShadowReference *reference, const ReferenceScene *scene,
                               const Light *light, const float middle[3], Error *error);
void shadow_reference_destroy(ShadowReference *reference);

// Share 0..1 of the light that reaches the point (world, m). What lies less than `clearance` (m)
// before the point, as the fibre that it is part of does, is passed over.
double shadow_reference_light(const ShadowReference *reference, const double point[3],
                              double clearance);

// left[v]: the mean share over the ribbon that vertex v stands for, half a segment to each side and
// as wide as the fibre, at SHADOW_REFERENCE_POINTS places: what light that is linear from vertex to
// vertex comes nearest to. On all processors; any number of them gives the same.
enum { SHADOW_REFERENCE_POINTS = 16 };
void shadow_reference_fill(const ShadowReference *reference, const ReferenceItem *item,
                           float *left);
