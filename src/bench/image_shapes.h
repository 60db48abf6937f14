// SPDX-License-Identifier: MIT
// What the reference image is made of: the ribbons and triangles of a scene as flat shapes on the
// screen, found in double precision from their definitions (image_reference.h).
#pragma once

#include "bench/image_reference.h"

// A quantity that is linear on the screen, kept between its values at the corners.
typedef struct ShapePlane {
    double base, dx, dy; // base + dx x + dy y, in px
    double low, high;
} ShapePlane;

typedef struct Shape {
    double corner[4][2]; // px, in turn
    int corners;         // 3 or 4
    double top, bottom;  // px, lowest and highest y
    double opacity;
    ShapePlane inverse_w; // 1/m
    ShapePlane color[3];  // linear
} Shape;

typedef struct Shapes {
    Shape *shapes; // [count], owned
    uint32_t count;
} Shapes;

// All shapes of the scene for a picture of this size, those outside it included; ribbons end at the
// near plane, triangles that cross it are left out. RESULT_FAILED when memory is short.
Result shapes_create(Shapes *shapes, const ReferenceScene *scene, int width, int height,
                     Error *error);
void shapes_destroy(Shapes *shapes);
