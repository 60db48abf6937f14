// SPDX-License-Identifier: MIT
// The share of the light that reaches a point of a scene, by brute force in double precision: the
// reference for every shadow map.
//
// A strand is a chain of ribbons that face the light, as wide as the fibre, with mitres at the
// joints as in image_reference.h. Each ribbon between the light and the point absorbs its opacity
// of the remaining light; a triangle of the mesh absorbs all of it. Nothing is filtered: right
// beside a fibre's edge, the light is unshadowed.
#pragma once

#include "reference/image_reference.h"

// A zeroed struct is empty.
typedef struct ShadowReference {
    LightView view;
    Shapes shapes;
    uint32_t *cell_first;  // [side * side + 1] owned: a grid across the light ...
    uint32_t *cell_shapes; // ... and the shapes that overlap each cell, owned
    uint32_t side;
    double low[2], step[2]; // of the grid
} ShadowReference;

// Creates the reference for the scene's items and mesh; other members are not used. Ribbons have
// the material's shadow_opacity, times the paint's opacity at the root. A lamp faces `middle`
// (world, m); what is behind it is left out. RESULT_FAILED when memory is short.
Result shadow_reference_create(ShadowReference *reference, const ReferenceScene *scene,
                               const Light *light, const float middle[3], Error *error);
void shadow_reference_destroy(ShadowReference *reference);

// The share (0..1) of the light that reaches a point (world, m). Shapes less than `clearance` (m)
// in front of the point are skipped, such as the fibre that contains the point.
double shadow_reference_light(const ShadowReference *reference, const double point[3],
                              double clearance);

// Fills left[v] with the mean share over the ribbon around vertex v (half a segment to each side,
// as wide as the fibre), at SHADOW_REFERENCE_POINTS points. Light that is interpolated between
// vertices approximates this best. Uses all processors; their number does not change the result.
enum { SHADOW_REFERENCE_POINTS = 16 };
void shadow_reference_fill(const ShadowReference *reference, const ReferenceItem *item,
                           float *left);
